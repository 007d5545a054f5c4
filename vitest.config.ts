import { defineConfig, type TestProjectConfiguration } from 'vitest/config';
import { isNightly } from './tests/nightly.ts';
import { thirdGame } from './tests/page/third-game/added-lines.ts';

/**
 * Tests in processes of their own: those that count allocations, because compiled code depends on what ran before, and
 * those that collect garbage, because that takes half a second in the heap of many files.
 */
const apart = [
  'tests/page/shell/panels/headset-controls.test.ts',
  'tests/rooms/drawing/room-avatar-loader.test.ts',
  'tests/threepoint/avatar/mutated-fbx.test.ts',
  'tests/ui/vr-touch.test.ts',
];

/** Tests with a third game in the registries. */
const withThirdGame = ['page/third-game/*', 'server/third-game', 'study/third-game'].map(
  (path) => `tests/${path}.test.ts`,
);

const projects: TestProjectConfiguration[] = [
  {
    extends: true,
    test: {
      name: 'shared',
      include: ['tests/**/*.test.ts'],
      exclude: [...apart, ...withThirdGame],
      isolate: false,
      globalSetup: 'tests/server/built-server.ts',
    },
  },
  { extends: true, test: { name: 'apart', include: apart } },
  { extends: true, plugins: [thirdGame], test: { name: 'third-game', include: withThirdGame } },
];

export default defineConfig({
  test: {
    setupFiles: ['tests/property-runs.ts', 'tests/restore-globals.ts', 'tests/matchers/to-be-same-rotation-as.ts'],
    // Most files share a process and its loaded modules, which saves a fifth of the time. A test restores what it
    // changes outside itself; stubs are restored automatically.
    unstubGlobals: true,
    unstubEnvs: true,
    restoreMocks: true,
    // The limit is generous: a property with many runs is slow on a busy machine, but not wrong.
    testTimeout: isNightly ? 600_000 : 120_000,
    hookTimeout: 120_000,
    // Polls wait for the same reason.
    expect: { poll: { timeout: 30_000 } },
    // One worker per core: much of the time is spent waiting for servers and sockets.
    maxWorkers: '100%',
    slowTestThreshold: 5_000,
    // The report is for scripts/test.mjs, which counts tests.
    reporters: ['default', ['json', { outputFile: 'artifacts/test-reports/unit.json' }]],
    tags: [{ name: 'full', description: 'What takes its time, or needs another program: npm run test:full' }],
    projects,
  },
});
