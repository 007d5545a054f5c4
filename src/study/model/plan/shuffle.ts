import { nextRandom, type RandomState } from 'threepoint/math';

/** Returns a generator for one purpose, so that a new task does not change what is drawn for others. */
export function randomFor(seed: number, purpose: string): RandomState {
  let hash = 0x811c9dc5 ^ seed;
  for (const character of purpose) hash = Math.imul(hash ^ (character.codePointAt(0) as number), 0x01000193);
  return { seed: hash | 0 };
}

/**
 * Returns the items in random order, every order equally likely (Fisher and Yates), and the next state of the
 * generator.
 */
export function shuffle<T>(
  items: readonly T[],
  random: RandomState,
): { readonly items: readonly T[]; readonly random: RandomState } {
  const shuffled = [...items];
  let state = random;
  for (let i = shuffled.length - 1; i > 0; i--) {
    const drawn = nextRandom(state);
    state = drawn.state;
    const j = Math.floor(drawn.value * (i + 1));
    [shuffled[i], shuffled[j]] = [shuffled[j] as T, shuffled[i] as T];
  }
  return { items: shuffled, random: state };
}
