import { defaultServerConditions } from 'vite';
import { defineConfig, type TestProjectConfiguration } from 'vitest/config';
import { withSourceCondition } from './scripts/source-condition.mjs';

// Programs that tests start resolve packages to their sources, too.
process.env.NODE_OPTIONS = withSourceCondition(process.env.NODE_OPTIONS);

/** Pages whose parts load when they are asked for: a file may end while one is still on its way, which would fail the next file. */
const loading = 'tests/page/shell/**/*.test.ts';

const projects: TestProjectConfiguration[] = [
  { extends: true, test: { name: 'shared', include: ['tests/**/*.test.ts'], exclude: [loading], isolate: false } },
  { extends: true, test: { name: 'apart', include: [loading] } },
];

export default defineConfig({
  ssr: { resolve: { conditions: ['source', ...defaultServerConditions] } },
  test: {
    setupFiles: ['tests/property-runs.ts', 'tests/matchers/to-be-same-rotation-as.ts'],
    // Most files share a process and what they have loaded, which saves a fifth of the time: a test puts back what it changes outside
    // itself, and stubs are taken back for it.
    unstubGlobals: true,
    unstubEnvs: true,
    restoreMocks: true,
    // A property with many runs on a busy machine is slow, not wrong.
    testTimeout: 120_000,
    hookTimeout: 120_000,
    // Nor is what a test waits for.
    expect: { poll: { timeout: 30_000 } },
    // One for each core: much of the time is spent waiting for servers and sockets.
    maxWorkers: '100%',
    slowTestThreshold: 5_000,
    tags: [{ name: 'full', description: 'What takes its time, or needs another program: npm run test:full' }],
    projects,
  },
});
