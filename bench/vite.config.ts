import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const path = (relative: string) => fileURLToPath(new URL(relative, import.meta.url));

export default defineConfig({
  root: path('./page'),
  publicDir: path('../public'),
  worker: { format: 'es' },
  build: {
    outDir: path('../.cache/bench'),
    emptyOutDir: true,
    target: 'es2022',
    rolldownOptions: {
      input: ['index', 'allocations', 'board', 'counts', 'networks'].map((name) => path(`./page/${name}.html`)),
    },
  },
});
