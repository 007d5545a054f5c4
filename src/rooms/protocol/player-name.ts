/** The most characters of a name, and the most bytes as UTF-8. */
export const maxNameLength = 20;
const maxNameBytes = 40;

/** Returns the bytes of a character in UTF-8. */
const utf8Bytes = (character: string): number => {
  const code = character.codePointAt(0) ?? 0;
  if (code < 0x80) return 1;
  if (code < 0x800) return 2;
  return code < 0x10000 ? 3 : 4;
};

/** Control and unassigned characters, direction marks, and invisible ones: fillers, selectors, U+2800. */
const invisible = /[\p{Cc}\p{Cf}\p{Cs}\p{Co}\p{Cn}\p{Default_Ignorable_Code_Point}\u2800]/gu;
/** Combining marks beyond the third: no language needs more, and many of them cover other text. */
const excessMarks = /(?<=\p{M}{3})\p{M}+/gu;
const leadingMarks = /^[\p{M} ]+/u;

/**
 * Returns a name as plain text: without control characters, direction marks and invisible characters, with at most
 * three marks on a letter, single spaces, and at most 20 characters. Empty if nothing is left.
 */
export function cleanName(name: string): string {
  const visible = name
    .replace(/[\s\p{Zl}\p{Zp}]+/gu, ' ')
    .replace(invisible, '')
    .normalize('NFC')
    .replace(excessMarks, '')
    .replace(/ +/g, ' ')
    .replace(leadingMarks, '')
    .trim();
  let kept = '';
  let bytes = 0;
  let count = 0;
  for (const character of visible) {
    bytes += utf8Bytes(character);
    count += 1;
    if (count > maxNameLength || bytes > maxNameBytes) break;
    kept += character;
  }
  return kept.trim();
}
