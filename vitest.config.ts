import { defineConfig } from 'vitest/config';

export default defineConfig({
  test: {
    include: ['tests/**/*.test.ts'],
    setupFiles: ['tests/property-runs.ts', 'tests/matchers/to-be-same-rotation-as.ts'],
    // A property with many runs on a busy machine is slow, not wrong.
    testTimeout: 30_000,
    // One for each core: much of the time is spent waiting for servers and sockets.
    maxWorkers: '100%',
    slowTestThreshold: 5_000,
  },
});
