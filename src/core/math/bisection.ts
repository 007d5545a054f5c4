/** Halves an interval so many times. `tooFar` says on which side the wanted value lies: from the last that is not, to the first that is. */
export function bisect(
  low: number,
  high: number,
  tooFar: (value: number) => boolean,
  halvings: number,
): readonly [number, number] {
  let [from, to] = [low, high];
  for (let i = 0; i < halvings; i++) {
    const middle = (from + to) / 2;
    if (tooFar(middle)) to = middle;
    else from = middle;
  }
  return [from, to];
}
