/** Whether all are finite. Summed in a loop: `every` calls a function whose argument is allocated anew for each value. */
export function allFinite(values: Float32Array): boolean {
  let sum = 0;
  for (let i = 0; i < values.length; i++) sum += Math.abs(values[i]!);
  return Number.isFinite(sum);
}
