/** Whether a file is a table by its ending. */
export const isTable = (name: string): boolean => /\.[ct]sv$/i.test(name);

const none = 'holds no motion that can be opened. Open the recording, BVH or a VRM Animation instead';

/** Returns what a table is and what it is for, by its first line, as the reason for which it is not opened. */
export function purposeOfTable(text: string): string {
  const columns = (text.match(/^\uFEFF?(.*)/)?.[1] ?? '').split(/[,;\t]/).map((name) => name.replace(/^"|"$/g, ''));
  if (columns.includes('left_hand_seen'))
    return `it is a table of joint positions, for spreadsheets and statistics. It has no rotations and ${none}`;
  const subject = columns.includes('participant') ? 'a table of a study, for statistics' : 'a table, for spreadsheets';
  return `it is ${subject}, and ${none}`;
}
