import { cross, dot, length, normalise, type Vec3, vec3 } from './vec3';

/** A rotation as a unit quaternion, component order xyzw wherever it becomes an array. */
export interface Quat {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly w: number;
}

export const identity: Quat = { x: 0, y: 0, z: 0, w: 1 };

/** The rotation b followed by a. */
export const multiply = (a: Quat, b: Quat): Quat => ({
  x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
  y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
  z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
  w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
});

/** The inverse of a unit quaternion. */
export const conjugate = (q: Quat): Quat => ({ x: -q.x, y: -q.y, z: -q.z, w: q.w });

/** v rotated by q. */
export function rotate(q: Quat, v: Vec3): Vec3 {
  const tx = 2 * (q.y * v.z - q.z * v.y);
  const ty = 2 * (q.z * v.x - q.x * v.z);
  const tz = 2 * (q.x * v.y - q.y * v.x);
  return {
    x: v.x + q.w * tx + q.y * tz - q.z * ty,
    y: v.y + q.w * ty + q.z * tx - q.x * tz,
    z: v.z + q.w * tz + q.x * ty - q.y * tx,
  };
}

/** q scaled to length 1; the identity where it has none. */
export function normaliseQuat(q: Quat): Quat {
  const l = Math.hypot(q.x, q.y, q.z, q.w);
  return l < 1e-12 ? identity : { x: q.x / l, y: q.y / l, z: q.z / l, w: q.w / l };
}

/** The rotation by `angle` [rad] about a unit axis. */
export function fromAxisAngle(axis: Vec3, angle: number): Quat {
  const s = Math.sin(angle / 2);
  return { x: axis.x * s, y: axis.y * s, z: axis.z * s, w: Math.cos(angle / 2) };
}

/** The smallest rotation from the direction of one vector to that of another; half a turn about any normal when they oppose. */
export function between(from: Vec3, to: Vec3): Quat {
  const a = normalise(from);
  const b = normalise(to);
  const w = 1 + dot(a, b);
  if (w < 1e-9) {
    const normal = normalise(cross(a, Math.abs(a.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    return { x: normal.x, y: normal.y, z: normal.z, w: 0 };
  }
  const c = cross(a, b);
  return normaliseQuat({ x: c.x, y: c.y, z: c.z, w });
}

/** The rotation whose x, y, z axes are these (orthonormal, right-handed). */
export function fromAxes(x: Vec3, y: Vec3, z: Vec3): Quat {
  const trace = x.x + y.y + z.z;
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    return normaliseQuat({ x: (y.z - z.y) / s, y: (z.x - x.z) / s, z: (x.y - y.x) / s, w: s / 4 });
  }
  if (x.x > y.y && x.x > z.z) {
    const s = 2 * Math.sqrt(1 + x.x - y.y - z.z);
    return normaliseQuat({ x: s / 4, y: (x.y + y.x) / s, z: (z.x + x.z) / s, w: (y.z - z.y) / s });
  }
  if (y.y > z.z) {
    const s = 2 * Math.sqrt(1 + y.y - x.x - z.z);
    return normaliseQuat({ x: (x.y + y.x) / s, y: s / 4, z: (y.z + z.y) / s, w: (z.x - x.z) / s });
  }
  const s = 2 * Math.sqrt(1 + z.z - x.x - y.y);
  return normaliseQuat({ x: (z.x + x.z) / s, y: (y.z + z.y) / s, z: s / 4, w: (x.y - y.x) / s });
}

/**
 * The rotation that takes the direction `fromMain` to `toMain` exactly and `fromSide` as near to `toSide` as that allows.
 * Parallel main and side: the twist is the smallest rotation's.
 */
export function alignDirections(fromMain: Vec3, fromSide: Vec3, toMain: Vec3, toSide: Vec3): Quat {
  const frame = (main: Vec3, side: Vec3): Quat | null => {
    const m = normalise(main);
    const n = cross(m, side);
    if (length(n) < 1e-6 * (length(side) + 1e-12)) return null;
    const normal = normalise(n);
    return fromAxes(m, cross(normal, m), normal);
  };
  const to = frame(toMain, toSide);
  const from = frame(fromMain, fromSide);
  return to && from ? multiply(to, conjugate(from)) : between(fromMain, toMain);
}

/** Along the shorter arc from a (t = 0) to b (t = 1). */
export function slerp(a: Quat, b: Quat, t: number): Quat {
  const cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  const sign = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(cosine)));
  const sine = Math.sin(angle);
  const u = sine < 1e-6 ? 1 - t : Math.sin((1 - t) * angle) / sine;
  const v = (sine < 1e-6 ? t : Math.sin(t * angle) / sine) * sign;
  return normaliseQuat({ x: a.x * u + b.x * v, y: a.y * u + b.y * v, z: a.z * u + b.z * v, w: a.w * u + b.w * v });
}

/** The angle [0, π] between two rotations; q and −q are the same rotation. */
export function angleBetween(a: Quat, b: Quat): number {
  const d = multiply(conjugate(a), b);
  return 2 * Math.atan2(Math.hypot(d.x, d.y, d.z), Math.abs(d.w));
}

/** q = swing·twist: the twist is about the unit axis, the swing about an axis at right angles to it. Half-turn swings: no twist. */
export function swingTwist(q: Quat, axis: Vec3): { readonly swing: Quat; readonly twist: Quat } {
  const along = q.x * axis.x + q.y * axis.y + q.z * axis.z;
  const twist = normaliseQuat({ x: axis.x * along, y: axis.y * along, z: axis.z * along, w: q.w });
  return { swing: multiply(q, conjugate(twist)), twist };
}

/** The signed angle (−π, π] of a rotation about a unit axis, from its twist part. */
export function twistAngle(q: Quat, axis: Vec3): number {
  const along = q.x * axis.x + q.y * axis.y + q.z * axis.z;
  const angle = 2 * Math.atan2(along, q.w);
  return angle > Math.PI ? angle - 2 * Math.PI : angle <= -Math.PI ? angle + 2 * Math.PI : angle;
}

/** The rotation by at most `limit` [rad] in the direction of q. */
export function limitAngle(q: Quat, limit: number): Quat {
  const angle = angleBetween(identity, q);
  return angle <= limit ? q : slerp(identity, q, limit / angle);
}

/** Angles [rad] about x, y, z of the intrinsic decomposition Ry·Rx·Rz. */
export function toEulerYxz(q: Quat): Vec3 {
  const m12 = 2 * (q.y * q.z - q.x * q.w);
  return {
    x: Math.asin(Math.max(-1, Math.min(1, -m12))),
    y: Math.atan2(2 * (q.x * q.z + q.y * q.w), 1 - 2 * (q.x * q.x + q.y * q.y)),
    z: Math.atan2(2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z)),
  };
}

/** Ry·Rx·Rz of angles [rad] about x, y, z. */
export function fromEulerYxz(angles: Vec3): Quat {
  const about = (x: number, y: number, z: number, angle: number) => fromAxisAngle(vec3(x, y, z), angle);
  return multiply(about(0, 1, 0, angles.y), multiply(about(1, 0, 0, angles.x), about(0, 0, 1, angles.z)));
}
