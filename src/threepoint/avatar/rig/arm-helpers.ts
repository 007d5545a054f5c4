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
import type { HelperJoint, Rig } from './rig';
import { type SpreadLimb, spreadLimbOf } from './spread-limb-weights';

/** The joints that are added to one arm. */
interface ArmHelpers {
  readonly side: Side;
  /** The joints that rotate half as far as the bone that begins there. */
  readonly shoulder: HelperJoint;
  readonly elbow: HelperJoint;
  readonly wrist: HelperJoint;
  /** The joints along the upper arm, in equal steps of its twist: the first has none of it, the bone itself all. */
  readonly upper: readonly HelperJoint[];
  /** The joints along the forearm, in equal steps of the hand's twist: the bone itself has none of it, the last all. */
  readonly lower: readonly HelperJoint[];
  /** The unwrapped twist of the upper arm relative to the clavicle [rad]. */
  upperTwist: number;
  /** The unwrapped twist of the hand relative to the forearm [rad]. */
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

/** Returns the twist of `to` relative to `from` about an axis of both [rad]. */
function angleAbout(from: Quat, to: Quat, along: (typeof alongArm)[Side]): number {
  multiply(conjugate(from, inverse), to, against);
  return twistAngle(twistOf(against, along, twist), along);
}

/**
 * Adds joints to the arms of a rig, so that the skin is not wrung and no joint folds. The twist of the hand spreads
 * over the forearm and that of the upper arm over itself; shoulder, elbow and wrist bend in two steps. The skin of any
 * rig is shared among them (spread-limb-weights); the rig's own twist bones count as the bone they lie on.
 */
export class ArmHelperJoints {
  readonly #rig: Rig;
  readonly #arms: readonly ArmHelpers[];

  constructor(rig: Rig) {
    this.#rig = rig;
    this.#arms = sides.map((side) => makeHelpers(rig, side));
  }

  /** Returns the joints among which the skin is to be shared. */
  limbs(): readonly SpreadLimb[] {
    return this.#arms.map(({ shoulder, elbow, wrist, upper, lower }) =>
      spreadLimbOf([shoulder, elbow, wrist], { upper, lower }),
    );
  }

  /** Removes the twist from the forearms of a pose, floor frame; `place` adds it to the joints along them. */
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

  /** Places the added joints for a pose whose bones were placed before. */
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

  /** Aligns the added joints with their bones, for arms that are not drawn. */
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
