import { FingerMemory } from '../core/body/finger-memory';
import { type HandJoints, handShapeFromJoints, makeHandJoints, setHandJoint } from '../core/body/hand-joints';
import { type FingerName, type HandShape, type MutableHandShape, makeHandShape } from '../core/body/hand-shape';
import { type MutablePose, makePose, type TrackedPose } from '../core/math/pose';
import { fromAxes } from '../core/math/quat';
import type { Side } from '../core/math/side';
import { copyVec3, isFiniteVec3, setVec3, type Vec3, vec3 } from '../core/math/vec3';
import { toTrackedPose } from './tracked-pose';

/** WebXR's hand input, which the types describe in part and some browsers lack. */
interface FillingFrame {
  /** Writes a column-major 4×4 matrix for each space; returns false, and writes NaN, where one of them is not seen. */
  readonly fillPoses?: (spaces: readonly XRSpace[], base: XRSpace, matrices: Float32Array) => boolean;
}

/** A joint of WebXR's hand that the fingers follow. */
interface FollowedJoint {
  readonly name: XRHandJoint;
  readonly finger: FingerName;
  readonly joint: 0 | 1 | 2 | 3;
}

const jointsOf = (finger: FingerName, names: readonly XRHandJoint[]): readonly FollowedJoint[] =>
  names.map((name, joint) => ({ name, finger, joint: joint as FollowedJoint['joint'] }));

const longFinger = (finger: FingerName, prefix: 'index' | 'middle' | 'ring' | 'pinky'): readonly FollowedJoint[] =>
  jointsOf(finger, [
    `${prefix}-finger-phalanx-proximal`,
    `${prefix}-finger-phalanx-intermediate`,
    `${prefix}-finger-phalanx-distal`,
    `${prefix}-finger-tip`,
  ]);

/**
 * The joints in the order of the buffers, after the wrist. The palm is rigid: the metacarpals of the long fingers are
 * left out.
 */
const followed: readonly FollowedJoint[] = [
  ...jointsOf('thumb', ['thumb-metacarpal', 'thumb-phalanx-proximal', 'thumb-phalanx-distal', 'thumb-tip']),
  ...longFinger('index', 'index'),
  ...longFinger('middle', 'middle'),
  ...longFinger('ring', 'ring'),
  ...longFinger('little', 'pinky'),
];

/** The tip of the index finger among the joints. */
const indexTip = followed.findIndex(({ name }) => name === 'index-finger-tip');

/** Reads wrist and fingers of one tracked hand by one call of `fillPoses` a frame, into buffers of the reader. */
export class HandReader {
  /**
   * The fingers of the last `read` that found a wrist; overwritten by the next. Fingers that were not seen keep their
   * bend.
   */
  readonly shape: HandShape;
  readonly #side: Side;
  readonly #memory = new FingerMemory();
  readonly #joints: HandJoints = makeHandJoints();
  readonly #seen: MutableHandShape = makeHandShape();
  readonly #matrices = new Float32Array(16 * (1 + followed.length));
  readonly #wrist: MutablePose<'floor'> = makePose<'floor'>();
  readonly #at = vec3(0, 0, 0);
  readonly #indexTip = vec3(Number.NaN, 0, 0);
  #hand: XRHand | null = null;
  /** The joints of `#hand` in the order of `#matrices`; fewer where the device lacks joints. */
  #spaces: XRJointSpace[] = [];
  #lastTime: number | null = null;

  constructor(side: Side) {
    this.#side = side;
    this.shape = this.#memory.shape;
  }

  /** The pinch of this frame, before anything is held; NaN: thumb or index finger is not seen. */
  get pinch(): number {
    return this.#seen.pinch;
  }

  /** The tip of the index finger in this frame, floor frame; null: not seen. */
  get indexTip(): Vec3 | null {
    return isFiniteVec3(this.#indexTip) ? this.#indexTip : null;
  }

  /** Returns the wrist, floor frame; null: the hand is not seen. `time`: [s], on the clock of the frames. */
  read(frame: XRFrame, hand: XRHand, space: XRReferenceSpace, time: number): TrackedPose | null {
    if (hand !== this.#hand) this.#follow(hand);
    const filled = this.#fill(frame, space);
    const wrist = filled ? this.#filledWrist() : this.#readOneByOne(frame, hand, space);
    if (!wrist) {
      this.#seen.pinch = Number.NaN;
      this.#indexTip.x = Number.NaN;
      return null;
    }
    const deltaSeconds = this.#lastTime === null ? 0 : Math.max(0, time - this.#lastTime);
    this.#lastTime = time;
    this.#memory.follow(handShapeFromJoints(this.#joints, this.#seen), deltaSeconds);
    return wrist;
  }

  #follow(hand: XRHand): void {
    this.#hand = hand;
    this.#spaces = [];
    for (const name of ['wrist' as XRHandJoint, ...followed.map((joint) => joint.name)]) {
      const space = hand.get(name);
      if (space) this.#spaces.push(space);
    }
  }

  /** Reads all joints at once; returns false where the device cannot, or does not see all of them. */
  #fill(frame: XRFrame, space: XRReferenceSpace): boolean {
    const { fillPoses } = frame as FillingFrame;
    if (!fillPoses || this.#spaces.length !== 1 + followed.length) return false;
    return fillPoses.call(frame, this.#spaces, space, this.#matrices);
  }

  #filledWrist(): TrackedPose | null {
    const m = this.#matrices;
    setVec3(axisX, m[0]!, m[1]!, m[2]!);
    setVec3(axisY, m[4]!, m[5]!, m[6]!);
    setVec3(axisZ, m[8]!, m[9]!, m[10]!);
    const { position, orientation } = this.#wrist;
    setVec3(position, m[12]!, m[13]!, m[14]!);
    fromAxes(axisX, axisY, axisZ, orientation);
    if (!isFiniteVec3(position) || !Number.isFinite(orientation.x + orientation.y + orientation.z + orientation.w)) {
      return null;
    }
    for (let i = 0; i < followed.length; i++) {
      const at = 16 * (1 + i) + 12;
      setVec3(this.#at, m[at]!, m[at + 1]!, m[at + 2]!);
      if (i === indexTip) copyVec3(this.#at, this.#indexTip);
      setHandJoint(this.#joints, followed[i]!, this.#wrist, this.#side, this.#at);
    }
    return { position: { ...position }, orientation: { ...orientation }, tracking: 'tracked' };
  }

  /** Reads joint by joint: the device has no `fillPoses`, or sees some joints only. */
  #readOneByOne(frame: XRFrame, hand: XRHand, space: XRReferenceSpace): TrackedPose | null {
    const wristJoint = hand.get('wrist' as XRHandJoint);
    const found = wristJoint && frame.getJointPose?.(wristJoint, space);
    const wrist = found ? toTrackedPose(found) : null;
    if (!wrist) return null;
    for (let i = 0; i < followed.length; i++) {
      const joint = hand.get(followed[i]!.name);
      const at = joint && frame.getJointPose?.(joint, space)?.transform.position;
      if (at) setVec3(this.#at, at.x, at.y, at.z);
      else setVec3(this.#at, Number.NaN, Number.NaN, Number.NaN);
      if (i === indexTip) copyVec3(this.#at, this.#indexTip);
      setHandJoint(this.#joints, followed[i]!, wrist, this.#side, this.#at);
    }
    return wrist;
  }
}

const axisX = vec3(0, 0, 0);
const axisY = vec3(0, 0, 0);
const axisZ = vec3(0, 0, 0);
