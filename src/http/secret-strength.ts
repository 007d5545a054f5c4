/** The least entropy of a secret [bits]: 2^128 guesses are out of reach. */
const fewestSecretBits = 128;

/** Alphabets, smallest first; the first one that contains the whole secret decides the bits of a character. */
const alphabets = [
  { pattern: /^[0-9]*$/, size: 10 },
  { pattern: /^([0-9a-f]*|[0-9A-F]*)$/, size: 16 },
  { pattern: /^([0-9a-z]*|[0-9A-Z]*)$/, size: 36 },
  { pattern: /^([0-9a-z\W_]*|[0-9A-Z\W_]*)$/, size: 40 },
] as const;
const largestAlphabet = 64;

/** Entropy of a letter of English text, one to two bits (Shannon, Bell System Technical Journal 30, 1951). */
const bitsOfTextLetter = 2;
/** Runs of four or more letters of one case count as text if they make up this share of the secret. */
const textLetters = /[a-z]{4,}|[A-Z]{4,}/g;
const textShare = 0.45;
/** A repeated substring of this length or more adds only the bits that name its place and length. */
const shortestRepeat = 3;
const bitsOfRepeat = 8;

/** Returns the text without repeated substrings, and how many there were. */
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
 * Returns an upper bound of a secret's entropy [bits] from its length and alphabet; words and repetitions count little.
 * It cannot prove that a secret is random, but finds secrets that are not.
 */
export function secretEntropyBits(secret: string): number {
  const { kept, repeats } = withoutRepeats(secret);
  const { size } = alphabets.find(({ pattern }) => pattern.test(secret)) ?? { size: largestAlphabet };
  const letters = size === 16 ? 0 : (kept.match(textLetters) ?? []).reduce((sum, { length }) => sum + length, 0);
  const textual = letters < textShare * kept.length ? 0 : letters;
  const distinct = new Set(secret).size;
  const perCharacter = Math.min(Math.log2(size), distinct < 8 ? Math.log2(distinct) : Number.POSITIVE_INFINITY);
  return (kept.length - textual) * perCharacter + textual * bitsOfTextLetter + repeats * bitsOfRepeat;
}

/** Returns why a secret is too weak, as a clause that follows its name in a sentence; null: it is strong enough. */
export function secretWeakness(secret: string): string | null {
  const bits = Math.floor(secretEntropyBits(secret));
  if (bits >= fewestSecretBits) return null;
  return `has some ${bits} bits; it needs ${fewestSecretBits}. Generate one: openssl rand -base64 32`;
}
