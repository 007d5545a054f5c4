import { randomBytes } from 'node:crypto';

// Crockford's base 32 without letters that resemble digits, because a code is read from a note and typed.
const codeAlphabet = '0123456789ABCDEFGHJKMNPQRSTVWXYZ';

/** Returns eighty random bits as XXXX-XXXX-XXXX-XXXX. */
export function newCode(): string {
  const characters = Array.from(randomBytes(16), (byte) => codeAlphabet[byte % 32]).join('');
  return (characters.match(/.{4}/g) as string[]).join('-');
}

export function normalisedCode(typed: string): string {
  const characters = typed
    .toUpperCase()
    .replace(/[IL]/g, '1')
    .replace(/O/g, '0')
    .replace(/[^0-9A-Z]/g, '');
  return (characters.match(/.{1,4}/g) ?? []).join('-');
}
