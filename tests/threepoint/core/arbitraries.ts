import fc from 'fast-check';
import { fromAxisAngle, multiply, normalise, normaliseQuat, type Quat, type Vec3, vec3 } from 'threepoint/math';

/** Every property of core starts from this seed, so that a failure can be repeated. */
export const seed = 2460;

/**
 * Numbers of [min, max] as fast-check draws them: evenly among the floating-point numbers, of which most lie next to
 * zero.
 */
export const number = (min: number, max: number): fc.Arbitrary<number> => fc.double({ min, max, noNaN: true });

/** Numbers of [min, max], evenly spread over it. */
export const evenly = (min: number, max: number): fc.Arbitrary<number> =>
  fc.integer({ min: 0, max: 2 ** 30 }).map((part) => min + (max - min) * (part / 2 ** 30));

export const vector = (size: number): fc.Arbitrary<Vec3> =>
  fc.tuple(evenly(-size, size), evenly(-size, size), evenly(-size, size)).map(([x, y, z]) => vec3(x, y, z));

/** Directions of length 1, the axes among them. */
export const direction: fc.Arbitrary<Vec3> = fc.oneof(
  vector(1).map((v) => normalise(v)),
  fc.constantFrom(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, -1), vec3(-1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1)),
);

/** Rotations of all kinds: none, quarter and half turns about axes, any other; both signs. */
export const rotation: fc.Arbitrary<Quat> = fc
  .tuple(
    direction,
    fc.oneof(evenly(-Math.PI, Math.PI), fc.constantFrom(0, Math.PI / 2, Math.PI, -Math.PI / 2, 1e-9)),
    fc.boolean(),
  )
  .map(([axis, angle, flipped]) => {
    const q = fromAxisAngle(axis, angle);
    return flipped ? { x: -q.x, y: -q.y, z: -q.z, w: -q.w } : q;
  });

/** The position and yaw of a person: properties never start at the origin facing −Z. */
export const standpoint = fc.record({ x: evenly(-3, 3), z: evenly(-3, 3), yaw: evenly(-Math.PI, Math.PI) });

export const composed = (...rotations: Quat[]): Quat => normaliseQuat(rotations.reduce((a, b) => multiply(a, b)));
