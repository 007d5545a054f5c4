import type { AvatarPose, UpperBodyPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import { closePinch } from '../body/close-pinch';
import { FingerMemory } from '../body/finger-memory';
import { averageHand, fingerFrames, makeFingerFrames, mirrorRotation } from '../body/hand-geometry';
import {
  copyHandShape,
  type Fingers,
  fingerNames,
  type HandShape,
  makeHandShape,
  unknownFingers,
} from '../body/hand-shape';
import { jointNames } from '../body/joints';
import { wristFromHandBone } from '../body/skeleton';
import { estimateRecording } from '../estimation/estimate-recording';
import type { PoseEstimator } from '../estimation/pose-estimator';
import { isTracked } from '../math/pose';
import { conjugate, copyQuat, type MutableQuat, multiply, type Quat, quat, writeQuat } from '../math/quat';
import { type Side, sides } from '../math/side';
import { vec3, writeVec3 } from '../math/vec3';
import { recordOf } from '../records';
import type { Replayable } from '../tracking/recording';
import type { TrackingFrame } from '../tracking/tracking-frame';
import { createMotion, type Motion } from './motion';
import { motionSkeleton, restBend, turnPoint, turnRotation } from './motion-bones';

/** The inverse of each finger bone's frame at rest. */
const fromRest = recordOf(fingerNames, (finger) => {
  const [first, second, third] = fingerFrames(finger, restBend(finger), makeFingerFrames());
  return [conjugate(first), conjugate(second), conjugate(third)] as const;
});

const frames = makeFingerFrames();
const turned = makeFingerFrames();
const against = quat(0, 0, 0, 1);
const inverse = quat(0, 0, 0, 1);
const wrist = quat(0, 0, 0, 1);

/**
 * Writes the rotation from T-pose of a bent finger's bone relative to the one before it, in T-pose's axes of the floor
 * frame.
 */
function fingerRotation(side: Side, index: 0 | 1 | 2, target: MutableQuat): MutableQuat {
  if (index === 0) copyQuat(turned[0], against);
  else multiply(conjugate(turned[(index - 1) as 0 | 1], inverse), turned[index], against);
  if (side === 'right') mirrorRotation(against);
  const toWrist = wristFromHandBone[side];
  return multiply(multiply(conjugate(toWrist, wrist), against, against), toWrist, target);
}

/**
 * Computes the rotations of a person's measured bones, frame after frame. Fingers that are not seen keep their bend for
 * a while, as on an avatar.
 */
export class BoneRotations {
  readonly #hand;
  readonly #memories = { left: new FingerMemory(), right: new FingerMemory() };
  readonly #shape = makeHandShape();
  readonly #rotation = quat(0, 0, 0, 1);
  #target = new Float32Array();
  /** The index at which the next rotation is written. */
  #at = 0;

  constructor(calibration: Calibration) {
    this.#hand = averageHand(calibration.eyeHeight);
  }

  /**
   * Writes x, y, z, w of each bone, clip frame, in the order of `motionSkeleton`, from `at` on; so long after the frame
   * before [s].
   */
  write(
    { localRotations }: UpperBodyPose,
    fingers: Fingers,
    deltaSeconds: number,
    target: Float32Array<ArrayBuffer>,
    at: number,
  ): void {
    this.#target = target;
    this.#at = at;
    for (const joint of jointNames) {
      this.#put(localRotations[joint]);
      for (const side of sides) if (joint === `${side}Hand`) this.#bend(side, fingers[side], deltaSeconds);
    }
  }

  #bend(side: Side, seen: HandShape | null, deltaSeconds: number): void {
    const shape = copyHandShape(this.#memories[side].follow(seen, deltaSeconds), this.#shape);
    closePinch(shape, this.#hand);
    for (const finger of fingerNames) {
      fingerFrames(finger, shape[finger], frames);
      for (let i = 0; i < 3; i++) multiply(frames[i as 0], fromRest[finger][i as 0], turned[i as 0]);
      for (let i = 0; i < 3; i++) this.#put(fingerRotation(side, i as 0, this.#rotation));
    }
  }

  /** Writes a rotation, given in the floor frame's axes. */
  #put(rotation: Quat): void {
    this.#at = writeQuat(turnRotation(rotation, this.#rotation), this.#target, this.#at);
  }
}

/** Gathers a body's poses, frame by frame, into a motion with fingers. */
export class MotionTaker {
  readonly #rotations: BoneRotations;
  readonly #motion: ReturnType<typeof createMotion>;
  #firstTime = 0;
  #count = 0;

  /** Allocates `count` frames of a person with this calibration. */
  constructor(calibration: Calibration, count: number, rateHz: number) {
    this.#rotations = new BoneRotations(calibration);
    this.#motion = createMotion(motionSkeleton(calibration), count, rateHz);
  }

  /** Adds the next frame. Throws a sentence where the pose has no body: head and hands alone are no motion. */
  add({ time, leftHand, rightHand, fingers = unknownFingers }: TrackingFrame, { body }: AvatarPose): void {
    if (!body)
      throw new Error('This method estimates no body, so there is no motion to export. Choose another method.');
    const { times, hips, seen, rotations, measured } = this.#motion;
    const index = this.#count;
    if (index === 0) this.#firstTime = time;
    times[index] = time - this.#firstTime;
    const at = turnPoint(body.hipsPosition, hipsOfBody);
    writeVec3(at, hips, 3 * index);
    // A hand that the device only guesses has a guessed arm.
    seen[index] = (isTracked(leftHand) ? 1 : 0) + (isTracked(rightHand) ? 2 : 0);
    const deltaSeconds = index === 0 ? 0 : times[index] - times[index - 1]!;
    this.#rotations.write(body, fingers, deltaSeconds, rotations, 4 * index * measured);
    this.#count += 1;
  }

  /** Returns the motion of the frames that were added. */
  finish(): Motion {
    const { measured, times, hips, rotations, seen } = this.#motion;
    const n = this.#count;
    return {
      ...this.#motion,
      times: times.subarray(0, n),
      hips: hips.subarray(0, 3 * n),
      rotations: rotations.subarray(0, 4 * measured * n),
      seen: seen.subarray(0, n),
    };
  }
}

const hipsOfBody = vec3(0, 0, 0);

/**
 * Estimates the motion of a recording frame by frame, awaiting each answer of a network. Yields the fraction [0, 1]
 * that is done. Throws a sentence where the estimator fails or has no body.
 */
export async function* estimateMotion(
  recording: Replayable,
  calibration: Calibration,
  estimator: PoseEstimator,
): AsyncGenerator<number, Motion> {
  const taker = new MotionTaker(calibration, recording.frames.length, recording.rateHz);
  yield* estimateRecording(recording, estimator, (frame, pose) => taker.add(frame, pose));
  return taker.finish();
}
