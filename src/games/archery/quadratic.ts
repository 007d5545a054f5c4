const ascending = (first: number, second: number): number => first - second;

/**
 * Writes the real roots of a·t² + b·t + c into `target`, ascending and without cancellation. With a near 0 the equation
 * is linear; without real roots the list is empty.
 */
export function quadraticRoots(a: number, b: number, c: number, target: number[] = []): readonly number[] {
  target.length = 0;
  const discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return target;
  const q = -0.5 * (b + (b < 0 ? -1 : 1) * Math.sqrt(discriminant));
  if (q !== 0) target.push(c / q);
  // A coefficient this small is the rounding of an upright disc's normal; its root lies beyond every flight.
  if (Math.abs(a) > 1e-12) target.push(q / a);
  return target.sort(ascending);
}
