import type { UpperBodyPose } from '../core/body/avatar-pose';
import {
  copyHandShape,
  type HandShape,
  type MutableHandShape,
  makeHandShape,
  mixHandShape,
} from '../core/body/hand-shape';
import { type JointName, jointNames } from '../core/body/joints';
import { type MutablePose, makePose, type TrackedPose } from '../core/math/pose';
import { copyQuat, type MutableQuat, quat, slerp } from '../core/math/quat';
import type { Side } from '../core/math/side';
import { copyVec3, lerp, type MutableVec3, vec3 } from '../core/math/vec3';
import type { PosePacket } from '../core/protocol/pose-packet';

/** What is drawn of a player in one frame. */
export type Shown = Omit<PosePacket, 'timeMs' | 'jump'>;

interface MutableTrackedPose extends MutablePose<'floor'> {
  tracking: TrackedPose['tracking'];
}

interface MutableBody {
  readonly hipsPosition: MutableVec3;
  readonly localRotations: Readonly<Record<JointName, MutableQuat>>;
}

const makeTracked = (): MutableTrackedPose => ({ ...makePose<'floor'>(), tracking: 'tracked' });

const makeBody = (): MutableBody => ({
  hipsPosition: vec3(0, 0, 0),
  localRotations: Object.fromEntries(jointNames.map((name) => [name, quat(0, 0, 0, 1)])) as Record<
    JointName,
    MutableQuat
  >,
});

/** A buffer for what is drawn of a player, from one packet or between two; parts of it may be one of the sources. */
export class ShownPlayer implements Shown {
  readonly pose: {
    readonly head: MutableTrackedPose;
    leftHand: MutableTrackedPose | null;
    rightHand: MutableTrackedPose | null;
    body: MutableBody | null;
  };
  readonly fingers: Record<Side, HandShape | null> = { left: null, right: null };
  private readonly hands: Readonly<Record<Side, MutableTrackedPose>> = { left: makeTracked(), right: makeTracked() };
  private readonly body = makeBody();
  private readonly shapes = { left: makeHandShape(), right: makeHandShape() };

  constructor() {
    this.pose = { head: makeTracked(), leftHand: null, rightHand: null, body: null };
  }

  /** As it is there. */
  copy({ pose, fingers }: Shown): this {
    copyTracked(pose.head, this.pose.head);
    this.pose.leftHand = pose.leftHand && copyTracked(pose.leftHand, this.hands.left);
    this.pose.rightHand = pose.rightHand && copyTracked(pose.rightHand, this.hands.right);
    this.pose.body = pose.body && copyBody(pose.body, this.body);
    this.fingers.left = fingers.left && copyHandShape(fingers.left, this.shapes.left);
    this.fingers.right = fingers.right && copyHandShape(fingers.right, this.shapes.right);
    return this;
  }

  /** From a (t = 0) to b (t = 1), and on beyond b. */
  mix(a: Shown, b: Shown, t: number): this {
    mixTracked(a.pose.head, b.pose.head, t, this.pose.head);
    this.pose.leftHand = mixHand(a.pose.leftHand, b.pose.leftHand, t, this.hands.left);
    this.pose.rightHand = mixHand(a.pose.rightHand, b.pose.rightHand, t, this.hands.right);
    this.pose.body = mixBody(a.pose.body, b.pose.body, t, this.body);
    this.fingers.left = mixFingers(a.fingers.left, b.fingers.left, t, this.shapes.left);
    this.fingers.right = mixFingers(a.fingers.right, b.fingers.right, t, this.shapes.right);
    return this;
  }
}

function copyTracked(from: TrackedPose, target: MutableTrackedPose): MutableTrackedPose {
  copyVec3(from.position, target.position);
  copyQuat(from.orientation, target.orientation);
  target.tracking = from.tracking;
  return target;
}

function mixTracked(a: TrackedPose, b: TrackedPose, t: number, target: MutableTrackedPose): MutableTrackedPose {
  lerp(a.position, b.position, t, target.position);
  slerp(a.orientation, b.orientation, t, target.orientation);
  target.tracking = t < 1 ? a.tracking : b.tracking;
  return target;
}

function mixHand(
  a: TrackedPose | null,
  b: TrackedPose | null,
  t: number,
  target: MutableTrackedPose,
): MutableTrackedPose | null {
  if (a && b) return mixTracked(a, b, t, target);
  // A lost hand is nowhere, so there is no way from it or to it: it stays what it was until the packet that says otherwise.
  const held = t < 1 ? a : b;
  return held && copyTracked(held, target);
}

function copyBody(from: UpperBodyPose, target: MutableBody): MutableBody {
  copyVec3(from.hipsPosition, target.hipsPosition);
  for (let i = 0; i < jointNames.length; i++) {
    const name = jointNames[i]!;
    copyQuat(from.localRotations[name], target.localRotations[name]);
  }
  return target;
}

function mixBody(a: UpperBodyPose | null, b: UpperBodyPose | null, t: number, target: MutableBody): MutableBody | null {
  if (!a || !b) {
    const held = t < 1 ? a : b;
    return held && copyBody(held, target);
  }
  lerp(a.hipsPosition, b.hipsPosition, t, target.hipsPosition);
  for (let i = 0; i < jointNames.length; i++) {
    const name = jointNames[i]!;
    slerp(a.localRotations[name], b.localRotations[name], t, target.localRotations[name]);
  }
  return target;
}

function mixFingers(
  a: HandShape | null,
  b: HandShape | null,
  t: number,
  target: MutableHandShape,
): MutableHandShape | null {
  if (a && b) return mixHandShape(a, b, Math.min(t, 1), target);
  const held = t < 1 ? a : b;
  return held && copyHandShape(held, target);
}
