// The sizes of what pages import from the built library: stated in documents, or limited here.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync } from 'node:zlib';
import { rolldown } from 'rolldown';
import { external } from './build-library.mjs';
import { root } from './run-command.mjs';

const folder = join(root, 'dist-library');

/** What pages import, and from which entry: the rows of the table of sizes in src/threepoint/README.md. */
const stated = {
  Body: 'index',
  BodyTracker: 'three',
  'BodyTracker, loadAvatar': 'three',
  SelfAvatar: 'react',
  onnxNetworks: 'onnx',
  exportMotion: 'motion',
  installBodyTracking: 'polyfill',
  pinning: 'trackers',
};

/** Names that no document weighs, their entries, and the largest minified bundle of each [kB]. */
const limits = [
  ['copyAvatarPose', 'index', 1.6],
  ['calibrationProblem', 'index', 3.1],
  ['forwardKinematics', 'index', 1.7],
  ['parseRecording', 'index', 5.5],
  ['toXRBody', 'motion', 18.5],
];

/** The relative tolerance between a stated and a measured size; small sizes have a larger one, for rounding. */
const tolerance = 0.03;

/** Returns the code of a page that imports these names from an entry of the library. */
const pageWith = (names, entry) => `export { ${names} } from ${JSON.stringify(join(folder, `${entry}.js`))};`;

/** Returns the minified code of a page with its static imports, in parts; without dynamic imports and peers. */
async function bundle(code) {
  const page = {
    name: 'page',
    resolveId: { filter: { id: /^page$/ }, handler: (id) => id },
    load: { filter: { id: /^page$/ }, handler: () => code },
  };
  const build = await rolldown({ input: { entry: 'page' }, platform: 'browser', external, plugins: [page] });
  const { output: files } = await build.generate({ format: 'esm', minify: true });
  await build.close();
  const needed = new Set();
  const add = (file) => {
    if (needed.has(file)) return;
    needed.add(file);
    for (const imported of files.find(({ fileName }) => fileName === file)?.imports ?? []) add(imported);
  };
  add('entry.js');
  return files.filter(({ fileName }) => needed.has(fileName)).map((file) => Buffer.from(file.code));
}

const sizeOf = (parts) => parts.reduce((sum, { length }) => sum + length, 0);

/** Returns the bytes of these parts, plain and by brotli. */
const weigh = (parts) => ({ min: sizeOf(parts), brotli: sizeOf(parts.map((part) => brotliCompressSync(part))) });

const kilobytes = (bytes, digits = 1) => `${(bytes / 1000).toFixed(digits)} kB`;
const digitsOf = (kB) => kB.split('.')[1]?.length ?? 0;
const isTrue = (kB, bytes) =>
  Math.abs(1000 * kB - bytes) <= tolerance * bytes || kilobytes(bytes, digitsOf(kB)) === `${kB} kB`;

/** Returns a message if a document does not state these bytes; `pattern` finds its kilobytes in the text. */
function staleSize(file, what, pattern, bytes) {
  const says = pattern.exec(readFileSync(join(root, file), 'utf8'))?.slice(1);
  if (!says) return [`${file} does not say what ${what} weighs`];
  if (says.every((kB, i) => isTrue(kB, bytes[i]))) return [];
  const is = bytes.map((size) => kilobytes(size, digitsOf(says[0]))).join(' and ');
  return [`${file} says ${says.map((kB) => `${kB} kB`).join(' and ')} of ${what}, it is ${is}`];
}

/** Prints the sizes; returns a message for each that a document states wrongly or that is over its limit. */
export async function wrongSizes() {
  const sizes = {};
  for (const [names, entry] of Object.entries(stated))
    sizes[`\`${names}\``] = weigh(await bundle(pageWith(names, entry)));
  sizes["the learned network's weights"] = weigh([readFileSync(join(folder, 'learned-weights.js'))]);
  const faults = Object.entries(sizes).flatMap(([what, { min, brotli }]) => {
    const row = new RegExp(`^\\| ${what} \\| ([\\d.]+) kB \\| ([\\d.]+) kB \\|$`, 'm');
    return staleSize('src/threepoint/README.md', what, row, [min, brotli]);
  });
  const sentence = /(\d+) kB of code as it travels \((\d+) kB without `loadAvatar`\)/;
  const travels = [sizes['`BodyTracker, loadAvatar`'].brotli, sizes['`BodyTracker`'].brotli];
  faults.push(...staleSize('README.md', 'BodyTracker, with and without loadAvatar', sentence, travels));
  for (const [name, entry, largest] of limits) {
    sizes[name] = { min: sizeOf(await bundle(pageWith(name, entry))) };
    if (sizes[name].min > 1000 * largest)
      faults.push(`import { ${name} } costs ${kilobytes(sizes[name].min)}, more than ${largest} kB`);
  }
  console.table(sizes);
  // The module that answers a page's messages exports nothing, and a bundler must keep it.
  const worker = await bundle(`import ${JSON.stringify(join(folder, 'onnx-worker.js'))};`);
  return sizeOf(worker) > 500 ? faults : [...faults, 'a bundle of onnx-worker.js is empty'];
}
