import { createHash } from 'node:crypto';
import { describe, expect, test } from 'vitest';
import { secretEntropyBits, secretWeakness } from '../../src/http/secret-strength';

describe('a secret', () => {
  test.each([
    ['a word', 'secret'],
    ['words', 'an-experimenter-token-of-length'],
    ['one letter, often', 'x'.repeat(64)],
    ['a keyboard row, twice', 'qwertyuiop1234567890qwertyuiop1234567890'],
    ['a short piece, often', 'aB3-aB3-aB3-aB3-aB3-aB3-aB3-aB3-'],
    ['digits of a date and a name', 'Laboratory-of-Movement-2026'],
    ['digits alone', '31415926535897932384626433832795028'],
    ['a drawn one that is too short', 'kN3vQ9xT1mB7rW5c'],
  ])('that is %s is refused', (_what, secret) => {
    expect(secretWeakness(secret)).toMatch(/^has some \d+ bits; it needs 128/);
  });

  test('of 32 drawn bytes is taken, for every draw, in letters or in hexadecimal', () => {
    for (let draw = 0; draw < 3000; draw++) {
      const drawn = createHash('sha256').update(`draw ${draw}`).digest().subarray(0, 32);
      for (const encoding of ['base64', 'base64url', 'hex'] as const) {
        expect(secretWeakness(drawn.toString(encoding)), drawn.toString(encoding)).toBeNull();
      }
    }
  });

  test('has no more bits for being said twice', () => {
    const once = 'kN3vQ9xT1mB7rW5cY2nL';
    expect(secretEntropyBits(once + once) - secretEntropyBits(once)).toBeLessThan(10);
  });
});
