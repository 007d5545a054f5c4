import type { Object3D } from 'three';
import { alongArm, unwrapTwist } from '../core/body/arm-rotations';
import type { MutableJointPoses } from '../core/body/forward-kinematics';
import { conjugate, fromAxisAngle, multiply, type Quat, quat, slerp, twistAngle, twistOf } from '../core/math/quat';
import type { Side } from '../core/math/side';
import type { Steps } from './in-steps';
import type { HelperJoint, Rig } from './rig';
import { type SpreadArm, spreadArms } from './spread-weights';

const sides = ['left', 'right'] as const;

/** One arm's joints that its file lacks. */
interface ArmHelpers {
  readonly side: Side;
  /** At the shoulder, elbow and wrist: half of the way from the bone before to the bone after. */
  readonly shoulder: HelperJoint;
  readonly elbow: HelperJoint;
  readonly wrist: HelperJoint;
  /** From the shoulder on, with so much of the upper arm's twist; the bone itself has all of it. */
  readonly upper: readonly Twisted[];
  /** From the elbow on, with so much of the hand's twist; the bone itself has none of it. */
  readonly lower: readonly Twisted[];
  /** Unwrapped angle [rad] by which the upper arm is turned about itself against the clavicle. */
  upperTwist: number;
  /** By which the hand is turned about the forearm. */
  lowerTwist: number;
}

interface Twisted {
  readonly joint: HelperJoint;
  readonly share: number;
}

const upperShares = [0, 0.5] as const;
const lowerShares = [1 / 3, 2 / 3, 1] as const;

const against = quat(0, 0, 0, 1);
const inverse = quat(0, 0, 0, 1);
const twist = quat(0, 0, 0, 1);
const turned = quat(0, 0, 0, 1);
const begin = quat(0, 0, 0, 1);

/** The angle [rad] by which `to` is turned against `from` about an axis of both. */
function angleAbout(from: Quat, to: Quat, along: (typeof alongArm)[Side]): number {
  multiply(conjugate(from, inverse), to, against);
  return twistAngle(twistOf(against, along, twist), along);
}

/**
 * Joints between those of an arm, so that its skin is nowhere wrung and no joint folds: the turn of the hand spreads over the forearm and that of
 * the upper arm over itself, and shoulder, elbow and wrist bend in two steps. The skin of any rig is shared among them (spread-weights); twist
 * bones of its own are taken for the bone they lie on.
 */
export class ArmHelperJoints {
  readonly #rig: Rig;
  readonly #arms: readonly ArmHelpers[];

  constructor(rig: Rig) {
    this.#rig = rig;
    this.#arms = sides.map((side) => makeHelpers(rig, side));
  }

  /** Shares the skin under `scene` among the joints, once. The rig must be at rest, its world matrices up to date. */
  shareSkin(scene: Object3D): Steps<void> {
    return spreadArms(
      scene,
      this.#arms.map((arm) => spreadOf(this.#rig, arm)),
    );
  }

  /** Takes the twist out of the forearms of a pose, floor frame; `place` gives it back to what lies along them. */
  untwist(joints: MutableJointPoses): void {
    for (let i = 0; i < this.#arms.length; i++) {
      const arm = this.#arms[i]!;
      const left = arm.side === 'left';
      const along = alongArm[arm.side];
      const upper = (left ? joints.leftUpperArm : joints.rightUpperArm).orientation;
      const lower = (left ? joints.leftLowerArm : joints.rightLowerArm).orientation;
      const collar = (left ? joints.leftShoulder : joints.rightShoulder).orientation;
      const hand = (left ? joints.leftHand : joints.rightHand).orientation;
      arm.upperTwist = unwrapTwist(angleAbout(collar, upper, along), arm.upperTwist);
      const atWrist = angleAbout(lower, hand, along);
      const atElbow = angleAbout(upper, lower, along);
      arm.lowerTwist = atElbow + atWrist;
      multiply(lower, fromAxisAngle(along, -atElbow, twist), lower);
    }
  }

