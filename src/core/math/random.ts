/** A generator of numbers in [0, 1) whose whole state is one 32-bit number, so that it can live in a game's state. */
export interface RandomState {
  readonly seed: number;
}

/** The next number and the state after it (Steele's SplitMix32 mixing steps). */
export function nextRandom(state: RandomState): { readonly value: number; readonly state: RandomState } {
  const seed = (state.seed + 0x9e3779b9) | 0;
  let mixed = seed ^ (seed >>> 16);
  mixed = Math.imul(mixed, 0x21f0aaad);
  mixed ^= mixed >>> 15;
  mixed = Math.imul(mixed, 0x735a2d97);
  mixed ^= mixed >>> 15;
  return { value: (mixed >>> 0) / 2 ** 32, state: { seed } };
}
