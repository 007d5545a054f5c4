import {
  type AvatarPose,
  type Fingers,
  type HandShape,
  jointNames,
  lerpHandShape,
  type MutableHandShape,
  type MutableUpperBodyPose,
  makeHandShape,
  makeUpperBodyPose,
  type TrackedFeet,
  type UpperBodyPose,
} from 'threepoint/core';
import {
  addScaled,
  copyPose,
  lerp,
  type MutablePose,
  type MutableTrackedPose,
  type MutableVec3,
  makePose,
  makeTrackedPose,
  normaliseQuat,
  type Pose,
  type Quat,
  quat,
  type Side,
  setQuat,
  setVec3,
  slerp,
  type TrackedPose,
  vec3,
} from 'threepoint/math';
import type { FloorPlacement, PosePacket } from '../protocol/pose-packet';
import type { PathFit, PathSample } from './path-fit';

/** The pose of a player in one frame. */
type BufferedPose = Omit<PosePacket, 'timeMs' | 'jump'>;

/** A buffer for the drawn pose of a player; methods may use the buffer itself as a source. */
export class PoseBuffer implements BufferedPose {
  readonly pose: {
    readonly head: MutableTrackedPose;
    leftHand: MutableTrackedPose | null;
    rightHand: MutableTrackedPose | null;
    body: MutableUpperBodyPose | null;
    feet: TrackedFeet | undefined;
    readonly fingers: Fingers;
  };
  readonly fingers: Record<Side, HandShape | null> = { left: null, right: null };
  placement: FloorPlacement | null = null;
  private readonly hands: Readonly<Record<Side, MutableTrackedPose>> = {
    left: makeTrackedPose(),
    right: makeTrackedPose(),
  };
  private readonly body = makeUpperBodyPose();
  private readonly ankles: Readonly<Record<Side, MutablePose<'floor'>>> = { left: makePose(), right: makePose() };
  private readonly feet: Record<Side, Pose<'floor'> | null> = { left: null, right: null };
  private readonly placed = { position: vec3(0, 0, 0), heading: 0 };
  private readonly shapes = { left: makeHandShape(), right: makeHandShape() };

  constructor() {
    const { fingers } = this;
    this.pose = { head: makeTrackedPose(), leftHand: null, rightHand: null, body: null, feet: undefined, fingers };
  }

  copy(pose: BufferedPose): this {
    return this.interpolate(pose, pose, 1);
  }

  /**
   * Writes the pose at a fitted time. A part that is missing in a sample is interpolated from a (t = 0) to b (t = 1),
   * the neighbouring packets.
   */
  writeFitted(samples: readonly PathSample[], fit: PathFit, a: BufferedPose, b: BufferedPose, t: number): this {
    const { pose, hands, fingers, shapes } = this;
    const next = (t < 1 ? a : b).pose;
    fitPose(samples, fit, 'head', pose.head);
    pose.head.tracking = next.head.tracking;
    if (allHave(samples, fit, 'leftHand')) pose.leftHand = fitPose(samples, fit, 'leftHand', hands.left);
    else pose.leftHand = mixHand(a.pose.leftHand, b.pose.leftHand, t, hands.left);
    if (allHave(samples, fit, 'rightHand')) pose.rightHand = fitPose(samples, fit, 'rightHand', hands.right);
    else pose.rightHand = mixHand(a.pose.rightHand, b.pose.rightHand, t, hands.right);
    hands.left.tracking = next.leftHand?.tracking ?? 'tracked';
    hands.right.tracking = next.rightHand?.tracking ?? 'tracked';
    if (allHave(samples, fit, 'body')) pose.body = fitBody(samples, fit, this.body);
    else pose.body = mixBody(a.pose.body, b.pose.body, t, this.body);
    this.showFeet(
      fitFoot(samples, fit, 'leftFoot', this.ankles.left) ?? mixFoot(a.pose, b.pose, 'leftFoot', t, this.ankles.left),
      fitFoot(samples, fit, 'rightFoot', this.ankles.right) ??
        mixFoot(a.pose, b.pose, 'rightFoot', t, this.ankles.right),
    );
    fingers.left = mixFingers(a.fingers.left, b.fingers.left, t, shapes.left);
    fingers.right = mixFingers(a.fingers.right, b.fingers.right, t, shapes.right);
    this.placement = mixPlacement(a.placement, b.placement, Math.min(t, 1), this.placed);
    return this;
  }

  /** Interpolates from a (t = 0) to b (t = 1), or extrapolates beyond b. */
  interpolate(a: BufferedPose, b: BufferedPose, t: number): this {
    mixTracked(a.pose.head, b.pose.head, t, this.pose.head);
    this.pose.leftHand = mixHand(a.pose.leftHand, b.pose.leftHand, t, this.hands.left);
    this.pose.rightHand = mixHand(a.pose.rightHand, b.pose.rightHand, t, this.hands.right);
    this.pose.body = mixBody(a.pose.body, b.pose.body, t, this.body);
    const { left, right } = this.ankles;
    this.showFeet(mixFoot(a.pose, b.pose, 'leftFoot', t, left), mixFoot(a.pose, b.pose, 'rightFoot', t, right));
    this.fingers.left = mixFingers(a.fingers.left, b.fingers.left, t, this.shapes.left);
    this.fingers.right = mixFingers(a.fingers.right, b.fingers.right, t, this.shapes.right);
    this.placement = mixPlacement(a.placement, b.placement, Math.min(t, 1), this.placed);
    return this;
  }

  private showFeet(left: Pose<'floor'> | null, right: Pose<'floor'> | null): void {
    this.feet.left = left;
    this.feet.right = right;
    this.pose.feet = left || right ? this.feet : undefined;
  }
}

