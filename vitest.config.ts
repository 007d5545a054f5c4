import { defineConfig } from 'vitest/config';

/** Which tests run: 'day' leaves out what takes its time, 'full' runs that alone; asked for without a word, a file runs whole. */
const tests = process.env.THREEPOINT_TESTS ?? 'all';
const inFull = 'tests/**/*.full.test.ts';

export default defineConfig({
  test: {
    include: [tests === 'full' ? inFull : 'tests/**/*.test.ts'],
    exclude: tests === 'day' ? [inFull] : [],
    setupFiles: ['tests/property-runs.ts', 'tests/matchers/to-be-same-rotation-as.ts'],
    // Files share a process and what they have loaded, which saves a seventh of the time: a test puts back what it changes outside itself,
    // and stubs are taken back for it.
    isolate: false,
    unstubGlobals: true,
    unstubEnvs: true,
    restoreMocks: true,
    // A property with many runs on a busy machine is slow, not wrong.
    testTimeout: 120_000,
    // One for each core: much of the time is spent waiting for servers and sockets.
    maxWorkers: '100%',
    slowTestThreshold: 5_000,
  },
});
