/**
 * Returns the largest value in [low, high] at which the monotone predicate `tooFar` is still false, from below, to
 * within (high − low) / 2^halvings. Requires `tooFar(low)` to be false.
 */
export function bisect(low: number, high: number, tooFar: (value: number) => boolean, halvings: number): number {
  let from = low;
  let to = high;
  for (let i = 0; i < halvings; i++) {
    const middle = (from + to) / 2;
    if (tooFar(middle)) to = middle;
    else from = middle;
  }
  return from;
}
