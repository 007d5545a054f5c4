import { afterAll, vi } from 'vitest';

// Files share a process, and the next file has a `vi` of its own, which knows no stub of this one.
afterAll(() => {
  vi.unstubAllGlobals();
  vi.unstubAllEnvs();
});
