/**
 * Returns Holm's adjusted p-values (Scandinavian Journal of Statistics 6, 1979) in the given order. A test without a p
 * (null) has none, but counts in the family: it was planned, and leaving it out would favour the others.
 */
export function holm(pValues: readonly (number | null)[]): readonly (number | null)[] {
  const order = pValues
    .map((p, index) => ({ p, index }))
    .filter((test): test is { p: number; index: number } => test.p !== null)
    .toSorted((a, b) => a.p - b.p);
  const adjusted: (number | null)[] = pValues.map(() => null);
  let largest = 0;
  order.forEach(({ p, index }, rank) => {
    largest = Math.max(largest, Math.min(1, (pValues.length - rank) * p));
    adjusted[index] = largest;
  });
  return adjusted;
}

/** Returns tests of one family with the adjusted p of each, and of its test by ranks. */
export function asFamily<T>(
  tests: readonly T[],
  pOf: (test: T) => number | null,
  ranksPOf: (test: T) => number | null,
): readonly (T & { readonly holmP: number | null; readonly ranksHolmP: number | null })[] {
  const holmP = holm(tests.map(pOf));
  const ranksHolmP = holm(tests.map(ranksPOf));
  return tests.map((test, index) => ({
    ...test,
    holmP: holmP[index] ?? null,
    ranksHolmP: ranksHolmP[index] ?? null,
  }));
}
