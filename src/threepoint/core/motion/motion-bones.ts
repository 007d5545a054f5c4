import { type Calibration, statureFromEyeHeight } from '../body/calibration';
import { fingerBoneNames } from '../body/finger-bone-names';
import { averageHand, fingerPoints, type HandGeometry, makeFingerPoints, mirrorPoint } from '../body/hand-geometry';
import { type FingerBend, type FingerName, fingerNames } from '../body/hand-shape';
import { type JointName, jointNames, parentOf } from '../body/joints';
import { legProportions } from '../body/leg-proportions';
import { averageSkeleton, type Skeleton, sideSign, wristFromHandBone } from '../body/skeleton';
import { type MutableQuat, type Quat, rotateInverse, setQuat } from '../math/quat';
import { type Side, sides } from '../math/side';
import { add, type MutableVec3, setVec3, subtract, type Vec3, vec3 } from '../math/vec3';

/**
 * A bone of a motion, by its VRM name. Positions are in the clip frame: the floor frame turned by half about +Y, so
 * that a person in T-pose faces +Z and their left is +X, as files of motion and VRM 1.0 have it.
 */
export interface MotionBone {
  readonly name: string;
  /** Index of the parent; −1: the root. */
  readonly parent: number;
  /** From the parent's joint in T-pose [m]; of the root: from the floor below. */
  readonly offset: Vec3;
  /** The end of the bone from its joint [m]; null: the joint of its first child. */
  readonly end: Vec3 | null;
  /** Whether a device or an estimator provides the bone's motion; false (legs): it keeps its rest. */
  readonly measured: boolean;
}

/** Turns a point by half about +Y: from the floor frame into the clip frame, and back. */
export const turnPoint = (point: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, -point.x, point.y, -point.z);

/** Returns the rotation in the frame that is turned by half a turn about +Y. */
export const turnRotation = (q: Quat, target: MutableQuat): MutableQuat => setQuat(target, -q.x, q.y, -q.z, q.w);

const straight: FingerBend = { knuckle: 0, spread: 0, middle: 0, end: 0 };
const thumbAside: FingerBend = { ...straight, spread: Math.PI / 4 };

/**
 * How a finger rests in VRM's T-pose: straight and level, the thumb half-way between the fingers' direction and the
 * front.
 */
export const restBend = (finger: FingerName): FingerBend => (finger === 'thumb' ? thumbAside : straight);

/** Returns a point of a left wrist's frame relative to the wrist of this side, clip frame, in T-pose. */
function handPoint(side: Side, point: Vec3): Vec3 {
  const inWrist = side === 'left' ? point : mirrorPoint(point, vec3(0, 0, 0));
  return turnPoint(rotateInverse(wristFromHandBone[side], inWrist));
}

class Builder {
  readonly bones: MotionBone[] = [];
  readonly #index = new Map<string, number>();

  /** Adds a bone; `end` may be left out where a child follows. */
  add(name: string, parent: string | null, offset: Vec3, { end = null as Vec3 | null, measured = true } = {}): void {
    this.#index.set(name, this.bones.length);
    this.bones.push({ name, parent: parent === null ? -1 : this.#index.get(parent)!, offset, end, measured });
  }
}

function addFingers(builder: Builder, side: Side, hand: HandGeometry): void {
  const points = makeFingerPoints();
  for (const finger of fingerNames) {
    fingerPoints(finger, hand[finger], restBend(finger), points);
    const at = points.map((point) => handPoint(side, point));
    let parent: string = `${side}Hand`;
    for (const [i, name] of fingerBoneNames(side, finger).entries()) {
      const offset = i === 0 ? at[0]! : subtract(at[i]!, at[i - 1]!);
      builder.add(name, parent, offset, i === 2 ? { end: subtract(at[3]!, at[2]!) } : {});
      parent = name;
    }
  }
}

function addLeg(builder: Builder, side: Side, eyeHeight: number, hipsHeight: number): void {
  const { aside, hip, knee, ankle, foot } = legProportions;
  const rest = { measured: false };
  builder.add(
    `${side}UpperLeg`,
    'hips',
    vec3(-sideSign(side) * aside * eyeHeight, hip * eyeHeight - hipsHeight, 0),
    rest,
  );
  builder.add(`${side}LowerLeg`, `${side}UpperLeg`, vec3(0, (knee - hip) * eyeHeight, 0), rest);
  const end = vec3(0, -ankle * eyeHeight, foot * eyeHeight);
  builder.add(`${side}Foot`, `${side}LowerLeg`, vec3(0, (ankle - knee) * eyeHeight, 0), { end, measured: false });
}

/**
 * A person's bones in T-pose, every bone before its children: trunk and arms with their fingers, all measured; then the
 * legs, which are not.
 */
export function motionSkeleton(calibration: Calibration): readonly MotionBone[] {
  const { eyeHeight } = calibration;
  const skeleton: Skeleton = averageSkeleton(calibration);
  const hand = averageHand(eyeHeight);
  const builder = new Builder();
  const crown = add(skeleton.eyesInHead, vec3(0, statureFromEyeHeight(eyeHeight) - eyeHeight, -skeleton.eyesInHead.z));
  const addJoint = (joint: JointName): void => {
    builder.add(
      joint,
      parentOf[joint],
      turnPoint(skeleton.restOffsets[joint]),
      joint === 'head' ? { end: turnPoint(crown) } : {},
    );
    for (const side of sides) if (joint === `${side}Hand`) addFingers(builder, side, hand);
  };
  for (const joint of jointNames) addJoint(joint);
  for (const side of sides) addLeg(builder, side, eyeHeight, skeleton.restOffsets.hips.y);
  return builder.bones;
}
