import { clamp } from '../math/damper';
import { fromAxisAngle, type MutableQuat, multiply, quat, rotate, rotateInverse, rotationBetween } from '../math/quat';
import {
  add,
  backward,
  cross,
  dot,
  forward,
  type MutableVec3,
  normalise,
  reject,
  right,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../math/vec3';
import { recordOf } from '../records';
import proportions from './hand-geometry.json' with { type: 'json' };
import { type FingerBend, type FingerName, fingerNames, type MutableFingerBend } from './hand-shape';

/**
 * Points and directions of this file are in the frame of a left wrist: −Z towards the knuckles, +Y out of the back of
 * the hand, +X towards the thumb. A right hand is its mirror image at x = 0: `mirrorPoint`.
 */
export interface FingerGeometry {
  /** The joint of the first bone [m]; for the thumb the base of its metacarpal. */
  readonly root: Vec3;
  /** The lengths between joints, and from the last one to the centre of the fingertip's curvature [m]. */
  readonly lengths: readonly [number, number, number];
  /** The radius of the finger at its tip, and at its root [m]. */
  readonly tipRadius: number;
  readonly rootRadius: number;
}

export type HandGeometry = Readonly<Record<FingerName, FingerGeometry>>;

/** The three joints of a finger and the centre of the fingertip's curvature [m]. */
export type FingerPoints = readonly [MutableVec3, MutableVec3, MutableVec3, MutableVec3];

export const makeFingerPoints = (): FingerPoints => [vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0)];

/** Orientations of the three bones of a finger: −Z along the bone, +X the axis about which they bend (backward). */
type FingerFrames = readonly [MutableQuat, MutableQuat, MutableQuat];

export const makeFingerFrames = (): FingerFrames => [quat(0, 0, 0, 1), quat(0, 0, 0, 1), quat(0, 0, 0, 1)];

/** Mirrors a point from the left hand's frame to the right one's, or back. */
export const mirrorPoint = (point: Vec3, target: MutableVec3): MutableVec3 =>
  setVec3(target, -point.x, point.y, point.z);

/** Mirrors a rotation in place from the left hand's frame to the right one's, or back. */
export function mirrorRotation(q: MutableQuat): MutableQuat {
  q.y = -q.y;
  q.z = -q.z;
  return q;
}

/**
 * The thumb of a hand at ease: where its metacarpal points, and the axis about which the bones beyond bend. Where the
 * metacarpal swings, the axis goes along by the shortest way: within 4° (pointing) and 12° (pinching) of the hands that
 * iwer recorded.
 */
const thumbAtEase = normalise(vec3(0.639, -0.324, -0.697));
const thumbAxisAtEase = normalise(reject(vec3(0.053, -0.886, 0.461), thumbAtEase));
const thumbFrameAtEase = frameAlong(thumbAtEase, thumbAxisAtEase, quat(0, 0, 0, 1));

/** Returns the frame with −Z along a unit direction and +X along a unit axis normal to it. */
function frameAlong(direction: Vec3, axis: Vec3, target: MutableQuat): MutableQuat {
  const swing = rotationBetween(forward, direction, target);
  const swungRight = rotate(swing, right);
  const angle = Math.atan2(dot(cross(swungRight, axis), direction), dot(swungRight, axis));
  return multiply(fromAxisAngle(direction, angle), swing, target);
}

/**
 * How the axes of the other fingers are rolled about their bones [rad], and more with the knuckle's bend: bent fingers
 * meet before the ball of the thumb. Of the hands that iwer recorded; without it the little finger of a fist ends 2 cm
 * beside the tracked one.
 */
const rolls = {
  index: { straight: -0.03, perKnuckle: -0.14 },
  middle: { straight: 0.02, perKnuckle: 0.08 },
  ring: { straight: 0.11, perKnuckle: 0.1 },
  little: { straight: 0.18, perKnuckle: 0.14 },
} as const;

const direction = vec3(0, 0, 0);
const turn = quat(0, 0, 0, 1);

/** Returns the direction of a finger's first bone, unit. */
const firstDirection = ({ knuckle, spread }: FingerBend, target: MutableVec3): MutableVec3 =>
  setVec3(target, Math.sin(spread), -Math.cos(spread) * Math.sin(knuckle), -Math.cos(spread) * Math.cos(knuckle));

