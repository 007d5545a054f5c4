/** What a secret that opens a server must have: guessing one of 2^128 takes longer than there is time. */
export const fewestSecretBits = 128;

/** Bits of one character, by the smallest of these alphabets that the whole secret fits in. */
const alphabets = [
  { pattern: /^[0-9]*$/, size: 10 },
  { pattern: /^([0-9a-f]*|[0-9A-F]*)$/, size: 16 },
  { pattern: /^([0-9a-z]*|[0-9A-Z]*)$/, size: 36 },
  { pattern: /^([0-9a-z\W_]*|[0-9A-Z\W_]*)$/, size: 40 },
] as const;
const largestAlphabet = 64;

/** English text has one to two bits a letter (Shannon, Bell System Technical Journal 30, 1951). */
const bitsOfTextLetter = 2;
/** So many letters of one case in a row may be text, and are taken for it where they make up this share of a secret. */
const textLetters = /[a-z]{4,}|[A-Z]{4,}/g;
const textShare = 0.45;
/** What stood there before, this long or longer, costs no more than saying where and how long. */
const shortestRepeat = 3;
const bitsOfRepeat = 8;

/** The text with every piece that stood there before left out, and how many pieces that were. */
function withoutRepeats(text: string): { readonly kept: string; readonly repeats: number } {
  let kept = '';
  let repeats = 0;
  for (let at = 0; at < text.length; ) {
    let length = 0;
    while (at + length < text.length && text.slice(0, at + length).includes(text.slice(at, at + length + 1))) length++;
    if (length >= shortestRepeat) {
      repeats += 1;
      at += length;
    } else {
      kept += text[at];
      at += 1;
    }
  }
  return { kept, repeats };
}

/**
 * How many bits a chosen secret has at most: by its length and alphabet, with words and repetitions counted for the little that they
 * are. It cannot know whether a secret was drawn or made up; it finds those that were plainly made up.
 */
export function secretBits(secret: string): number {
  const { kept, repeats } = withoutRepeats(secret);
  const { size } = alphabets.find(({ pattern }) => pattern.test(secret)) ?? { size: largestAlphabet };
  const letters = size === 16 ? 0 : (kept.match(textLetters) ?? []).reduce((sum, { length }) => sum + length, 0);
  const textual = letters < textShare * kept.length ? 0 : letters;
  const distinct = new Set(secret).size;
  const perCharacter = Math.min(Math.log2(size), distinct < 8 ? Math.log2(distinct) : Number.POSITIVE_INFINITY);
  return (kept.length - textual) * perCharacter + textual * bitsOfTextLetter + repeats * bitsOfRepeat;
}

/** Why this secret may not guard anything, as a sentence that goes on after its name; null: it may. */
export function weaknessOf(secret: string): string | null {
  const bits = Math.floor(secretBits(secret));
  if (bits >= fewestSecretBits) return null;
  return `has some ${bits} bits, and a secret that cannot be guessed needs ${fewestSecretBits}: let "openssl rand -base64 32" draw one.`;
}
