/** How archery is played, a sentence a line. */
export const archeryRulesText: readonly string[] = [
  'Five arrows, four targets from 4.5 to 10.5 m: 5, 10, 15 and 20 points, each target once. 70 seconds from the first arrow.',
  'Hold the bow in one hand. With the other hand press the trigger (or pinch) at the string, draw, and release.',
  'Stay on the deck: only arrows from there count.',
];