/** Writes the orientations of a finger's three bones. */
export function fingerFrames(name: FingerName, bend: FingerBend, target: FingerFrames): FingerFrames {
  const [first, second, third] = target;
  firstFrame(name, bend, first);
  multiply(first, fromAxisAngle(right, -bend.middle, turn), second);
  multiply(second, fromAxisAngle(right, -bend.end, turn), third);
  return target;
}

function firstFrame(name: FingerName, bend: FingerBend, target: MutableQuat): MutableQuat {
  if (name === 'thumb') {
    rotationBetween(thumbAtEase, firstDirection(bend, direction), turn);
    return multiply(turn, thumbFrameAtEase, target);
  }
  fromAxisAngle(right, -bend.knuckle, target);
  multiply(target, fromAxisAngle(up, -bend.spread, turn), target);
  const { straight, perKnuckle } = rolls[name];
  return multiply(target, fromAxisAngle(backward, straight + perKnuckle * bend.knuckle, turn), target);
}

const frames = makeFingerFrames();
const along = vec3(0, 0, 0);

/** Returns the joints and the tip of a bent finger [m]. */
export function fingerPoints(
  name: FingerName,
  { root, lengths }: FingerGeometry,
  bend: FingerBend,
  target: FingerPoints,
): FingerPoints {
  fingerFrames(name, bend, frames);
  setVec3(target[0], root.x, root.y, root.z);
  for (let i = 0; i < 3; i++) {
    rotate(frames[i as 0 | 1 | 2], setVec3(along, 0, 0, -lengths[i as 0 | 1 | 2]), along);
    add(target[i as 0 | 1 | 2], along, target[(i + 1) as 1 | 2 | 3]);
  }
  return target;
}

const firstBone = vec3(0, 0, 0);
const localBone = vec3(0, 0, 0);

/** Returns the bend [rad] of `to` relative to −Z of a bone's frame, about its −X. */
function bendAgainst(frame: MutableQuat, to: Vec3): number {
  const local = rotateInverse(frame, to, localBone);
  return Math.atan2(-local.y, -local.z);
}

/**
 * Computes the bend of a finger from its joints and tip: exactly for the first bone, as a hinge for the others. A NaN
 * position gives at least one NaN bend.
 */
export function bendFromPoints(name: FingerName, points: FingerPoints, target: MutableFingerBend): MutableFingerBend {
  const [first, second, third, tip] = points;
  const bone = normalise(subtract(second, first, firstBone), undefined, firstBone);
  target.spread = Math.asin(clamp(bone.x, -1, 1));
  target.knuckle = Math.atan2(-bone.y, -bone.z);
  const frame = firstFrame(name, target, frames[0]);
  target.middle = bendAgainst(frame, subtract(third, second, firstBone));
  multiply(frame, fromAxisAngle(right, -target.middle, turn), frame);
  target.end = bendAgainst(frame, subtract(tip, third, firstBone));
  return target;
}

const fingertip = 0.006;

/** Returns the hand of an average person with this eye height [m], which is the mannequin's. */
export function averageHand(eyeHeight: number): HandGeometry {
  const size = eyeHeight / proportions.eyeHeight;
  return recordOf(fingerNames, (name) => {
    const { knuckle, lengths, radius } = proportions[name];
    return {
      root: vec3(knuckle[0]! * size, knuckle[1]! * size, -knuckle[2]! * size),
      lengths: [lengths[0]! * size, lengths[1]! * size, (lengths[2]! - fingertip) * size] as const,
      tipRadius: 0.75 * radius * size,
      rootRadius: radius * size,
    };
  });
}

export const scaledHand = (hand: HandGeometry, size: number): HandGeometry =>
  recordOf(fingerNames, (name) => {
    const { root, lengths, tipRadius, rootRadius } = hand[name];
    return {
      root: scale(root, size),
      lengths: [lengths[0] * size, lengths[1] * size, lengths[2] * size] as const,
      tipRadius: tipRadius * size,
      rootRadius: rootRadius * size,
    };
  });
