import { createRandom } from 'threepoint/math';

/** A stream of numbers in [0, 1), the same for the same seed, for placing what only decorates. */
export function createRandomRange(seed: number): (low?: number, high?: number) => number {
  const random = createRandom(seed);
  return (low = 0, high = 1) => low + (high - low) * random();
}
