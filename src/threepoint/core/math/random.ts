/** A generator of numbers in [0, 1) whose whole state is one 32-bit number, so that it can live in a game's state. */
export interface RandomState {
  readonly seed: number;
}

/** Returns the seed that follows a seed, for owners of a buffer. */
export const nextSeed = (seed: number): number => (seed + 0x9e3779b9) | 0;

/** Returns the number in [0, 1) for a seed (Steele's SplitMix32 mixing steps). */
export function uniformFromSeed(seed: number): number {
  let mixed = seed ^ (seed >>> 16);
  mixed = Math.imul(mixed, 0x21f0aaad);
  mixed ^= mixed >>> 15;
  mixed = Math.imul(mixed, 0x735a2d97);
  mixed ^= mixed >>> 15;
  return (mixed >>> 0) / 2 ** 32;
}

/** Returns the next number and the state after it. */
export function nextRandom(state: RandomState): { readonly value: number; readonly state: RandomState } {
  const seed = nextSeed(state.seed);
  return { value: uniformFromSeed(seed), state: { seed } };
}

/** Returns a function that returns the next number in [0, 1) with each call. */
export function createRandom(seed: number): () => number {
  let state = seed;
  return () => {
    state = nextSeed(state);
    return uniformFromSeed(state);
  };
}

/** Returns a generator of standard normal numbers by Box and Muller; 1 − u is never 0. */
export function createNormalRandom(seed: number): () => number {
  const uniform = createRandom(seed);
  return () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());
}
