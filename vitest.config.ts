import { defineConfig, type TestProjectConfiguration } from 'vitest/config';

/** Tests of what keeps no state outside its own functions: files share a process and what they have loaded. */
const stateless = 'tests/{core,ui,app/archery,app/study}/**/*.test.ts';

/** Which tests run: 'day' leaves out what takes its time, 'full' runs that alone; asked for without a word, a file runs whole. */
const tests = process.env.THREEPOINT_TESTS ?? 'all';
const inFull = 'tests/**/*.full.test.ts';
const leftOut = tests === 'day' ? [inFull] : [];

const projects: TestProjectConfiguration[] = [
  { extends: true, test: { name: 'stateless', include: [stateless], exclude: leftOut, isolate: false } },
  { extends: true, test: { name: 'apart', include: ['tests/**/*.test.ts'], exclude: [stateless, ...leftOut] } },
];
const full: TestProjectConfiguration[] = [{ extends: true, test: { name: 'full', include: [inFull] } }];

export default defineConfig({
  test: {
    setupFiles: ['tests/property-runs.ts', 'tests/matchers/to-be-same-rotation-as.ts'],
    // A property with many runs on a busy machine is slow, not wrong.
    testTimeout: 120_000,
    // One for each core: much of the time is spent waiting for servers and sockets.
    maxWorkers: '100%',
    slowTestThreshold: 5_000,
    projects: tests === 'full' ? full : projects,
  },
});
