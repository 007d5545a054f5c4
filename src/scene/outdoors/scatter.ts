import { nextRandom, type RandomState } from '../../core/math/random';

/** A stream of numbers in [0, 1), the same for the same seed, for placing what only decorates. */
export function createScatter(seed: number): (low?: number, high?: number) => number {
  let state: RandomState = { seed };
  return (low = 0, high = 1) => {
    const next = nextRandom(state);
    state = next.state;
    return low + (high - low) * next.value;
  };
}
