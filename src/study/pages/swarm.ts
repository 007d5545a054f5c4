/**
 * Where dots of one diameter stand beside the middle of a strip so that none hides another, in the order of the values: each as near to
 * the middle as those before it leave room. Values and results in diameters; where the strip is narrower than the swarm, all move closer
 * together and dots overlap.
 */
export function swarm(values: readonly number[], width: number): readonly number[] {
  const placed: { readonly value: number; readonly beside: number }[] = [];
  const offsets = values.map(() => 0);
  const ascending = values.map((_, index) => index).sort((a, b) => (values[a] as number) - (values[b] as number));
  for (const index of ascending) {
    const value = values[index] as number;
    const near = placed.filter((other) => value - other.value < 1);
    const isFree = (beside: number) =>
      near.every((other) => Math.hypot(value - other.value, beside - other.beside) >= 1 - 1e-9);
    // Touching one that is there already, or in the middle: the nearest place is one of these.
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
