/**
 * Places dots of equal diameter beside the middle of a strip without overlap, in the order of the values, as near to
 * the middle as possible. Values and results are in diameters. If the strip is narrower than the swarm, all dots move
 * closer together and overlap.
 */
export function swarmOffsets(values: readonly number[], width: number): readonly number[] {
  const placed: { readonly value: number; readonly beside: number }[] = [];
  const offsets = values.map(() => 0);
  const ascending = values.map((_, index) => index).sort((a, b) => (values[a] as number) - (values[b] as number));
  for (const index of ascending) {
    const value = values[index] as number;
    const near = placed.filter((other) => value - other.value < 1);
    const isFree = (beside: number) =>
      near.every((other) => Math.hypot(value - other.value, beside - other.beside) >= 1 - 1e-9);
    // The nearest free position touches an earlier dot or is in the middle.
    const candidates = near.flatMap((other) => {
      const aside = Math.sqrt(1 - (value - other.value) ** 2);
      return [other.beside + aside, other.beside - aside];
    });
    const beside = [0, ...candidates]
      .filter(isFree)
      .reduce((best, one) => (Math.abs(one) < Math.abs(best) ? one : best), Number.POSITIVE_INFINITY);
    placed.push({ value, beside });
    offsets[index] = beside;
  }
  const widest = Math.max(0, ...offsets.map(Math.abs));
  const most = Math.max(0, (width - 1) / 2);
  return widest > most ? offsets.map((beside) => (beside * most) / widest) : offsets;
}
