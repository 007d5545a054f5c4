import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { defineConfig, type Plugin } from 'vite';
import { packageCollector, packagesFile } from './scripts/licences.mjs';
import { contentSecurityPolicy } from './src/http/security-headers.ts';

/**
 * The sources from which the page may load files by address: those of `npm run build -- --files-from`, otherwise any
 * over https:. The project's server restricts them further by its header (THREEPOINT_FILES_FROM).
 */
const filesFrom = process.env.THREEPOINT_BUILD_FILES_FROM?.split(',').filter(Boolean) ?? ['https:'];

/**
 * Adds the server's content security policy to the pages themselves, for hosts that do not send its headers. It omits
 * frame-ancestors, which browsers only read in a header. Pages of the development server have no policy: that server's
 * own scripts would violate it.
 */
const policyInPages: Plugin = {
  name: 'policy-in-pages',
  apply: 'build',
  transformIndexHtml: (_html, { path }) => [
    {
      tag: 'meta',
      attrs: {
        'http-equiv': 'Content-Security-Policy',
        content: contentSecurityPolicy(path === '/index.html' ? filesFrom : []).replace(/; frame-ancestors [^;]*/, ''),
      },
      injectTo: 'head-prepend',
    },
    { tag: 'meta', attrs: { name: 'referrer', content: 'no-referrer' }, injectTo: 'head-prepend' },
  ],
};

/** Node modules that decoders import only in Node; the bundle for browsers omits them. */
const decodersWithoutNode: Plugin = {
  name: 'decoders-without-node',
  enforce: 'pre',
  resolveId: {
    filter: { id: /^(fs|path)$/ },
    handler: (_, importer) => (/\/draco\//.test(importer ?? '') ? '\0decoders-without-node' : undefined),
  },
  load: { filter: { id: /^\0decoders-without-node$/ }, handler: () => 'export {};' },
};

/**
 * The pages of a build. The headset check and the example to embed are a build of their own (scripts/build.mjs): a page
 * that shares its chunks would split those of the others.
 */
const pages =
  process.env.THREEPOINT_BUILD_PAGES === 'apart'
    ? { input: ['check.html', 'embed.html'], first: false }
    : { input: ['index.html', 'results.html', 'experimenter.html', 'withdraw.html', '404.html'], first: true };

const packages = new Set<string>();

/** Adds the packages of this build, workers included, to a list for scripts/build.mjs. */
const packageList: Plugin = {
  name: 'package-list',
  apply: 'build',
  writeBundle({ dir = 'dist' }) {
    const file = join(dir, packagesFile);
    const earlier: string[] = pages.first ? [] : JSON.parse(readFileSync(file, 'utf8'));
    writeFileSync(file, JSON.stringify([...earlier, ...packages]));
  },
};

/** The server for rooms and studies: `npm start`, which runs next to the development server, on the same PORT. */
const server = `http://127.0.0.1:${process.env.PORT ?? 3333}`;

export default defineConfig({
  // The page can be served from any folder, unless `npm run build -- --base` names one (scripts/build.mjs).
  base: './',
  plugins: [policyInPages, packageCollector(packages), packageList],
  // The emulator's panel brings a version of three.js of its own; it draws with ours.
  resolve: { dedupe: ['three'] },
  server: {
    host: '127.0.0.1',
    port: 5173,
    // Vite replaces Host for a proxy given as a string, and the server refuses an Origin of another host.
    proxy: { '/api': { target: server }, '/relay': { target: server, ws: true } },
  },
  preview: { host: '127.0.0.1', port: 4173 },
  // Workers are modules, so that they can import chunks.
  worker: { format: 'es', plugins: () => [decodersWithoutNode, packageCollector(packages)] },
  build: {
    target: 'es2022',
    // The server's policy allows scripts from files of the same origin only: nothing may be inlined as a data: URL.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    emptyOutDir: pages.first,
    copyPublicDir: pages.first,
    // The manifest of imports is for scripts/build-service-worker.mjs, which deletes it.
    manifest: pages.first,
    chunkSizeWarningLimit: 1200,
    rolldownOptions: {
      input: pages.input,
      // The emulator's panel uses packages with directives for server components, which this page does not have.
      onwarn(warning, warn) {
        if (warning.code !== 'MODULE_LEVEL_DIRECTIVE') warn(warning);
      },
    },
  },
});
