import type { Mutable } from 'threepoint/core';
import { bisect, distance, type MutableVec3, setVec3, smoothstep, type Vec3, vec3 } from 'threepoint/math';

/**
 * The shape of a recurve bow in its own frame: grip at the origin, +Y along the upper limb, −Z to the target, so that
 * the string runs on the side of +Z. A limb lies in the plane x = 0: a point of its centre line and its direction
 * there.
 */
interface LimbPoint {
  readonly y: number;
  readonly z: number;
  /** Angle of the centre line from +Y towards +Z [rad]. */
  readonly angle: number;
}

/** A point of a limb that its owner overwrites as the limb bends. */
export type MutableLimbPoint = Mutable<LimbPoint>;

/** The height at which the limbs leave the riser, above and below the grip: y [m]. */
export const limbRoot = 0.23;
const limbLength = 0.53;
/** Points along a limb, root and tip included. */
export const limbPoints = 17;

/**
 * Writes the centre line of the upper limb into `limbPoints` points. `bend` [rad]: the rotation of its tip towards the
 * archer. The lower limb is its mirror image.
 */
export function bendLimb(bend: number, points: readonly MutableLimbPoint[]): void {
  let y = limbRoot;
  let z = 0;
  const step = limbLength / (limbPoints - 1);
  for (let i = 0; i < limbPoints; i++) {
    const along = i / (limbPoints - 1);
    // Unbent the limb leans back and curls away again at its end; it bends most near its root.
    const angle = 0.08 + 0.5 * along - 1.05 * smoothstep(0.5, 1, along) + bend * along * (1.55 - 0.55 * along);
    const point = points[i];
    if (point) {
      point.y = y;
      point.z = z;
      point.angle = angle;
    }
    y += Math.cos(angle) * step;
    z += Math.sin(angle) * step;
  }
}

export const makeLimb = (): readonly MutableLimbPoint[] =>
  Array.from({ length: limbPoints }, () => ({ y: 0, z: 0, angle: 0 }));

/** Scratch: the limb of the bend that is tried. */
const tried = makeLimb();

/** Computes the tip of the upper limb, where the string is tied. */
function tipOf(bend: number, target: MutableVec3): MutableVec3 {
  bendLimb(bend, tried);
  const { y, z } = tried[limbPoints - 1] as LimbPoint;
  return setVec3(target, 0, y, z);
}

/** Returns the largest bend [rad] that is not too far, to a thousandth of a degree. */
const bendBefore = (tooFar: (bend: number) => boolean): number => bisect(minBend, maxBend, tooFar, 21);

const minBend = -0.5;
const maxBend = 2.2;

/** The two ends of the string. */
interface Tips {
  readonly upper: MutableVec3;
  readonly lower: MutableVec3;
}

/**
 * A strung bow: how far its limbs bend for each place at which the middle of the string is held. Strings a bow so that
 * at rest its string is a straight line `braceHeight` [m] before the grip.
 */
export function stringBow(braceHeight: number) {
  const found: Tips = { upper: vec3(0, 0, 0), lower: vec3(0, 0, 0) };
  const { upper, lower } = found;
  const tips = (bend: number): Tips => {
    tipOf(bend, upper);
    setVec3(lower, 0, -upper.y, upper.z);
    return found;
  };
  const atRest = bendBefore((bend) => tips(bend).upper.z > braceHeight);
  const stringLength = 2 * tips(atRest).upper.y;
  let held: Vec3 = upper;
  const isTooFar = (bend: number): boolean => {
    tips(bend);
    return distance(upper, held) + distance(lower, held) < stringLength;
  };
  return {
    /** The length of the whole string [m]. */
    stringLength,
    /** The tips at a bend: the same objects in every call. */
    tips,
    /**
     * Bend [rad] at which the string of this length reaches from tip to `nock` to tip; a string too short even for the
     * most bend: the most bend.
     */
    bendFor(nock: Vec3): number {
      held = nock;
      return bendBefore(isTooFar);
    },
  };
}
