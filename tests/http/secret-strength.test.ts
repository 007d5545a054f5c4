import { randomBytes } from 'node:crypto';
import { expect, test } from 'vitest';
import { secretWeakness } from '../../src/http/secret-strength';

test('a secret of fewer than 32 characters is refused, with the command for another', () => {
  for (const secret of ['', 'secret', 'x'.repeat(31)]) {
    expect(secretWeakness(secret)).toBe(
      `has ${secret.length} characters; it needs 32. Generate one: openssl rand -base64 32`,
    );
  }
});

test('a secret of 16 random bytes in hexadecimal digits, or of 32 in base64, is accepted', () => {
  expect(secretWeakness(randomBytes(16).toString('hex'))).toBeNull();
  expect(secretWeakness(randomBytes(32).toString('base64'))).toBeNull();
});
