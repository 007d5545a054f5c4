/** A point or direction; metres where it is a position. Right-handed, +Y up, −Z forward. */
export interface Vec3 {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}

export const zero: Vec3 = { x: 0, y: 0, z: 0 };
export const right: Vec3 = { x: 1, y: 0, z: 0 };
export const up: Vec3 = { x: 0, y: 1, z: 0 };
export const forward: Vec3 = { x: 0, y: 0, z: -1 };

export const vec3 = (x: number, y: number, z: number): Vec3 => ({ x, y, z });

export const add = (a: Vec3, b: Vec3): Vec3 => ({ x: a.x + b.x, y: a.y + b.y, z: a.z + b.z });

export const subtract = (a: Vec3, b: Vec3): Vec3 => ({ x: a.x - b.x, y: a.y - b.y, z: a.z - b.z });

export const scale = (a: Vec3, factor: number): Vec3 => ({ x: a.x * factor, y: a.y * factor, z: a.z * factor });

/** a + b·factor. */
export const addScaled = (a: Vec3, b: Vec3, factor: number): Vec3 => ({
  x: a.x + b.x * factor,
  y: a.y + b.y * factor,
  z: a.z + b.z * factor,
});

export const dot = (a: Vec3, b: Vec3): number => a.x * b.x + a.y * b.y + a.z * b.z;

export const cross = (a: Vec3, b: Vec3): Vec3 => ({
  x: a.y * b.z - a.z * b.y,
  y: a.z * b.x - a.x * b.z,
  z: a.x * b.y - a.y * b.x,
});

/** Math.hypot is several times slower: only where squares overflow or vanish. */
function hypotenuse(x: number, y: number, z: number): number {
  const squares = x * x + y * y + z * z;
  return squares > 1e-280 && squares < 1e280 ? Math.sqrt(squares) : Math.hypot(x, y, z);
}

export const length = (a: Vec3): number => hypotenuse(a.x, a.y, a.z);

export const distance = (a: Vec3, b: Vec3): number => hypotenuse(a.x - b.x, a.y - b.y, a.z - b.z);

/** The unit vector along a; `fallback` where a is shorter than 1e-9. */
export function normalise(a: Vec3, fallback: Vec3 = up): Vec3 {
  const l = length(a);
  return l < 1e-9 ? fallback : scale(a, 1 / l);
}

/** The part of a at right angles to the unit vector `axis`. */
export const reject = (a: Vec3, axis: Vec3): Vec3 => addScaled(a, axis, -dot(a, axis));

/** From a (t = 0) to b (t = 1) along the straight line. */
export const lerp = (a: Vec3, b: Vec3, t: number): Vec3 => ({
  x: a.x + (b.x - a.x) * t,
  y: a.y + (b.y - a.y) * t,
  z: a.z + (b.z - a.z) * t,
});

export const isFiniteVec3 = (a: Vec3): boolean => Number.isFinite(a.x + a.y + a.z);
