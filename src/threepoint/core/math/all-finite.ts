/** Returns whether all values are finite. A loop adds them up: `every` would allocate an argument for each call. */
export function allFinite(values: Float32Array): boolean {
  let sum = 0;
  for (let i = 0; i < values.length; i++) sum += Math.abs(values[i]!);
  return Number.isFinite(sum);
}
