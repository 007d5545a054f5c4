import { afterAll, vi } from 'vitest';

// Stubs are restored before each test, but the next file of the process loads before its first test.
afterAll(() => {
  vi.unstubAllGlobals();
  vi.unstubAllEnvs();
});
