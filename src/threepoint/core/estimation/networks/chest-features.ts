import type { ChestSpaceBody } from '../../body/skeleton';
import { rotate } from '../../math/quat';
import {
  dot,
  length,
  type MutableVec3,
  right,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
  writeVec3,
} from '../../math/vec3';
import type { ChestAxes, IkSolution, ThreePoints } from '../ik/solve-ik';

/** The number of features of a frame in the chest frame; their order is in docs/estimation.md. */
export const chestFeatureCount = 38;

/** Transforms a vector from the heading frame to the chest frame. */
function inChest({ x, y, z }: ChestAxes, v: Vec3, target: MutableVec3): MutableVec3 {
  return setVec3(target, dot(x, v), dot(y, v), dot(z, v));
}

/** Transforms a vector from the chest frame to the heading frame. */
export function headingFromChest({ x, y, z }: ChestAxes, v: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  return setVec3(
    target,
    x.x * v.x + y.x * v.y + z.x * v.z,
    x.y * v.x + y.y * v.y + z.y * v.z,
    x.z * v.x + y.z * v.y + z.z * v.z,
  );
}

const vector = vec3(0, 0, 0);

function write(target: Float32Array, next: number, chest: ChestAxes, v: MutableVec3): number {
  return writeVec3(inChest(chest, v, v), target, next);
}

/**
 * Writes the chest-frame features of one frame into `target` from `start` on. They are independent of how the body
 * turns and leans.
 */
export function chestFeatures(
  { head, leftHand, rightHand }: ThreePoints,
  { joints, chest }: IkSolution,
  body: ChestSpaceBody,
  target: Float32Array,
  start: number,
): void {
  let next = start;
  // At the end: the lengths of both reaches.
  const reaches = start + chestFeatureCount - 2;
  for (let arm = 0; arm < 2; arm++) {
    const hand = arm === 0 ? leftHand : rightHand;
    const shoulder = arm === 0 ? joints.leftUpperArm : joints.rightUpperArm;
    const elbow = arm === 0 ? joints.leftLowerArm : joints.rightLowerArm;
    scale(subtract(hand.position, shoulder, vector), 1 / body.arm, vector);
    target[reaches + arm] = length(vector);
    next = write(target, next, chest, vector);
    next = write(target, next, chest, rotate(hand.orientation, right, vector));
    next = write(target, next, chest, rotate(hand.orientation, up, vector));
    scale(subtract(elbow, shoulder, vector), 1 / body.eyeHeight, vector);
    next = write(target, next, chest, vector);
  }
  next = write(target, next, chest, rotate(head.orientation, right, vector));
  next = write(target, next, chest, rotate(head.orientation, up, vector));
  scale(subtract(joints.chest, head.position, vector), 1 / body.eyeHeight, vector);
  next = write(target, next, chest, vector);
  target[next] = chest.x.y;
  target[next + 1] = chest.y.y;
  target[next + 2] = chest.z.y;
}
