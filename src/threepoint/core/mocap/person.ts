import type { Calibration } from '../body/calibration';
import { conjugate, fromAxisAngle, multiply, type Quat, quat, rotate } from '../math/quat';
import { sides } from '../math/side';
import { median, quantile } from '../math/statistics';
import { forward, length, right, subtract, vec3 } from '../math/vec3';
import { headingOf } from '../tracking/heading';
import mocapRules from './mocap-rules.json' with { type: 'json' };
import { armSpanAtRest, eyeHeightAtRest } from './rest-joints';
import type { TruthJoint } from './skeleton-map';
import { positionAt, rotationAt, type TruthMotion } from './truth-motion';

const { eyesFromHeadJoint } = mocapRules;

/** Frames of a motion, from one to before another. */
export interface Piece {
  readonly from: number;
  readonly to: number;
}

/** The smallest cosine between the trunk and the vertical of an upright person. */
const upright = 0.94;
/**
 * The height of a foot's lowest joint above the floor [m], and its largest deviation before another floor height is
 * assumed.
 */
const footHeight = 0.025;
const floorTolerance = 0.04;

/** Yields the heights [m] of a joint over pieces. */
function* heightsOf(motion: TruthMotion, pieces: readonly Piece[], joint: TruthJoint): Generator<number> {
  for (const { from, to } of pieces)
    for (let frame = from; frame < to; frame++) yield positionAt(motion, frame, joint).y;
}

export function measuresOf(motion: TruthMotion, pieces: readonly Piece[]): Calibration {
  const { rest } = motion;
  const eyesInMotion = () => quantile([...heightsOf(motion, pieces, 'head')], 0.9) + eyesFromHeadJoint[1]!;
  return { eyeHeight: eyeHeightAtRest(rest) ?? eyesInMotion(), armSpan: armSpanAtRest(rest) };
}

/**
 * Returns the head's rotation when this person looks ahead: its median pitch and roll over frames with an upright
 * trunk.
 */
export function neutralHead(motion: TruthMotion, pieces: readonly Piece[]): Quat {
  const pitches: number[] = [];
  const rolls: number[] = [];
  const head = quat(0, 0, 0, 1);
  const gaze = vec3(0, 0, 0);
  for (const { from, to } of pieces) {
    for (let frame = from; frame < to; frame++) {
      const trunk = subtract(positionAt(motion, frame, 'neck'), positionAt(motion, frame, 'hips'));
      if (!(trunk.y > upright * length(trunk))) continue;
      rotationAt(motion, frame, 0, head);
      multiply(conjugate(headingOf(head)), head, head);
      rotate(head, forward, gaze);
      pitches.push(Math.atan2(gaze.y, -gaze.z));
      rolls.push(Math.asin(Math.max(-1, Math.min(1, rotate(head, right, gaze).y))));
    }
  }
  if (pitches.length === 0) return quat(0, 0, 0, 1);
  return multiply(fromAxisAngle(right, median(pitches)), fromAxisAngle({ x: 0, y: 0, z: 1 }, median(rolls)));
}

/**
 * Returns the height [m] of the floor on which the lowest joint of the feet usually stands; 0 without feet, or within
 * the tolerance.
 */
export function floorHeight(motion: TruthMotion, pieces: readonly Piece[]): number {
  const { rest } = motion;
  const feet = sides.flatMap((side) => [`${side}Foot`, `${side}Toes`] as const).filter((joint) => rest.has(joint));
  if (feet.length === 0) return 0;
  const lowest: number[] = [];
  for (const { from, to } of pieces)
    for (let frame = from; frame < to; frame++)
      lowest.push(Math.min(...feet.map((joint) => positionAt(motion, frame, joint).y)));
  const offset = quantile(lowest, 0.1) - footHeight;
  return Math.abs(offset) > floorTolerance ? offset : 0;
}
