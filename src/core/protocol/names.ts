/** A name has at most this many characters, and this many bytes as UTF-8. */
export const longestName = 20;
const mostNameBytes = 40;

/** Bytes of a character in UTF-8. */
const utf8Bytes = (character: string): number => {
  const code = character.codePointAt(0) ?? 0;
  if (code < 0x80) return 1;
  if (code < 0x800) return 2;
  return code < 0x10000 ? 3 : 4;
};

/**
 * What a person calls themselves as plain text: no control characters, nothing that turns the direction of writing or cannot be
 * seen, single spaces, at most 20 characters. Empty where nothing is left.
 */
export function cleanName(name: string): string {
  const visible = name
    .normalize('NFC')
    .replace(/[\s\p{Zl}\p{Zp}]+/gu, ' ')
    .replace(/[\p{Cc}\p{Cf}\p{Cs}\p{Co}\p{Cn}]/gu, '')
    .replace(/ +/g, ' ')
    .trim();
  let kept = '';
  let bytes = 0;
  let count = 0;
  for (const character of visible) {
    bytes += utf8Bytes(character);
    count += 1;
    if (count > longestName || bytes > mostNameBytes) break;
    kept += character;
  }
  return kept.trim();
}
