import { estimatedJoints } from '../body/joints';
import { addScaled, cross, dot, length, normalise, scale, subtract, type Vec3, vec3 } from '../math/vec3';
import {
  armFeature,
  firstAxisFeature,
  headFeature,
  ikFeatureOffset,
  leftHandFeature,
  rightHandFeature,
} from './features';

/** Numbers of what IK's chest sees of a frame; their order is in docs/estimation.md. */
export const chestFeatureCount = 38;

/** The axes of IK's chest, heading frame, unit: from shoulder to shoulder, up the spine, backward. */
export interface ChestAxes {
  readonly x: Vec3;
  readonly y: Vec3;
  readonly z: Vec3;
}

/** A frame as IK's chest sees it, where an arm looks the same whichever way its body turns and leans. */
export interface ChestView {
  readonly axes: ChestAxes;
  readonly features: Float32Array;
}

/** From one frame's features. */
export function viewFromChest(frame: Float32Array): ChestView {
  const [leftShoulder, rightShoulder] = [ikJoint(frame, 'leftUpperArm'), ikJoint(frame, 'rightUpperArm')];
  const chest = ikJoint(frame, 'chest');
  const axes = chestAxes(leftShoulder, rightShoulder, chest);
  const features = new Float32Array(chestFeatureCount);
  let next = 0;
  const see = (seen: Vec3): Vec3 => {
    const inChest = vec3(dot(axes.x, seen), dot(axes.y, seen), dot(axes.z, seen));
    features[next++] = inChest.x;
    features[next++] = inChest.y;
    features[next++] = inChest.z;
    return inChest;
  };
  /** Returns how far the wrist is from the shoulder [arm lengths]. */
  const seeArm = (hand: number, shoulder: Vec3, elbow: Vec3): number => {
    const reach = see(addScaled(vectorAt(frame, hand), shoulder, -1 / frame[armFeature]!));
    seeTurn(hand + firstAxisFeature);
    see(subtract(elbow, shoulder));
    return length(reach);
  };
  const seeTurn = (columns: number): void => {
    see(vectorAt(frame, columns));
    see(vectorAt(frame, columns + 3));
  };
  const left = seeArm(leftHandFeature, leftShoulder, ikJoint(frame, 'leftLowerArm'));
  const right = seeArm(rightHandFeature, rightShoulder, ikJoint(frame, 'rightLowerArm'));
  seeTurn(headFeature);
  see(chest);
  features.set([axes.x.y, axes.y.y, axes.z.y, left, right], next);
  return { axes, features };
}

/** A vector that the chest sees, in the heading frame. */
export const headingFromChest = ({ x, y, z }: ChestAxes, seen: Vec3): Vec3 =>
  addScaled(addScaled(scale(x, seen.x), y, seen.y), z, seen.z);

function chestAxes(left: Vec3, right: Vec3, chest: Vec3): ChestAxes {
  const x = normalise(subtract(right, left));
  const spine = subtract(addScaled(scale(left, 0.5), right, 0.5), chest);
  const y = normalise(addScaled(spine, x, -dot(spine, x)));
  return { x, y, z: cross(x, y) };
}

const vectorAt = (frame: Float32Array, index: number): Vec3 =>
  vec3(frame[index]!, frame[index + 1]!, frame[index + 2]!);

/** A joint of the IK solution from the headset, heading frame, eye heights. */
const ikJoint = (frame: Float32Array, joint: (typeof estimatedJoints)[number]): Vec3 =>
  vectorAt(frame, ikFeatureOffset + 3 * estimatedJoints.indexOf(joint));
