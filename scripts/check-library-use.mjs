// Uses the packed packages as their users do. Compiles the consumers in examples/ against them, with the module
// resolution of bundlers and of Node, strictly and with declarations checked; runs the programs of Node there.
import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { build } from 'esbuild';
import { rolldown } from 'rolldown';
import { packages } from './build-packages.mjs';
import { main, outputOf, root, run, SetupError } from './run-command.mjs';

const folder = join(root, 'artifacts/library-consumer');
const resolutions = [
  { module: 'preserve', moduleResolution: 'bundler' },
  { module: 'node16', moduleResolution: 'node16' },
];

/** The consumers, and the types of its surroundings that each may use. */
const consumers = { 'consumer.ts': [], 'rooms-consumer.ts': [], 'relay-consumer.ts': ['node'] };

/** Installs a package as `npm install` does; what it depends on resolves to the repository's own packages. */
async function unpack(name) {
  const into = join(folder, 'node_modules', name);
  mkdirSync(into, { recursive: true });
  const pack = ['pack', join(root, packages[name].folder), '--pack-destination', into];
  await outputOf('npm', pack, `${name} could not be packed`);
  const [tarball] = readdirSync(into);
  const unpack = ['-xzf', join(into, tarball), '-C', into, '--strip-components=1'];
  await outputOf('tar', unpack, `${tarball} could not be unpacked`);
}

/**
 * Errors in three-vrm's declarations, which are ignored: they import without the extensions Node's resolution requires.
 */
const foreign = /^[^(]*\bnode_modules[\\/]@pixiv[\\/]/;

/** Returns the compiler's errors in the package and in the consumer. */
async function compile(config) {
  const { code, output } = await run(process.execPath, ['node_modules/typescript/bin/tsc', '-p', config], {
    capture: true,
  });
  const faults = output.split(/\n(?=\S)/).filter((fault) => fault.trim() !== '' && !foreign.test(fault));
  if (code !== 0 && !/error TS/.test(output)) throw new SetupError(`The compiler broke down:\n${output}`);
  return faults;
}

async function compileConsumer(consumer, types) {
  copyFileSync(join(root, 'examples', consumer), join(folder, consumer));
  for (const resolution of resolutions) {
    const config = join(folder, `tsconfig.${consumer}.${resolution.moduleResolution}.json`);
    const compilerOptions = {
      ...resolution,
      ...{ target: 'es2022', lib: ['es2022', 'dom', 'dom.iterable'], types, noEmit: true },
      ...{ strict: true, exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, skipLibCheck: false },
    };
    writeFileSync(config, JSON.stringify({ compilerOptions, files: [consumer] }));
    const faults = await compile(config);
    if (faults.length > 0) {
      throw new SetupError(
        `${consumer} with moduleResolution ${resolution.moduleResolution} does not compile:\n${faults.join('\n')}`,
      );
    }
  }
}

async function runProgram(name) {
  const program = join(folder, name);
  copyFileSync(join(root, 'examples', name), program);
  await outputOf(process.execPath, [program], `${name}, a program of Node, fails`);
}

/**
 * Checks that bundlers which ignore URLs in code keep the weights; a page without them stays with inverse kinematics.
 */
async function bundleWeights() {
  const program = join(folder, 'weights.mjs');
  writeFileSync(
    program,
    "import { loadLearned } from 'threepoint';\nif ((await loadLearned()).provider !== 'plain') process.exit(1);\n",
  );
  const out = (bundler) => join(folder, `bundled-by-${bundler}`);
  await build({ entryPoints: [program], outdir: out('esbuild'), bundle: true, format: 'esm', splitting: true });
  const bundle = await rolldown({ input: program, logLevel: 'silent' });
  await bundle.write({ dir: out('rolldown') });
  for (const bundler of ['esbuild', 'rolldown']) {
    const fault = `A bundle by ${bundler} does not load the learned network`;
    await outputOf(process.execPath, [join(out(bundler), 'weights.js')], fault);
  }
}

/**
 * Checks that a server which renders pages can import every entry for them: none may touch `window` before it is used.
 */
async function importWithoutBrowser() {
  const entries = Object.keys(packages).flatMap((name) => {
    const { exports } = JSON.parse(readFileSync(join(folder, 'node_modules', name, 'package.json'), 'utf8'));
    const code = Object.entries(exports).filter(([, target]) => target.default && !target.default.includes('*'));
    return code.map(([entry]) => join(name, entry));
  });
  // A worker's code answers messages from its first line on.
  const imports = entries.filter((entry) => entry !== 'threepoint/onnx-worker').map((entry) => `import '${entry}';`);
  const program = join(folder, 'without-browser.mjs');
  writeFileSync(program, imports.join('\n'));
  await outputOf(process.execPath, [program], 'An entry cannot be imported without a browser');
}

await main(async () => {
  rmSync(folder, { recursive: true, force: true });
  for (const name of Object.keys(packages)) await unpack(name);
  writeFileSync(join(folder, 'package.json'), '{ "type": "module" }');
  for (const [consumer, types] of Object.entries(consumers)) await compileConsumer(consumer, types);
  for (const program of ['in-node.mjs', 'rooms-in-node.mjs']) await runProgram(program);
  await bundleWeights();
  await importWithoutBrowser();
});
