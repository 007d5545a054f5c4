/**
 * Returns Holm's adjusted p-values (Scandinavian Journal of Statistics 6, 1979) in the given order. A test without a p
 * (null) has none, but counts in the family: it was planned, and leaving it out would favour the others. `undefined`
 * stands for a test that was not made, which does not count.
 */
export function holm(pValues: readonly (number | null | undefined)[]): readonly (number | null)[] {
  const size = pValues.filter((p) => p !== undefined).length;
  const order = pValues
    .map((p, index) => ({ p, index }))
    .filter((test): test is { p: number; index: number } => typeof test.p === 'number')
    .toSorted((a, b) => a.p - b.p);
  const adjusted: (number | null)[] = pValues.map(() => null);
  let largest = 0;
  order.forEach(({ p, index }, rank) => {
    largest = Math.max(largest, Math.min(1, (size - rank) * p));
    adjusted[index] = largest;
  });
  return adjusted;
}

/** Returns tests of one family with an adjusted p for each kind of p, by the name of the adjusted one. */
export function asFamily<T, Name extends string>(
  tests: readonly T[],
  pOf: Readonly<Record<Name, (test: T) => number | null | undefined>>,
): readonly (T & Readonly<Record<Name, number | null>>)[] {
  const names = Object.keys(pOf) as Name[];
  const adjusted = names.map((name) => [name, holm(tests.map(pOf[name]))] as const);
  return tests.map((test, index) => ({
    ...test,
    ...(Object.fromEntries(adjusted.map(([name, all]) => [name, all[index]])) as Record<Name, number | null>),
  }));
}
