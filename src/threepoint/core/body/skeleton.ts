import { clamp } from '../math/damper';
import { fromAxisAngle, type Quat } from '../math/quat';
import type { Side } from '../math/side';
import { add, length, up, type Vec3, vec3 } from '../math/vec3';
import proportions from './body-proportions.json' with { type: 'json' };
import { assertCalibration, type Calibration } from './calibration';
import type { JointName } from './joints';
import limbLimits from './limb-limits.json' with { type: 'json' };
import type { LimbBones } from './two-bone-ik';

const { forearmShare, forearmWeight, shortestArm } = limbLimits;

/**
 * The calibrated body in T-pose, facing −Z: each joint's offset [m] from its parent (`hips`: from the floor below),
 * and where the headset's origin sits in the frame of the head joint.
 */
export interface Skeleton {
  readonly restOffsets: Readonly<Record<JointName, Vec3>>;
  readonly eyesInHead: Vec3;
}

/** σ of docs/estimation.md: −1 left, +1 right. */
export const sideSign = (side: Side): -1 | 1 => (side === 'left' ? -1 : 1);

/**
 * The rotation from the hand bone to the wrist's frame in T-pose (knuckles sideways, palm down): handBone = wrist ·
 * wristFromHandBone.
 */
export const wristFromHandBone: Readonly<Record<Side, Quat>> = {
  left: fromAxisAngle(up, -Math.PI / 2),
  right: fromAxisAngle(up, Math.PI / 2),
};

/** Returns the length from shoulder to wrist [m], at least `shortestArm` eye heights. */
export function armLength({ eyeHeight, armSpan }: Calibration): number {
  const shoulders = 2 * (proportions.clavicleRoot + proportions.clavicle[0]!) * eyeHeight;
  return Math.max((armSpan - shoulders) / 2, shortestArm * eyeHeight);
}

/**
 * Returns bone lengths [m] that sum to `armLength`. A calibrated forearm is clamped to `forearmShare` of the arm, then
 * blended with the average by `forearmWeight`.
 */
export function armBones(calibration: Calibration): LimbBones {
  const arm = armLength(calibration);
  const average = (1 - proportions.upperArmShare) * arm;
  const plausible = clamp(calibration.forearm ?? average, forearmShare.min * arm, forearmShare.max * arm);
  const lower = average + forearmWeight * (plausible - average);
  return { upper: arm - lower, lower };
}

/** Returns the lengths of upper arm and forearm of this side [m]. */
export function armBonesOf(
  { restOffsets }: Skeleton,
  side: Side,
  target: { upper: number; lower: number } = { upper: 0, lower: 0 },
): LimbBones {
  target.upper = length(side === 'left' ? restOffsets.leftLowerArm : restOffsets.rightLowerArm);
  target.lower = length(side === 'left' ? restOffsets.leftHand : restOffsets.rightHand);
  return target;
}

const leanForward = (angle: number, v: Vec3): Vec3 => {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  return vec3(v.x, c * v.y + s * v.z, c * v.z - s * v.y);
};

/**
 * Returns the average body of this eye height and span [m] (docs/estimation.md); identity rotations are an upright
 * person in T-pose. The measures are not checked.
 */
export function averageSkeleton(calibration: Calibration): Skeleton {
  const p = proportions;
  const e = calibration.eyeHeight;
  const bones = armBones(calibration);
  const lowerBack = (y: number) => leanForward(p.lowerBackTilt, vec3(0, y * e, 0));
  const thorax = (v: Vec3) => leanForward(p.thoraxTilt, v);
  const halfThorax = thorax(vec3(0, (p.chestToNeck * e) / 2, 0));
  const shoulderOf = (side: Side): Vec3 => add(halfThorax, vec3(sideSign(side) * p.clavicleRoot * e, 0, 0));
  const upperArmOf = (side: Side): Vec3 =>
    thorax(vec3(sideSign(side) * p.clavicle[0]! * e, p.clavicle[1]! * e, -p.clavicle[2]! * e));
  const alongArm = (side: Side, bone: number): Vec3 => vec3(sideSign(side) * bone, 0, 0);
  return {
    restOffsets: {
      hips: vec3(0, p.hipsHeight * e, 0),
      spine: lowerBack(p.hipsToSpine),
      chest: lowerBack(p.spineToChest),
      upperChest: halfThorax,
      neck: halfThorax,
      head: thorax(vec3(0, p.neckToHead[0]! * e, -p.neckToHead[1]! * e)),
      leftShoulder: shoulderOf('left'),
      leftUpperArm: upperArmOf('left'),
      leftLowerArm: alongArm('left', bones.upper),
      leftHand: alongArm('left', bones.lower),
      rightShoulder: shoulderOf('right'),
      rightUpperArm: upperArmOf('right'),
      rightLowerArm: alongArm('right', bones.upper),
      rightHand: alongArm('right', bones.lower),
    },
    eyesInHead: vec3(0, p.eyesInHead[0]! * e, -p.eyesInHead[1]! * e),
  };
}

/**
 * Returns the average body of this eye height and span [m]; identity rotations are an upright person in T-pose. Throws
 * a RangeError where the measures are not human: measures in centimetres would give a giant.
 *
 * @example
 * const skeleton = skeletonFromCalibration({ eyeHeight: 1.6, armSpan: 1.5 });
 */
export function skeletonFromCalibration(calibration: Calibration): Skeleton {
  assertCalibration(calibration);
  return averageSkeleton(calibration);
}

/**
 * The measures for inverse kinematics in chest space [m]: y from the chest joint to the neck; arm and shoulder are the
 * right ones.
 */
export interface ChestSpaceBody {
  readonly eyeHeight: number;
  readonly arm: number;
  readonly armBones: LimbBones;
  readonly eyesInHead: Vec3;
  readonly neckToHead: Vec3;
  readonly thorax: number;
  readonly lowerBack: number;
  readonly clavicleRoot: Vec3;
  readonly clavicle: Vec3;
  readonly clavicleLength: number;
}

/** Returns the body of `averageSkeleton` before the curve of the standing spine. */
export function chestSpaceBody(calibration: Calibration): ChestSpaceBody {
  const p = proportions;
  const e = calibration.eyeHeight;
  const clavicle = vec3(p.clavicle[0]! * e, p.clavicle[1]! * e, -p.clavicle[2]! * e);
  return {
    eyeHeight: e,
    arm: armLength(calibration),
    armBones: armBones(calibration),
    eyesInHead: vec3(0, p.eyesInHead[0]! * e, -p.eyesInHead[1]! * e),
    neckToHead: vec3(0, p.neckToHead[0]! * e, -p.neckToHead[1]! * e),
    thorax: p.chestToNeck * e,
    lowerBack: (p.hipsToSpine + p.spineToChest) * e,
    clavicleRoot: vec3(p.clavicleRoot * e, 0, 0),
    clavicle,
    clavicleLength: length(clavicle),
  };
}
