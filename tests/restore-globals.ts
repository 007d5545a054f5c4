import { afterAll, vi } from 'vitest';

// Stubs are restored before each test, but the next file of the process loads before its first test. An import that is
// pending when a file ends would fail that file.
afterAll(async () => {
  await vi.dynamicImportSettled();
  vi.unstubAllGlobals();
  vi.unstubAllEnvs();
});
