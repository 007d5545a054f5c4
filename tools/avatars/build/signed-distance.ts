/** A point [m]; the mannequin faces +Z, its left is +X, its feet stand on y = 0. */
export type Point = readonly [number, number, number];

/** Distance [m] to a surface, negative inside. */
export type DistanceField = (x: number, y: number, z: number) => number;

/** A piece with the box that holds it [m]. */
export interface Solid {
  readonly distance: DistanceField;
  readonly min: Point;
  readonly max: Point;
}

const solid = (distance: DistanceField, min: Point, max: Point): Solid => ({ distance, min, max });

/** Distance [m] to a box, 0 inside. */
export function distanceToBox(x: number, y: number, z: number, min: Point, max: Point): number {
  const dx = Math.max(min[0] - x, 0, x - max[0]);
  const dy = Math.max(min[1] - y, 0, y - max[1]);
  const dz = Math.max(min[2] - z, 0, z - max[2]);
  return Math.sqrt(dx * dx + dy * dy + dz * dz);
}

/** The box that holds all. */
export const boxOf = (solids: readonly Pick<Solid, 'min' | 'max'>[]): Pick<Solid, 'min' | 'max'> => {
  const bound = (of: 'min' | 'max', axis: number) => Math[of](...solids.map((each) => each[of][axis]!));
  return {
    min: [bound('min', 0), bound('min', 1), bound('min', 2)],
    max: [bound('max', 0), bound('max', 1), bound('max', 2)],
  };
};

/** Moves a piece by `by` and scales it by `factor` about a point. */
export function moved(piece: Solid, { about = [0, 0, 0], factor = [1, 1, 1], by = [0, 0, 0] }: Move): Solid {
  const there = (p: Point): Point => [
    about[0] + (p[0] - about[0]) * factor[0] + by[0],
    about[1] + (p[1] - about[1]) * factor[1] + by[1],
    about[2] + (p[2] - about[2]) * factor[2] + by[2],
  ];
  const least = Math.min(...factor);
  const [ax, ay, az] = [about[0] + by[0], about[1] + by[1], about[2] + by[2]];
  return solid(
    (x, y, z) =>
      least *
      piece.distance(about[0] + (x - ax) / factor[0], about[1] + (y - ay) / factor[1], about[2] + (z - az) / factor[2]),
    there(piece.min),
    there(piece.max),
  );
}

interface Move {
  readonly about?: Point;
  readonly factor?: Point;
  readonly by?: Point;
}

/** A tapered capsule: the hull of two spheres. */
export function taperedCapsule(a: Point, b: Point, radiusA: number, radiusB: number): Solid {
  const bx = b[0] - a[0];
  const by = b[1] - a[1];
  const bz = b[2] - a[2];
  const l2 = bx * bx + by * by + bz * bz;
  const taper = radiusA - radiusB;
  const a2 = l2 - taper * taper;
  const inverse = 1 / l2;
  const box = boxOf([ball(a, radiusA), ball(b, radiusB)]);
  const distance: DistanceField = (x, y, z) => {
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
  return solid(distance, box.min, box.max);
}

const ball = ([x, y, z]: Point, radius: number): Pick<Solid, 'min' | 'max'> => ({
  min: [x - radius, y - radius, z - radius],
  max: [x + radius, y + radius, z + radius],
});

/** An ellipsoid, exact on its surface and nearly so around it; `pitch` [rad] turns it about X, top towards +Z. */
export function ellipsoid(centre: Point, radii: Point, pitch = 0): Solid {
  const c = Math.cos(pitch);
  const s = Math.sin(pitch);
  const distance: DistanceField = (x, y, z) => {
    const px = x - centre[0];
    const wy = y - centre[1];
    const wz = z - centre[2];
    const py = c * wy + s * wz;
    const pz = c * wz - s * wy;
    const k0 = Math.hypot(px / radii[0], py / radii[1], pz / radii[2]);
    const k1 = Math.hypot(px / radii[0] ** 2, py / radii[1] ** 2, pz / radii[2] ** 2);
    return k1 < 1e-9 ? -Math.min(...radii) : (k0 * (k0 - 1)) / k1;
  };
  const { min, max } = ball(centre, Math.max(...radii));
  return solid(distance, min, max);
}

/** A box with rounded edges; half sizes include the rounding. */
export function roundedBox(centre: Point, half: Point, rounding: number): Solid {
  const distance: DistanceField = (x, y, z) => {
    const qx = Math.abs(x - centre[0]) - half[0] + rounding;
    const qy = Math.abs(y - centre[1]) - half[1] + rounding;
    const qz = Math.abs(z - centre[2]) - half[2] + rounding;
    const outside = Math.hypot(Math.max(qx, 0), Math.max(qy, 0), Math.max(qz, 0));
    return outside + Math.min(Math.max(qx, qy, qz), 0) - rounding;
  };
  const [x, y, z] = centre;
  return solid(distance, [x - half[0], y - half[1], z - half[2]], [x + half[0], y + half[1], z + half[2]]);
}

/** The union of two surfaces with a fillet of about `blend` [m] between them. */
export function smoothUnion(a: number, b: number, blend: number): number {
  const h = Math.max(blend - Math.abs(a - b), 0) / blend;
  return Math.min(a, b) - (h * h * h * blend) / 6;
}

/** What is inside both, its edge rounded by about `blend` [m]. */
export const smoothBoth = (a: number, b: number, blend: number): number => -smoothUnion(-a, -b, blend);

/** Rises from 0 at `start` to 1 at `end` [or falls, where the end is less], without a corner. */
export const smoothstep = (start: number, end: number, value: number): number => {
  const t = Math.max(0, Math.min(1, (value - start) / (end - start)));
  return t * t * (3 - 2 * t);
};

/** The unit normal: the direction in which the distance grows. */
export function gradient(field: DistanceField, x: number, y: number, z: number, step = 5e-4): [number, number, number] {
  const gx = field(x + step, y, z) - field(x - step, y, z);
  const gy = field(x, y + step, z) - field(x, y - step, z);
  const gz = field(x, y, z + step) - field(x, y, z - step);
  const l = Math.hypot(gx, gy, gz) || 1;
  return [gx / l, gy / l, gz / l];
}
