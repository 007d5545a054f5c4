/**
 * The last value that is not too far, in [low, high], to (high − low) / 2^halvings: `low` is not, and all beyond the first that
 * is are.
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
