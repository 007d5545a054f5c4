/** A point [m]; the mannequin faces +Z, its left is +X, its feet stand on y = 0. */
export type Point = readonly [number, number, number];

/** Distance [m] to a surface, negative inside. */
export type DistanceField = (x: number, y: number, z: number) => number;

/** A tapered capsule: the hull of two spheres. */
export function taperedCapsule(a: Point, b: Point, radiusA: number, radiusB: number): DistanceField {
  const bx = b[0] - a[0];
  const by = b[1] - a[1];
  const bz = b[2] - a[2];
  const l2 = bx * bx + by * by + bz * bz;
  const taper = radiusA - radiusB;
  const a2 = l2 - taper * taper;
  const inverse = 1 / l2;
  return (x, y, z) => {
    const px = x - a[0];
    const py = y - a[1];
    const pz = z - a[2];
    const along = px * bx + py * by + pz * bz;
    const beyond = along - l2;
    const qx = px * l2 - bx * along;
    const qy = py * l2 - by * along;
    const qz = pz * l2 - bz * along;
    const x2 = qx * qx + qy * qy + qz * qz;
    const y2 = along * along * l2;
    const z2 = beyond * beyond * l2;
    const k = Math.sign(taper) * taper * taper * x2;
    if (Math.sign(beyond) * a2 * z2 > k) return Math.sqrt(x2 + z2) * inverse - radiusB;
    if (Math.sign(along) * a2 * y2 < k) return Math.sqrt(x2 + y2) * inverse - radiusA;
    return (Math.sqrt(x2 * a2 * inverse) + along * taper) * inverse - radiusA;
  };
}

/** An ellipsoid, exact on its surface and nearly so around it; `pitch` [rad] turns it about X, top towards +Z. */
export function ellipsoid(centre: Point, radii: Point, pitch = 0): DistanceField {
  const c = Math.cos(pitch);
  const s = Math.sin(pitch);
  return (x, y, z) => {
    const px = x - centre[0];
    const wy = y - centre[1];
    const wz = z - centre[2];
    const py = c * wy + s * wz;
    const pz = c * wz - s * wy;
    const k0 = Math.hypot(px / radii[0], py / radii[1], pz / radii[2]);
    const k1 = Math.hypot(px / radii[0] ** 2, py / radii[1] ** 2, pz / radii[2] ** 2);
    return k1 < 1e-9 ? -Math.min(...radii) : (k0 * (k0 - 1)) / k1;
  };
}

/** A box with rounded edges; half sizes include the rounding. */
export function roundedBox(centre: Point, half: Point, rounding: number): DistanceField {
  return (x, y, z) => {
    const qx = Math.abs(x - centre[0]) - half[0] + rounding;
    const qy = Math.abs(y - centre[1]) - half[1] + rounding;
    const qz = Math.abs(z - centre[2]) - half[2] + rounding;
    const outside = Math.hypot(Math.max(qx, 0), Math.max(qy, 0), Math.max(qz, 0));
    return outside + Math.min(Math.max(qx, qy, qz), 0) - rounding;
  };
}

/** The union of two surfaces with a fillet of about `blend` [m] between them. */
export function smoothUnion(a: number, b: number, blend: number): number {
  const h = Math.max(blend - Math.abs(a - b), 0) / blend;
  return Math.min(a, b) - (h * h * h * blend) / 6;
}

/** The unit normal: the direction in which the distance grows. */
export function gradient(field: DistanceField, x: number, y: number, z: number, step = 5e-4): [number, number, number] {
  const gx = field(x + step, y, z) - field(x - step, y, z);
  const gy = field(x, y + step, z) - field(x, y - step, z);
  const gz = field(x, y, z + step) - field(x, y, z - step);
  const l = Math.hypot(gx, gy, gz) || 1;
  return [gx / l, gy / l, gz / l];
}
