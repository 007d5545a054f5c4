import { defineConfig } from 'vitest/config';

export default defineConfig({
  test: {
    include: ['tests/**/*.test.ts'],
    setupFiles: ['tests/property-runs.ts', 'tests/matchers/to-be-same-rotation-as.ts'],
    // A property with many runs on a busy machine is slow, not wrong.
    testTimeout: 30_000,
    slowTestThreshold: 5_000,
  },
});
