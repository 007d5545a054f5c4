import type { UpperBodyPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import { fingerBoneNames } from '../body/finger-bone-names';
import { type Fingers, fingerNames, unknownFingers } from '../body/hand-shape';
import { type MutablePose, makePose, type Pose } from '../math/pose';
import { fromAxes, fromAxisAngle, multiply, type Quat, quat, rotate } from '../math/quat';
import { type Side, sides } from '../math/side';
import { add, backward, cross, normalise, right, scale, up, type Vec3, vec3, writeVec3, zero } from '../math/vec3';
import { createSkeletonPose } from './imported-motion';
import { createMotion, poseBones } from './motion';
import { type MotionBone, motionSkeleton, turnPoint } from './motion-bones';
import { BoneRotations } from './take-motion';

/** A joint of WebXR Body Tracking: which bone carries it, where on it [m, T-pose], how its axes lie there in T-pose. */
interface XRJoint {
  readonly name: string;
  readonly bone: number;
  readonly at: Vec3;
  readonly rest: Quat;
}

/** Returns axes with −Z along a bone and +Y as near to `above` as that allows; T-pose, clip frame. */
function axesAlong(along: Vec3, above: Vec3): Quat {
  const z = normalise(scale(along, -1), backward);
  const x = normalise(cross(above, z), right);
  return fromAxes(x, cross(z, x), z);
}

/** In the clip frame a person in T-pose faces +Z: the back is −Z, their left +X. */
const back: Vec3 = { x: 0, y: 0, z: -1 };
const front: Vec3 = { x: 0, y: 0, z: 1 };
const left: Vec3 = { x: -1, y: 0, z: 0 };

class Joints {
  readonly list: XRJoint[] = [];
  readonly #bones: readonly MotionBone[];

  constructor(bones: readonly MotionBone[]) {
    this.#bones = bones;
  }

  index(bone: string): number {
    return this.#bones.findIndex(({ name }) => name === bone);
  }

  /** Returns the way along a bone: to its end, or to the bone `next`. */
  along(bone: string, next: string | null): Vec3 {
    const { end } = this.#bones[this.index(bone)]!;
    return next === null ? (end ?? up) : this.#bones[this.index(next)]!.offset;
  }

  /** Adds a joint at a fraction of the way along a bone. */
  add(name: string, bone: string, next: string | null, above: Vec3, fraction = 0): void {
    const along = this.along(bone, next);
    this.list.push({ name, bone: this.index(bone), at: scale(along, fraction), rest: axesAlong(along, above) });
  }
}

function addTrunk(joints: Joints): void {
  joints.add('hips', 'hips', 'spine', back);
  joints.add('spine-lower', 'spine', 'chest', back);
  joints.add('spine-middle', 'spine', 'chest', back, 0.5);
  joints.add('spine-upper', 'chest', 'upperChest', back);
  joints.add('chest', 'upperChest', 'neck', back);
  joints.add('neck', 'neck', 'head', back);
  joints.add('head', 'head', null, back);
}

function addArm(joints: Joints, side: Side): void {
  joints.add(`${side}-shoulder`, `${side}Shoulder`, `${side}UpperArm`, up);
  joints.add(`${side}-scapula`, `${side}Shoulder`, `${side}UpperArm`, up, 0.5);
  joints.add(`${side}-arm-upper`, `${side}UpperArm`, `${side}LowerArm`, up);
  joints.add(`${side}-arm-lower`, `${side}LowerArm`, `${side}Hand`, up);
  joints.add(`${side}-hand-wrist-twist`, `${side}LowerArm`, `${side}Hand`, up, 0.9);
}

/** The start of the palm's bones, which are not modelled [fraction of the way from the wrist to the knuckle]. */
const palmBegins = 0.3;

function addHand(joints: Joints, side: Side): void {
  const hand = `${side}Hand`;
  const middle = `${side}MiddleProximal`;
  joints.add(`${side}-hand-palm`, hand, middle, up, (palmBegins + 1) / 2);
  // The direction follows the tracked wrist, which differs by degrees from the middle finger's bone.
  const ahead = side === 'left' ? right : left;
  joints.list.push({ name: `${side}-hand-wrist`, bone: joints.index(hand), at: zero, rest: axesAlong(ahead, up) });
  for (const finger of fingerNames) {
    const [first, second, third] = fingerBoneNames(side, finger);
    const called = `${side}-hand-${finger}`;
    // The nail of a thumb looks up and outward.
    const above = finger === 'thumb' ? normalise(vec3(side === 'left' ? -1 : 1, 1, 1)) : up;
    if (finger === 'thumb') {
      joints.add(`${called}-metacarpal`, first, second, above);
      joints.add(`${called}-phalanx-proximal`, second, third, above);
    } else {
      joints.add(`${called}-metacarpal`, hand, first, up, palmBegins);
      joints.add(`${called}-phalanx-proximal`, first, second, up);
      joints.add(`${called}-phalanx-intermediate`, second, third, up);
    }
    joints.add(`${called}-phalanx-distal`, third, null, above);
    joints.add(`${called}-tip`, third, null, above, 1);
  }
}

function addLeg(joints: Joints, side: Side): void {
  joints.add(`${side}-upper-leg`, `${side}UpperLeg`, `${side}LowerLeg`, front);
  joints.add(`${side}-lower-leg`, `${side}LowerLeg`, `${side}Foot`, front);
  joints.add(`${side}-foot-ankle-twist`, `${side}LowerLeg`, `${side}Foot`, front, 0.9);
  joints.add(`${side}-foot-ankle`, `${side}Foot`, null, up);
  joints.add(`${side}-foot-subtalar`, `${side}Foot`, null, up, 0.2);
  joints.add(`${side}-foot-transverse`, `${side}Foot`, null, up, 0.5);
  joints.add(`${side}-foot-ball`, `${side}Foot`, null, up, 0.8);
}

/** Returns the joints in the order of the specification's list. */
function jointsOf(bones: readonly MotionBone[]): readonly XRJoint[] {
  const joints = new Joints(bones);
  addTrunk(joints);
  for (const side of sides) addArm(joints, side);
  for (const side of sides) addHand(joints, side);
  for (const side of sides) addLeg(joints, side);
  return joints.list;
}

/** The pose of each joint of WebXR Body Tracking by its name, in the specification's order, floor frame. */
export type XRBodyJoints = ReadonlyMap<string, Pose<'floor'>>;

/**
 * A person's body as WebXR Body Tracking has it: 83 joints, −Z along the bone. +Y is up in T-pose (the back of hands
 * and feet), out of the back of the trunk and out of the shins. All are emulated: what no estimator guesses (legs, the
 * bones of the palm) rests where it grows.
 *
 * @example
 * const poser = new XRBodyPoser(body.calibration);
 * const joints = poser.pose(pose.body, pose.fingers, secondsSinceLastFrame);
 */
export class XRBodyPoser {
  readonly #joints: readonly XRJoint[];
  readonly #rotations: BoneRotations;
  readonly #motion;
  readonly #posed;
  readonly #poses: ReadonlyMap<string, MutablePose<'floor'>>;

  constructor(calibration: Calibration) {
    const bones = motionSkeleton(calibration);
    this.#joints = jointsOf(bones);
    this.#rotations = new BoneRotations(calibration);
    this.#motion = createMotion(bones, 1, 1);
    this.#posed = createSkeletonPose(bones.length);
    this.#poses = new Map(this.#joints.map(({ name }) => [name, makePose<'floor'>()]));
  }

  /** The names of all joints, in the specification's order. */
  get names(): readonly string[] {
    return this.#joints.map(({ name }) => name);
  }

  /** Returns the joints of a pose; the next call overwrites them. `deltaSeconds`: since the last call. */
  pose(body: UpperBodyPose, fingers: Fingers = unknownFingers, deltaSeconds = 0): XRBodyJoints {
    const { hips, rotations } = this.#motion;
    writeVec3(turnPoint(body.hipsPosition, place), hips, 0);
    this.#rotations.write(body, fingers, deltaSeconds, rotations, 0);
    const posed = poseBones(this.#motion, 0, this.#posed);
    for (const { name, bone, at, rest } of this.#joints) {
      const { position, orientation } = this.#poses.get(name)!;
      const rotation = posed.rotations[bone]!;
      turnPoint(add(posed.positions[bone]!, rotate(rotation, at, place), place), position);
      // From the clip frame into the floor's the axes turn by half about +Y.
      multiply(halfTurn, multiply(rotation, rest, turned), orientation);
    }
    return this.#poses;
  }
}

const place = vec3(0, 0, 0);
const turned = quat(0, 0, 0, 1);
const halfTurn = fromAxisAngle(up, Math.PI);

/**
 * Returns one pose of a body as the joints of WebXR Body Tracking, in new objects. `XRBodyPoser` reuses them.
 *
 * @example
 * const elbow = toXRBody(pose.body, body.calibration).get('left-arm-lower').position;
 */
export const toXRBody = (body: UpperBodyPose, calibration: Calibration, fingers?: Fingers): XRBodyJoints =>
  new XRBodyPoser(calibration).pose(body, fingers);
