import { nextRandom, type RandomState } from 'threepoint/math';
import { randomFor } from '../model/plan/shuffle';

/** A seeded source of random numbers, whose state advances with every number. */
export interface RandomSource {
  /** Returns a number in [0, 1). */
  uniform(): number;
  normal(): number;
}

/** Returns a source that depends on the seed and the purpose only. */
export function randomSource(seed: number, purpose: string): RandomSource {
  let state: RandomState = randomFor(seed, purpose);
  const uniform = () => {
    const next = nextRandom(state);
    state = next.state;
    return next.value;
  };
  return {
    uniform,
    // The method of Box and Muller; 1 − u is never 0.
    normal: () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform()),
  };
}
