import { nextRandom, type RandomState } from 'threepoint/core/math/random';
import { randomFor } from '../model/plan/shuffle';

/** A seeded source of numbers for the models: its state moves with every number taken. */
export interface RandomSource {
  /** In [0, 1). */
  uniform(): number;
  /** Standard normal. */
  normal(): number;
}

/** The same seed and purpose always give the same numbers. */
export function randomSource(seed: number, purpose: string): RandomSource {
  let state: RandomState = randomFor(seed, purpose);
  const uniform = () => {
    const next = nextRandom(state);
    state = next.state;
    return next.value;
  };
  return {
    uniform,
    // Box and Muller; 1 − u is never 0.
    normal: () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform()),
  };
}
