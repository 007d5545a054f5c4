import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join, sep } from 'node:path';
import { root } from './run-command.mjs';
import { sourceResolution } from './source-condition.mjs';

/** Other pages than the one that is kept; they need their server. */
const otherPages = ['experimenter.html', 'preview.html', 'results.html', 'withdraw.html'];

/**
 * Files that no page which is kept asks for: a server's business, weights for pages without the runtime (the library's), and what computes
 * by WebGPU (27 MB, behind ?ep=webgpu alone).
 */
const unkept = /^(api|studies)\/|(^|\/)\.|\.html$|\.webgpu\.|\.asyncify-|^models\/.*\.bin$|^sw\.js$/;

/** Files that these pages of Vite's manifest load, now or later. */
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

/** The files of a built page that a browser keeps, relative to its folder, each with what its content is known by. */
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
        // Vite names what is in assets/ by its content; everything else is told apart by it.
        revision: url.startsWith('assets/') ? null : digest.toString('hex').slice(0, 16),
        integrity: `sha256-${digest.toString('base64')}`,
      };
    });
}

/** The list of files as the service worker reads it; another list is another version. */
const listed = (files) => `self.keptFiles=${JSON.stringify(files)};\n`;

/** Writes sw.js into a directory that Vite has built a page into, with all it needs in one file. */
export async function buildServiceWorker(directory) {
  const manifestFile = join(directory, '.vite/manifest.json');
  const files = keptFiles(directory, JSON.parse(readFileSync(manifestFile, 'utf8')));
  rmSync(join(directory, '.vite'), { recursive: true });
  // Loaded here, where it is installed: the commands that install what is missing load this file first.
  const { rolldown } = await import('rolldown');
  const bundle = await rolldown({
    input: join(root, 'src/page/offline/service-worker.ts'),
    platform: 'browser',
    resolve: sourceResolution('browser'),
    transform: { define: { 'process.env.NODE_ENV': '"production"' }, target: 'es2022' },
  });
  const { output } = await bundle.generate({ format: 'iife', minify: true });
  await bundle.close();
  writeFileSync(join(directory, 'sw.js'), listed(files) + output[0].code);
}
