import { expect } from 'vitest';
import { isNightly } from '../nightly';

/** A time that the relay promises is judged by night alone, where nothing else runs; by day a test tells what it measured. */
export function expectPromised(measured: number, most: number): void {
  if (isNightly) expect(measured).toBeLessThan(most);
}
