import type { AvatarPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import { closePinch } from '../body/close-pinch';
import { FingerMemory } from '../body/finger-memory';
import { averageHand, fingerFrames, makeFingerFrames, mirrorRotation } from '../body/hand-geometry';
import { copyHandShape, fingerNames, type HandShape, makeHandShape } from '../body/hand-shape';
import { jointNames } from '../body/joints';
import { wristFromHandBone } from '../body/skeleton';
import type { PoseEstimator } from '../estimation/pose-estimator';
import { conjugate, copyQuat, type MutableQuat, multiply, type Quat, quat } from '../math/quat';
import type { Side } from '../math/side';
import { vec3 } from '../math/vec3';
import type { Recording } from '../tracking/recording';
import type { TrackingFrame } from '../tracking/tracking-frame';
import type { Motion } from './motion';
import { motionSkeleton, restBend, turnPoint, turnRotation } from './skeleton';

const sides = ['left', 'right'] as const;

/** The inverse of each finger bone's frame at rest. */
const fromRest = Object.fromEntries(
  fingerNames.map((finger) => {
    const [first, second, third] = fingerFrames(finger, restBend(finger), makeFingerFrames());
    return [finger, [conjugate(first), conjugate(second), conjugate(third)] as const];
  }),
) as Readonly<Record<(typeof fingerNames)[number], readonly [Quat, Quat, Quat]>>;

const frames = makeFingerFrames();
const turned = makeFingerFrames();
const against = quat(0, 0, 0, 1);
const inverse = quat(0, 0, 0, 1);
const wrist = quat(0, 0, 0, 1);

/** How a bone of a bent finger has turned against the one before it since T-pose, in T-pose's axes of the floor frame. */
function fingerRotation(side: Side, index: 0 | 1 | 2, target: MutableQuat): MutableQuat {
  if (index === 0) copyQuat(turned[0], against);
  else multiply(conjugate(turned[(index - 1) as 0 | 1], inverse), turned[index], against);
  if (side === 'right') mirrorRotation(against);
  const toWrist = wristFromHandBone[side];
  return multiply(multiply(conjugate(toWrist, wrist), against, against), toWrist, target);
}

/** Gathers a body's poses, frame by frame, into a motion with fingers. */
export class MotionTaker {
  readonly #hand;
  readonly #memories = { left: new FingerMemory(), right: new FingerMemory() };
  readonly #shape = makeHandShape();
  readonly #rotation = quat(0, 0, 0, 1);
  readonly #motion: Motion;
  #firstTime = 0;
  #count = 0;
  /** Where the next rotation goes. */
  #at = 0;

  /** For so many frames of a person of these measures. */
  constructor(calibration: Calibration, count: number, rateHz: number) {
    const bones = motionSkeleton(calibration);
    const measured = bones.filter((bone) => bone.measured).length;
    this.#hand = averageHand(calibration.eyeHeight);
    this.#motion = {
      bones,
      measured,
      rateHz,
      times: new Float64Array(count),
      hips: new Float64Array(3 * count),
      rotations: new Float32Array(4 * measured * count),
      seen: new Uint8Array(count),
    };
  }

  /** The next frame. Throws a sentence where the pose has no body: of head and hands alone no motion is made. */
  add({ time, leftHand, rightHand, fingers }: TrackingFrame, { body }: AvatarPose): void {
    if (!body)
      throw new Error('This method draws no body: there are head and hands alone, and no motion to be written.');
    const { times, hips, seen } = this.#motion;
    const index = this.#count;
    if (index === 0) this.#firstTime = time;
    times[index] = time - this.#firstTime;
    const at = turnPoint(body.hipsPosition, hipsOfBody);
    hips.set([at.x, at.y, at.z], 3 * index);
    seen[index] = (leftHand ? 1 : 0) + (rightHand ? 2 : 0);
    const deltaSeconds = index === 0 ? 0 : times[index] - times[index - 1]!;
    this.#at = 4 * index * this.#motion.measured;
    for (const joint of jointNames) {
      this.#write(body.localRotations[joint]);
      for (const side of sides) if (joint === `${side}Hand`) this.#bend(side, fingers?.[side] ?? null, deltaSeconds);
    }
    this.#count += 1;
  }

  /** What was gathered. */
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

  #bend(side: Side, seen: HandShape | null, deltaSeconds: number): void {
    const shape = copyHandShape(this.#memories[side].follow(seen, deltaSeconds), this.#shape);
    closePinch(shape, this.#hand);
    for (const finger of fingerNames) {
      fingerFrames(finger, shape[finger], frames);
      for (let i = 0; i < 3; i++) multiply(frames[i as 0], fromRest[finger][i as 0], turned[i as 0]);
      for (let i = 0; i < 3; i++) this.#write(fingerRotation(side, i as 0, this.#rotation));
    }
  }

  /** A rotation of the floor frame's axes, in the order of the bones. */
  #write(rotation: Quat): void {
    const { x, y, z, w } = turnRotation(rotation, this.#rotation);
    const { rotations } = this.#motion;
    rotations[this.#at++] = x;
    rotations[this.#at++] = y;
    rotations[this.#at++] = z;
    rotations[this.#at++] = w;
  }
}

const hipsOfBody = vec3(0, 0, 0);

/** Frames between two looks at who waits. */
const framesPerStep = 16;

/**
 * The body that an estimator draws of a recording, frame by frame as it would have live; a network that answers later is waited for. Yields the
 * share [0, 1] that is done, now and then. Throws a sentence where the estimator fails or draws no body.
 */
export async function* estimateMotion(
  { frames, rateHz }: Recording,
  calibration: Calibration,
  estimator: PoseEstimator,
): AsyncGenerator<number, Motion> {
  const taker = new MotionTaker(calibration, frames.length, rateHz);
  estimator.reset();
  for (const [index, frame] of frames.entries()) {
    const { pose, request } = estimator.update(frame);
    await request?.ask();
    const fault = estimator.fault();
    if (fault !== null) throw new Error(`The method “${estimator.name}” failed in frame ${index + 1}: ${fault}`);
    taker.add(frame, pose);
    if (index % framesPerStep === 0) yield index / frames.length;
  }
  return taker.finish();
}