  /** Puts the joints between where the bones of the pose are, which were placed before. */
  place(joints: MutableJointPoses): void {
    for (let i = 0; i < this.#arms.length; i++) {
      const arm = this.#arms[i]!;
      const left = arm.side === 'left';
      const collar = left ? joints.leftShoulder : joints.rightShoulder;
      const upper = left ? joints.leftUpperArm : joints.rightUpperArm;
      const lower = left ? joints.leftLowerArm : joints.rightLowerArm;
      const hand = left ? joints.leftHand : joints.rightHand;
      const along = alongArm[arm.side];
      const rig = this.#rig;
      for (const { joint, share } of arm.upper) {
        turnAbout(upper.orientation, along, (share - 1) * arm.upperTwist);
        rig.placeHelper(joint, upper.position, turned);
      }
      turnAbout(upper.orientation, along, -arm.upperTwist);
      rig.placeHelper(arm.shoulder, upper.position, slerp(collar.orientation, turned, 0.5, begin));
      for (const { joint, share } of arm.lower) {
        turnAbout(lower.orientation, along, share * arm.lowerTwist);
        rig.placeHelper(joint, lower.position, turned);
      }
      rig.placeHelper(arm.wrist, hand.position, slerp(turned, hand.orientation, 0.5, begin));
      rig.placeHelper(arm.elbow, lower.position, slerp(upper.orientation, lower.orientation, 0.5, begin));
    }
  }

  /** Straight on with the bones they lie on: of arms that are not seen. */
  straighten(): void {
    for (const { shoulder, elbow, wrist, upper, lower } of this.#arms) {
      for (const joint of [shoulder, elbow, wrist]) this.#rig.straighten(joint);
      for (const { joint } of upper) this.#rig.straighten(joint);
      for (const { joint } of lower) this.#rig.straighten(joint);
    }
  }
}

/** An orientation turned by an angle [rad] about an axis of its own, in `turned`. */
const turnAbout = (orientation: Quat, along: (typeof alongArm)[Side], angle: number): Quat =>
  multiply(orientation, fromAxisAngle(along, angle, twist), turned);

function makeHelpers(rig: Rig, side: Side): ArmHelpers {
  const [upperArm, lowerArm, hand] = [`${side}UpperArm`, `${side}LowerArm`, `${side}Hand`] as const;
  return {
    side,
    shoulder: rig.addHelper(upperArm, 'half'),
    elbow: rig.addHelper(lowerArm, 'half'),
    wrist: rig.addHelper(hand, 'half'),
    upper: upperShares.map((share) => ({ share, joint: rig.addHelper(upperArm, `twist ${share.toFixed(2)}`) })),
    lower: lowerShares.map((share) => ({ share, joint: rig.addHelper(lowerArm, `twist ${share.toFixed(2)}`) })),
    upperTwist: 0,
    lowerTwist: 0,
  };
}

function spreadOf(rig: Rig, { side, shoulder, elbow, wrist, upper, lower }: ArmHelpers): SpreadArm {
  const bone = (name: 'UpperArm' | 'LowerArm' | 'Hand') => {
    const found = rig.bones.get(`${side}${name}`);
    if (!found) throw new Error(`avatar/arm-helpers: a rig without ${side}${name}`);
    return found;
  };
  const [upperArm, lowerArm, hand] = [bone('UpperArm'), bone('LowerArm'), bone('Hand')];
  return {
    upperArm: upperArm.node,
    lowerArm: lowerArm.node,
    hand: hand.node,
    places: [upperArm.restPosition, lowerArm.restPosition, hand.restPosition],
    shoulder: shoulder.node,
    elbow: elbow.node,
    wrist: wrist.node,
    alongUpper: [...upper.map(({ joint }) => joint.node), upperArm.node],
    alongLower: [lowerArm.node, ...lower.map(({ joint }) => joint.node)],
  };
}