type FootPart = 'leftFoot' | 'rightFoot';
type PosePart = 'head' | 'leftHand' | 'rightHand' | FootPart;

function partOf(pose: AvatarPose, part: PosePart): Pose<'floor'> | null {
  if (part === 'leftFoot') return pose.feet?.left ?? null;
  if (part === 'rightFoot') return pose.feet?.right ?? null;
  return pose[part];
}

function mixTracked(a: TrackedPose, b: TrackedPose, t: number, target: MutableTrackedPose): MutableTrackedPose {
  lerp(a.position, b.position, t, target.position);
  slerp(a.orientation, b.orientation, t, target.orientation);
  target.tracking = t < 1 ? a.tracking : b.tracking;
  return target;
}

function allHave(samples: readonly PathSample[], { first, count }: PathFit, part: PosePart | 'body'): boolean {
  for (let i = first; i < first + count; i++) {
    const { pose } = samples[i]!.packet;
    if (!(part === 'body' ? pose.body : partOf(pose, part))) return false;
  }
  return true;
}

// The sum of one call of fitPose or fitBody.
const sum = quat(0, 0, 0, 0);

/** Adds `weight` times q, or −q if that is nearer to `near`, to `sum`. */
function addWeighted(q: Quat, weight: number, near: Quat): void {
  const k = q.x * near.x + q.y * near.y + q.z * near.z + q.w * near.w < 0 ? -weight : weight;
  sum.x += k * q.x;
  sum.y += k * q.y;
  sum.z += k * q.z;
  sum.w += k * q.w;
}

function fitPose<Target extends MutablePose<'floor'>>(
  samples: readonly PathSample[],
  { first, count, weights }: PathFit,
  part: PosePart,
  target: Target,
): Target {
  const { position, orientation } = target;
  const near = partOf(samples[first + count - 1]!.packet.pose, part)!.orientation;
  setVec3(position, 0, 0, 0);
  setQuat(sum, 0, 0, 0, 0);
  for (let i = 0; i < count; i++) {
    const pose = partOf(samples[first + i]!.packet.pose, part)!;
    addScaled(position, pose.position, weights[i]!, position);
    addWeighted(pose.orientation, weights[i]!, near);
  }
  normaliseQuat(sum, orientation);
  return target;
}

/** Writes an ankle on its fitted path; null: a sample has none. */
const fitFoot = (
  samples: readonly PathSample[],
  fit: PathFit,
  foot: FootPart,
  target: MutablePose<'floor'>,
): Pose<'floor'> | null => (allHave(samples, fit, foot) ? fitPose(samples, fit, foot, target) : null);

function mixFoot(
  a: AvatarPose,
  b: AvatarPose,
  foot: FootPart,
  t: number,
  target: MutablePose<'floor'>,
): Pose<'floor'> | null {
  const from = partOf(a, foot);
  const to = partOf(b, foot);
  if (from && to) {
    lerp(from.position, to.position, t, target.position);
    slerp(from.orientation, to.orientation, t, target.orientation);
    return target;
  }
  // An ankle is held like a hand.
  const held = t < 1 ? from : to;
  return held && copyPose(held, target);
}

function fitBody(
  samples: readonly PathSample[],
  { first, count, weights }: PathFit,
  target: MutableUpperBodyPose,
): MutableUpperBodyPose {
  const { hipsPosition } = target;
  setVec3(hipsPosition, 0, 0, 0);
  for (let i = 0; i < count; i++) {
    addScaled(hipsPosition, samples[first + i]!.packet.pose.body!.hipsPosition, weights[i]!, hipsPosition);
  }
  for (let j = 0; j < jointNames.length; j++) {
    const name = jointNames[j]!;
    const near = samples[first + count - 1]!.packet.pose.body!.localRotations[name];
    setQuat(sum, 0, 0, 0, 0);
    for (let i = 0; i < count; i++) {
      addWeighted(samples[first + i]!.packet.pose.body!.localRotations[name], weights[i]!, near);
    }
    normaliseQuat(sum, target.localRotations[name]);
  }
  return target;
}

function mixHand(
  a: TrackedPose | null,
  b: TrackedPose | null,
  t: number,
  target: MutableTrackedPose,
): MutableTrackedPose | null {
  if (a && b) return mixTracked(a, b, t, target);
  // Nothing is interpolated from or to a lost hand: the earlier packet applies until the later one.
  const held = t < 1 ? a : b;
  return held && mixTracked(held, held, 1, target);
}

function mixBody(
  a: UpperBodyPose | null,
  b: UpperBodyPose | null,
  t: number,
  target: MutableUpperBodyPose,
): MutableUpperBodyPose | null {
  if (!a || !b) {
    const held = t < 1 ? a : b;
    return held && mixBody(held, held, 1, target);
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
  if (a && b) return lerpHandShape(a, b, Math.min(t, 1), target);
  const held = t < 1 ? a : b;
  return held && lerpHandShape(held, held, 1, target);
}

interface MutablePlacement {
  readonly position: MutableVec3;
  heading: number;
}

/** Interpolates between two placements, with the heading the shorter way round. */
function mixPlacement(
  a: FloorPlacement | null | undefined,
  b: FloorPlacement | null | undefined,
  t: number,
  target: MutablePlacement,
): FloorPlacement | null {
  if (!a || !b) {
    const held = (t < 1 ? a : b) ?? null;
    return held && mixPlacement(held, held, 1, target);
  }
  const turn = b.heading - a.heading;
  target.heading = a.heading + t * Math.atan2(Math.sin(turn), Math.cos(turn));
  lerp(a.position, b.position, t, target.position);
  return target;
}
