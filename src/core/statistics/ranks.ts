/** Ranks from 1, ties sharing their mean rank, and the sizes of the groups of ties. */
export function ranksOf(values: readonly number[]): {
  readonly ranks: readonly number[];
  readonly ties: readonly number[];
} {
  const order = values.map((_, index) => index).toSorted((a, b) => (values[a] as number) - (values[b] as number));
  const ranks = new Array<number>(values.length);
  const ties: number[] = [];
  for (let start = 0; start < order.length; ) {
    let end = start + 1;
    while (end < order.length && values[order[end] as number] === values[order[start] as number]) end += 1;
    for (let i = start; i < end; i++) ranks[order[i] as number] = (start + 1 + end) / 2;
    if (end - start > 1) ties.push(end - start);
    start = end;
  }
  return { ranks, ties };
}

/** Σ (size³ − size) over groups of ties: what they take from the spread of ranks. */
export const cubesOf = (ties: readonly number[]): number => ties.reduce((sum, size) => sum + size ** 3 - size, 0);
