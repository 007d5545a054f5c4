import { fileURLToPath } from 'node:url';
import { defaultClientConditions, defineConfig, type Plugin } from 'vite';
import { contentSecurityPolicy } from './src/http/security-headers.ts';

/**
 * Sources from which the page may read files that are named by address: those of `npm run build -- --files-from`, else any over https:. Where a
 * server of ours sends the page, its header narrows them further (THREEPOINT_FILES_FROM).
 */
const filesFrom = process.env.THREEPOINT_BUILD_FILES_FROM?.split(',').filter(Boolean) ?? ['https:'];

/**
 * Says the server's policy in the pages themselves, for hosts that send no headers of ours. Without frame-ancestors, which browsers read in
 * a header alone. Pages under development have none: the development server's own scripts would break it.
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

/** Decoders ask for modules of Node where they run in Node; in a browser they never get there, and the bundle need not speak of them. */
const decodersWithoutNode: Plugin = {
  name: 'decoders-without-node',
  enforce: 'pre',
  resolveId: {
    filter: { id: /^(fs|path)$/ },
    handler: (_, importer) => (/\/draco\//.test(importer ?? '') ? '\0decoders-without-node' : undefined),
  },
  load: { filter: { id: /^\0decoders-without-node$/ }, handler: () => 'export {};' },
};

export default defineConfig({
  // Where the page is served from: any folder, unless `npm run build -- --base` names one (scripts/build.mjs).
  base: './',
  plugins: [policyInPages],
  resolve: {
    conditions: ['source', ...defaultClientConditions],
    alias: {
      '@stdlib/assert-has-generator-support': fileURLToPath(
        new URL('scripts/has-generator-support.cjs', import.meta.url),
      ),
    },
  },
  // Rooms and studies are those of `npm start`, which runs beside the development server.
  server: {
    host: '127.0.0.1',
    port: 5173,
    proxy: { '/api': 'http://127.0.0.1:3333', '/relay': { target: 'http://127.0.0.1:3333', ws: true } },
  },
  preview: { host: '127.0.0.1', port: 4173 },
  // Workers are modules, so that they may load the parts they need.
  worker: { format: 'es', plugins: () => [decodersWithoutNode] },
  build: {
    target: 'es2022',
    // The policy of the server allows scripts of our own files alone: nothing may be inlined into the page as a data: URL.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    // What loads what, for scripts/build-service-worker.mjs, which takes it away.
    manifest: true,
    chunkSizeWarningLimit: 1200,
    rolldownOptions: {
      input: ['index.html', 'results.html', 'experimenter.html', 'preview.html', 'withdraw.html'],
      // The emulator's panel uses packages that mark themselves for servers we do not have.
      onwarn(warning, warn) {
        if (warning.code !== 'MODULE_LEVEL_DIRECTIVE') warn(warning);
      },
    },
  },
});
