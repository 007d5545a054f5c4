import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join, sep } from 'node:path';
import { packageCollector } from './licences.mjs';
import { root } from './run-command.mjs';

/** The pages that are not cached, because they need their server. */
const otherPages = ['experimenter.html', 'results.html', 'withdraw.html'];

/**
 * Files that are not cached: files for the server, onnxruntime-web and its models (14 MB for the paper's network, 27 MB
 * for WebGPU).
 */
const unkept = /^(api|studies)\/|^models\/(?!learned\.bin$)|(^|\/)\.|\.html$|(^|\/)ort\b|^sw\.js$/;

/** Returns the files that these pages of Vite's manifest load, statically or dynamically. */
function reached(manifest, pages) {
  const files = new Set();
  const visited = new Set();
  const visit = (key) => {
    if (visited.has(key)) return;
    visited.add(key);
    const { file, css = [], assets = [], imports = [], dynamicImports = [] } = manifest[key];
    for (const each of [file, ...css, ...assets]) files.add(each);
    for (const next of [...imports, ...dynamicImports]) visit(next);
  };
  for (const page of pages) visit(page);
  return files;
}

/**
 * Returns the files of a built page that a browser caches, relative to its folder, each with a revision of its content.
 */
export function keptFiles(directory, manifest) {
  const ours = reached(manifest, ['index.html']);
  const others = reached(manifest, otherPages);
  return readdirSync(directory, { recursive: true })
    .filter((path) => statSync(join(directory, path)).isFile())
    .map((path) => path.split(sep).join('/'))
    .filter((path) => path === 'index.html' || !unkept.test(path))
    .filter((path) => ours.has(path) || !others.has(path))
    .sort()
    .map((url) => {
      const digest = createHash('sha256')
        .update(readFileSync(join(directory, url)))
        .digest();
      return {
        url,
        // Vite's names in assets/ contain a hash of the content; other files need a revision.
        revision: url.startsWith('assets/') ? null : digest.toString('hex').slice(0, 16),
        integrity: `sha256-${digest.toString('base64')}`,
      };
    });
}

/** Returns the list of files as the service worker reads it; a changed list is a new version. */
const listed = (files) => `self.keptFiles=${JSON.stringify(files)};\n`;

/** Writes sw.js, bundled into one file, into the directory of a built page. Returns the folders of its packages. */
export async function buildServiceWorker(directory) {
  const manifestFile = join(directory, '.vite/manifest.json');
  const files = keptFiles(directory, JSON.parse(readFileSync(manifestFile, 'utf8')));
  rmSync(join(directory, '.vite'), { recursive: true });
  // The import is dynamic, because the commands that install missing packages load this file first.
  const { rolldown } = await import('rolldown');
  const packages = new Set();
  const bundle = await rolldown({
    input: join(root, 'src/page/offline/service-worker.ts'),
    platform: 'browser',
    plugins: [packageCollector(packages)],
    transform: { define: { 'process.env.NODE_ENV': '"production"' }, target: 'es2022' },
  });
  const { output } = await bundle.generate({ format: 'iife', minify: true });
  await bundle.close();
  writeFileSync(join(directory, 'sw.js'), listed(files) + output[0].code);
  return packages;
}
