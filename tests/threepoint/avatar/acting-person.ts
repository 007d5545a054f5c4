import fc from 'fast-check';
import {
  add,
  fromAxisAngle,
  lerp,
  multiply,
  type Quat,
  right,
  rotate,
  subtract,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import type { LegPosture } from '../../../src/threepoint/avatar/legs/leg-posture';
import type { Calibration } from '../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../src/threepoint/core/body/forward-kinematics';
import { averageSkeleton } from '../../../src/threepoint/core/body/skeleton';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { yawOfHips } from '../../../src/threepoint/core/estimation/gait/gait-features';
import type { PoseEstimator } from '../../../src/threepoint/core/estimation/pose-estimator';
import { clamp, smoothstep } from '../../../src/threepoint/core/math/damper';
import { evenly } from '../core/arbitraries';
import { tracked } from '../core/estimation/moving-person';
import { createLegs, eyeHeight, proportions } from './walking-person';

/** A posture of a person's head and hands. Lengths [m], angles [rad]. */
export interface Posture {
  /** The head on the floor plan, and the yaw of the body. */
  readonly x: number;
  readonly z: number;
  readonly yaw: number;
  readonly eyes: number;
  /** The yaw of the head against the body, and its pitch up. */
  readonly look: number;
  readonly pitch: number;
  /** 0: the right hand hangs, 1: it is at the left shoulder. */
  readonly across: number;
  /** 0: the left hand hangs, 1: it points ahead. */
  readonly ahead: number;
}

/** A change of the posture within some seconds, and whether the head flies up meanwhile. */
export interface Act extends Partial<Posture> {
  readonly seconds: number;
  readonly jumps?: boolean;
}

const upright: Posture = { x: 0, z: 0, yaw: 0, eyes: eyeHeight, look: 0, pitch: 0, across: 0, ahead: 0 };
const seconds = evenly(0.6, 1.6);

/** Walks, turns on the spot, crouches, jumps, seats, lunges, and gestures. */
export const acts: fc.Arbitrary<Act[]> = fc.array(
  fc.oneof(
    fc.record({ seconds, x: evenly(-0.8, 0.8), z: evenly(-0.8, 0.8), yaw: evenly(-3, 3), eyes: fc.constant(1.58) }),
    fc.record({ seconds, yaw: evenly(-3, 3) }),
    fc.record({ seconds, eyes: evenly(0.6, 1.3), pitch: evenly(-0.7, 0.2) }),
    fc.record({ seconds: evenly(0.4, 0.6), jumps: fc.constant(true) }),
    fc.record({ seconds, eyes: evenly(1.05, 1.2), z: evenly(-0.1, 0.1) }),
    fc.record({ seconds, x: evenly(-0.4, 0.4), z: evenly(-0.6, 0.6), eyes: evenly(1.1, 1.4) }),
    fc.record({ seconds, look: evenly(-1.4, 1.4), across: evenly(0, 1), ahead: evenly(0, 1) }),
    fc.record({ seconds, eyes: fc.constant(eyeHeight), look: fc.constant(0), pitch: fc.constant(0) }),
  ),
  { minLength: 2, maxLength: 5 },
);

/** Legs that reach the floor from the hips of the calibrated body. */
export const legProportions = { ...proportions, upper: 0.43, lower: 0.43 };

export const calibration: Calibration = { eyeHeight, armSpan: 1.55 };
const { eyesInHead } = averageSkeleton(calibration);
const rateHz = 60;
/** The time [s] that a person rests after each act. */
const rest = 1;

function postureAt(from: Posture, act: Act, time: number): Posture {
  const share = smoothstep(0, act.seconds, time);
  const between = (key: keyof Posture): number => from[key] + ((act[key] ?? from[key]) - from[key]) * share;
  const flight = act.jumps ? 0.3 * Math.sin(Math.PI * clamp(time / act.seconds, 0, 1)) : 0;
  return {
    ...{ x: between('x'), z: between('z'), yaw: between('yaw'), eyes: between('eyes') + flight },
    ...{ look: between('look'), pitch: between('pitch'), across: between('across'), ahead: between('ahead') },
  };
}

function frameOf({ x, z, yaw, eyes, look, pitch, across, ahead }: Posture, time: number) {
  const turn = fromAxisAngle(up, yaw);
  const place = (point: Vec3): Vec3 => add(vec3(x, 0, z), rotate(turn, point));
  const hanging = Math.max(eyes - 0.8, 0.05);
  const hand = (from: Vec3, to: Vec3, share: number, grip: Quat) =>
    tracked(place(lerp(from, to, share)), multiply(turn, grip));
  const down = fromAxisAngle(right, -1.3);
  // A head that nods carries the eyes about its joint.
  const level = multiply(turn, fromAxisAngle(up, look));
  const gaze = multiply(level, fromAxisAngle(right, pitch));
  const nod = subtract(rotate(gaze, eyesInHead), rotate(level, eyesInHead));
  return {
    time,
    head: tracked(add(vec3(x, eyes, z), nod), gaze),
    leftHand: hand(vec3(-0.24, hanging, 0.05), vec3(-0.2, eyes - 0.2, -0.5), ahead, down),
    rightHand: hand(vec3(0.24, hanging, 0.05), vec3(-0.15, eyes - 0.22, -0.12), across, down),
  };
}

/** The legs that are drawn in a frame of an acting person, and the body that they hang from. */
export interface ActedFrame {
  readonly legs: LegPosture['legs'];
  readonly hips: Vec3;
  readonly hipsYaw: number;
  readonly posture: Posture;
  /** Whether a second of rest ends with this frame. */
  readonly rested: boolean;
  /** The act that it belongs to, for the message of a failing test. */
  readonly act: string;
}

/**
 * Returns copies of the legs that are drawn under the body which an estimator draws of these acts, one after the other.
 */
export function actedFrames(script: readonly Act[], estimator: PoseEstimator = createIk(calibration)): ActedFrame[] {
  const skeleton = averageSkeleton(calibration);
  const drawn = createLegs(legProportions);
  const acted: ActedFrame[] = [];
  let from = upright;
  let start = 0;
  for (const act of [{ seconds: 1 }, ...script]) {
    const end = start + act.seconds + rest;
    for (let time = acted.length / rateHz; time < end; time = acted.length / rateHz) {
      const posture = postureAt(from, act, time - start);
      const frame = frameOf(posture, time);
      const { hips, leftHand, rightHand } = forwardKinematics(skeleton, estimator.update(frame).pose.body!);
      const points = { hips, head: frame.head, leftHand: leftHand.position, rightHand: rightHand.position };
      drawn.update(points, acted.length === 0 ? 0 : 1 / rateHz);
      const { legs } = structuredClone({ legs: drawn.legs });
      const rested = time + 1 / rateHz >= end;
      const hipsYaw = yawOfHips(hips.orientation);
      acted.push({ legs, hips: { ...hips.position }, hipsYaw, posture, rested, act: JSON.stringify(act) });
    }
    from = postureAt(from, act, act.seconds);
    start = end;
  }
  return acted;
}
