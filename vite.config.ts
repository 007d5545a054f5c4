import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

export default defineConfig({
  resolve: {
    alias: {
      '@stdlib/assert-has-generator-support': fileURLToPath(
        new URL('scripts/has-generator-support.cjs', import.meta.url),
      ),
    },
  },
  // Studies are kept by `npm start`; the pages under development talk to it.
  server: { host: '127.0.0.1', port: 5173, proxy: { '/api': 'http://127.0.0.1:3333' } },
  preview: { host: '127.0.0.1', port: 4173 },
  // Workers are modules, so that they may load the parts they need.
  worker: { format: 'es' },
  build: {
    target: 'es2022',
    // The policy of the server allows scripts of our own files alone: nothing may be inlined into the page as a data: URL.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
    rolldownOptions: {
      input: ['index.html', 'results.html', 'experimenter.html'],
      // The emulator's panel uses packages that mark themselves for servers we do not have.
      onwarn(warning, warn) {
        if (warning.code !== 'MODULE_LEVEL_DIRECTIVE') warn(warning);
      },
    },
  },
});
