/** How the ball game is played, a sentence a line; `balls` and `seconds` of a match. */
export const ballRulesText = (balls: number, seconds: number): readonly string[] => [
  'Two players throw, the third holds the basket, 5 m away. Bots take free places.',
  `${balls} balls, ${Math.round(seconds)} seconds, a point for every ball that lands in the basket.`,
  'Throw: take a ball from the rack (trigger, grip or pinch), swing and release. Dropped balls return to the rack.',
  'Catch: the basket hangs between both hands, or at one, and opens where the thumbs point.',
  'Stay within 1.2 m of your mark: only throws from there count.',
  'A match starts when every player has pressed Ready.',
];
