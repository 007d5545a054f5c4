/** Prints the figures that a test has measured. */
export const printFigures = (row: string, figures: Readonly<Record<string, string | number>>): void =>
  console.log(
    `${row}: ${Object.entries(figures)
      .map(([name, value]) => `${name} ${typeof value === 'number' ? Number(value.toFixed(2)) : value}`)
      .join(', ')}`,
  );

/** Returns the value below which this share of the values lies. */
export const percentile = (values: readonly number[], share: number): number => {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(sorted.length * share))] ?? Number.NaN;
};
