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

/** Control characters, unassigned ones, those that turn the direction of writing, and those that draw nothing: fillers, selectors, U+2800. */
const unseen = /[\p{Cc}\p{Cf}\p{Cs}\p{Co}\p{Cn}\p{Default_Ignorable_Code_Point}\u2800]/gu;
/** Marks beyond the third on a letter: no language needs more, and heaps of them cover other text. */
const heapedMarks = /(?<=\p{M}{3})\p{M}+/gu;
const leadingMarks = /^[\p{M} ]+/u;

/**
 * A participant's name as plain text: no control characters, nothing that turns the direction of writing or cannot be seen, three marks on a
 * letter, single spaces, at most 20 characters. Empty where nothing is left.
 */
export function cleanName(name: string): string {
  const visible = name
    .replace(/[\s\p{Zl}\p{Zp}]+/gu, ' ')
    .replace(unseen, '')
    .normalize('NFC')
    .replace(heapedMarks, '')
    .replace(/ +/g, ' ')
    .replace(leadingMarks, '')
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
