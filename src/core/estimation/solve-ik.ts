import type { Side } from '../body/joints';
import { type ChestSpaceBody, sideSign } from '../body/skeleton';
import { solveTwoBones } from '../body/two-bone-ik';
import { clamp } from '../math/damper';
import type { Pose } from '../math/pose';
import { conjugate, fromAxes, fromAxisAngle, rotate } from '../math/quat';
import {
  add,
  addScaled,
  cross,
  length,
  lerp,
  normalise,
  right,
  scale,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../math/vec3';
import parameters from './ik-parameters.json';
import type { JointPositions } from './joint-positions';

/** The collarbone's tip moves from rest by at most this share of its length: beyond, hands crossed low would fold it over. */
const girdleShift = 0.9;

const limitLength = (v: Vec3, longest: number): Vec3 => {
  const l = length(v);
  return l > longest ? scale(v, longest / l) : v;
};

/** Head and wrists in the heading frame. */
export interface ThreePoints {
  readonly head: Pose<'heading'>;
  readonly leftHand: Pose<'heading'>;
  readonly rightHand: Pose<'heading'>;
}

const backward: Vec3 = vec3(0, 0, 1);

const weighted = (weights: readonly number[], values: readonly number[]): number => {
  let sum = 0;
  for (let i = 0; i < weights.length; i++) sum += weights[i]! * values[i]!;
  return sum;
};

/** [1, …vectors] times a 3-row matrix of parameters. */
const affine = (rows: readonly (readonly number[])[], values: readonly number[]): Vec3 =>
  vec3(weighted(rows[0]!, values), weighted(rows[1]!, values), weighted(rows[2]!, values));

const mirrored = (v: Vec3, sigma: number): Vec3 => vec3(v.x * sigma, v.y, v.z);

/**
 * The six joints in the heading frame from head and wrists: spine bend, pelvis under the head, shoulder girdle and
 * two-bone arms with an anatomical swivel. The numbered steps are those of docs/estimation.md.
 */
export function solveIk(points: ThreePoints, body: ChestSpaceBody): JointPositions {
  const { head } = points;
  const e = body.eyeHeight;
  const headJoint = subtract(head.position, rotate(head.orientation, body.eyesInHead));
  const left = scale(subtract(points.leftHand.position, headJoint), 1 / body.arm);
  const rightHand = scale(subtract(points.rightHand.position, headJoint), 1 / body.arm);
  const middle = lerp(left, rightHand, 0.5);
  const across = subtract(rightHand, left);

  // 1. Chest yaw: turned by the hands.
  const [acrossWeight = 0, middleWeight = 0] = parameters.yaw;
  const aheadX = acrossWeight * across.z + middleWeight * middle.x;
  const aheadZ = -1 - acrossWeight * across.x + middleWeight * middle.z;
  const yaw = 1.2 * Math.tanh(Math.atan2(-aheadX, Math.max(-aheadZ, 0.2)) / 1.2);
  const turn = fromAxisAngle(up, yaw);

  // 2. Lean of thorax and lower back.
  const lookingDown = -rotate(head.orientation, vec3(0, 0, -1)).y;
  const crouch = clamp(1 - head.position.y / e, -0.2, 0.9);
  const sagittal = [1, lookingDown, crouch, -middle.z, -middle.y, lookingDown * crouch];
  const lateral = [rotate(head.orientation, right).y, middle.x, rightHand.y - left.y];
  const upDirection = (segment: { forward: number[]; sideways: number[] }): Vec3 => {
    const alpha = clamp(weighted(segment.forward, sagittal), -0.6, 1.9);
    const beta = clamp(weighted(segment.sideways, lateral), -0.8, 0.8);
    const flat = Math.cos(beta);
    return rotate(turn, vec3(Math.sin(beta), Math.cos(alpha) * flat, -Math.sin(alpha) * flat));
  };
  const thoraxUp = upDirection(parameters.upper);
  const lowerBackUp = upDirection(parameters.lower);

  // 3. Chest frame.
  const chestX = normalise(cross(thoraxUp, rotate(turn, backward)), right);
  const chest = fromAxes(chestX, thoraxUp, cross(chestX, thoraxUp));
  const chestInverse = conjugate(chest);

  // 4. Neck base. 5. Chest joint and hips.
  const neckLength = length(body.neckToHead);
  const neckRest = scale(body.neckToHead, 1 / neckLength);
  const neckDirection = normalise(
    lerp(rotate(chest, neckRest), rotate(head.orientation, neckRest), parameters.neck),
    thoraxUp,
  );
  const neck = addScaled(headJoint, neckDirection, -neckLength);
  const chestJoint = addScaled(neck, thoraxUp, -body.thorax);
  const hipsBelow = addScaled(chestJoint, lowerBackUp, -body.lowerBack);
  const hips = vec3(hipsBelow.x, Math.max(hipsBelow.y, 0.08 * e), hipsBelow.z);

  const arm = (side: Side): { shoulder: Vec3; elbow: Vec3 } => {
    const sigma = sideSign(side);
    const wrist = side === 'left' ? points.leftHand : points.rightHand;
    const inChest = (v: Vec3): Vec3 => mirrored(rotate(chestInverse, v), sigma);

    // 6. Shoulder girdle: the collarbone swings with the hand.
    const restShoulder = add(body.clavicleRoot, body.clavicle);
    const q = scale(subtract(inChest(subtract(wrist.position, neck)), restShoulder), 1 / body.arm);
    const shift = limitLength(
      scale(affine(parameters.girdle, [1, q.x, q.y, q.z]), e),
      girdleShift * body.clavicleLength,
    );
    const clavicle = scale(normalise(add(body.clavicle, shift), right), body.clavicleLength);
    const shoulder = add(neck, rotate(chest, mirrored(add(body.clavicleRoot, clavicle), sigma)));

    // 7. Elbow: the swivel follows where the hand is and how it is turned.
    const r = scale(inChest(subtract(wrist.position, shoulder)), 1 / body.arm);
    const back = inChest(rotate(wrist.orientation, up));
    const heel = inChest(rotate(wrist.orientation, backward));
    const values = [1, r.x, r.y, r.z, back.x, back.y, back.z, heel.x, heel.y, heel.z];
    const pole = rotate(chest, mirrored(affine(parameters.pole, values), sigma));
    const down = scale(thoraxUp, -1);
    const behind = rotate(chest, backward);
    const { elbow } = solveTwoBones(shoulder, wrist.position, body.upperArm, body.forearm, pole, [down, behind]);
    return { shoulder, elbow };
  };
  const leftArm = arm('left');
  const rightArm = arm('right');
  return {
    leftLowerArm: leftArm.elbow,
    rightLowerArm: rightArm.elbow,
    leftUpperArm: leftArm.shoulder,
    rightUpperArm: rightArm.shoulder,
    chest: chestJoint,
    hips,
  };
}
