import type { Object3D } from 'three';
import { alongArm, unwrapTwist } from '../../core/body/arm-rotations';
import type { MutableJointPoses } from '../../core/body/forward-kinematics';
import {
  conjugate,
  copyQuat,
  fromAxisAngle,
  multiply,
  type Quat,
  quat,
  slerp,
  twistAngle,
  twistOf,
} from '../../core/math/quat';
import { type Side, sides } from '../../core/math/side';
import type { Steps } from '../between-frames';
import type { HelperJoint, Rig } from './rig';
import { type SpreadArm, spreadArmWeights } from './spread-arm-weights';

/** The joints that are added to an arm. */
interface ArmHelpers {
  readonly side: Side;
  /** Joints at shoulder, elbow and wrist whose rotation is halfway between the adjacent bones. */
  readonly shoulder: HelperJoint;
  readonly elbow: HelperJoint;
  readonly wrist: HelperJoint;
  /** Joints along the upper arm, from the shoulder: the first has none of the twist, and the bone itself all of it. */
  readonly upper: readonly HelperJoint[];
  /**
   * Joints along the forearm, from the elbow: the bone itself has none of the hand's twist, and the last joint all of
   * it.
   */
  readonly lower: readonly HelperJoint[];
  /** The unwrapped twist [rad] of the upper arm relative to the clavicle. */
  upperTwist: number;
  /** The unwrapped twist [rad] of the hand relative to the forearm. */
  lowerTwist: number;
}

const upperJoints = 2;
const lowerJoints = 3;

const against = quat(0, 0, 0, 1);
const inverse = quat(0, 0, 0, 1);
const twist = quat(0, 0, 0, 1);
const turned = quat(0, 0, 0, 1);
const step = quat(0, 0, 0, 1);
const begin = quat(0, 0, 0, 1);

/** Returns the twist [rad] from `from` to `to` about an axis that both share. */
function angleAbout(from: Quat, to: Quat, along: (typeof alongArm)[Side]): number {
  multiply(conjugate(from, inverse), to, against);
  return twistAngle(twistOf(against, along, twist), along);
}

/**
 * Adds joints to an arm so that its skin neither collapses nor folds: the twist of the hand is distributed over the
 * forearm, that of the upper arm over itself, and shoulder, elbow and wrist bend in two steps. The skin weights of any
 * rig are redistributed to them (spread-arm-weights), including those of its twist bones.
 */
export class ArmHelperJoints {
  readonly #rig: Rig;
  readonly #arms: readonly ArmHelpers[];

  constructor(rig: Rig) {
    this.#rig = rig;
    this.#arms = sides.map((side) => makeHelpers(rig, side));
  }

  /**
   * Redistributes the skin weights under `scene` to the joints; called once. The rig must be at rest, with its world
   * matrices up to date.
   */
  spreadSkinWeights(scene: Object3D): Steps<void> {
    return spreadArmWeights(
      scene,
      this.#arms.map((arm) => spreadArmOf(this.#rig, arm)),
    );
  }

  /** Removes the twist from the forearms of a pose, floor frame; `place` applies it to the joints along them. */
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

  /** Places the joints by the bones of the pose, which must have been placed before. */
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
      fromAxisAngle(along, -arm.upperTwist / upperJoints, step);
      copyQuat(upper.orientation, turned);
      for (let k = upperJoints - 1; k >= 0; k--) {
        rig.placeHelper(arm.upper[k]!, upper.position, multiply(turned, step, turned));
      }
      rig.placeHelper(arm.shoulder, upper.position, slerp(collar.orientation, turned, 0.5, begin));
      fromAxisAngle(along, arm.lowerTwist / lowerJoints, step);
      copyQuat(lower.orientation, turned);
      for (let k = 0; k < lowerJoints; k++) {
        rig.placeHelper(arm.lower[k]!, lower.position, multiply(turned, step, turned));
      }
      rig.placeHelper(arm.wrist, hand.position, slerp(turned, hand.orientation, 0.5, begin));
      rig.placeHelper(arm.elbow, lower.position, slerp(upper.orientation, lower.orientation, 0.5, begin));
    }
  }

  /** Aligns the joints with their bones, for arms that are not drawn. */
  straighten(): void {
    for (const { shoulder, elbow, wrist, upper, lower } of this.#arms) {
      for (const joint of [shoulder, elbow, wrist]) this.#rig.straighten(joint);
      for (const joint of upper) this.#rig.straighten(joint);
      for (const joint of lower) this.#rig.straighten(joint);
    }
  }
}

function makeHelpers(rig: Rig, side: Side): ArmHelpers {
  const [upperArm, lowerArm, hand] = [`${side}UpperArm`, `${side}LowerArm`, `${side}Hand`] as const;
  return {
    side,
    shoulder: rig.addHelper(upperArm, 'half'),
    elbow: rig.addHelper(lowerArm, 'half'),
    wrist: rig.addHelper(hand, 'half'),
    upper: Array.from({ length: upperJoints }, (_, k) => rig.addHelper(upperArm, `twist ${k} of ${upperJoints}`)),
    lower: Array.from({ length: lowerJoints }, (_, k) => rig.addHelper(lowerArm, `twist ${k + 1} of ${lowerJoints}`)),
    upperTwist: 0,
    lowerTwist: 0,
  };
}

function spreadArmOf(rig: Rig, { side, shoulder, elbow, wrist, upper, lower }: ArmHelpers): SpreadArm {
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
    jointPositions: [upperArm.restPosition, lowerArm.restPosition, hand.restPosition],
    shoulder: shoulder.node,
    elbow: elbow.node,
    wrist: wrist.node,
    alongUpper: [...upper.map(({ node }) => node), upperArm.node],
    alongLower: [lowerArm.node, ...lower.map(({ node }) => node)],
  };
}
