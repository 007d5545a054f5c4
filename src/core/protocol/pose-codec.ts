import type { AvatarPose, UpperBodyPose } from '../body/avatar-pose';
import { forwardKinematics } from '../body/forward-kinematics';
import type { JointName, Side } from '../body/joints';
import { type Skeleton, sideSign, wristFromHandBone } from '../body/skeleton';
import { elbowFlexion, solveTwoBones } from '../body/two-bone-ik';
import { clamp } from '../math/damper';
import type { Pose } from '../math/pose';
import {
  alignDirections,
  angleBetween,
  conjugate,
  fromAxisAngle,
  multiply,
  type Quat,
  rotate,
  swingTwist,
  twistAngle,
} from '../math/quat';
import {
  add,
  addScaled,
  cross,
  distance,
  dot,
  isFiniteVec3,
  length,
  normalise,
  reject,
  scale,
  subtract,
  type Vec3,
  vec3,
} from '../math/vec3';
import type { TrackedPose } from '../tracking/tracking-frame';
import { type BitReader, type BitWriter, createBitReader, createBitWriter } from './bits';
import {
  across,
  type DirectionSteps,
  fromDirectionSteps,
  fromQuatSteps,
  fromStep,
  mostSteps,
  type QuatSteps,
  readDirection,
  readQuat,
  readStep,
  readVec,
  toDirectionSteps,
  toQuatSteps,
  toStep,
  type VecSteps,
  writeDirection,
  writeQuat,
  writeStep,
  writeVec,
} from './quantise';

/** Bumped with every change of the layout: a receiver shows nothing rather than nonsense. */
export const poseVersion = 1;

/** No packet is longer [bytes]. */
export const longestPose = 64;

/** How far each finger is bent, 0 straight to 1 in the palm; thumb first. */
export type FingerCurl = readonly [number, number, number, number, number];

/** What one packet says. All poses in the sender's floor frame. */
export interface PosePacket {
  /** When the frame was, by the sender's clock [ms], modulo 65 536. */
  readonly timeMs: number;
  /** true: the sender's frame of reference changed; nobody interpolates from the packet before. */
  readonly jump: boolean;
  readonly pose: AvatarPose;
  /** How far each hand is closed, 0 to 1. */
  readonly grips: Readonly<Record<Side, number>>;
  /** null: unknown (a controller, a lost hand, or one that its arm has not caught up with). */
  readonly curls: Readonly<Record<Side, FingerCurl | null>>;
}

const sides = ['left', 'right'] as const;

/** A length on the wire is a multiple of this [m]. */
const unit = 0.0005;
/** The head: ±16 m from the origin of the floor frame, −1 to 3.09 m above it; beyond: at the edge. */
const headBits = 16;
const heightBits = 13;
const lowestHead = -1;
/** A hand: ±2 m from the head on each axis; beyond: at the edge. */
const handBits = 13;
/** Of head and hands: 0.1° at most. */
const trackedBits = 11;
const gripBits = 4;
const curlBits = 3;
const forearmBits = 6;
const swivelBits = 9;
/** A collarbone swings ±1.3 rad about each of two axes. */
const clavicleRange = 1.3;
/** A wrist of its own: which way from the shoulder, how far the elbow is bent, and how the hand is turned there. */
const directionBits = 8;
const flexionBits = 7;
const freeHandBits = 6;
/** How far a wrist is drawn beyond the hand, or before it, along its arm: multiples of this [m]. */
const stretchBits = 5;
const stretchUnit = 0.0001;
/** What is left for the trunk when both arms have wrists of their own, and otherwise. */
const trunkBitsFor = (freeArms: number): number => (freeArms === 2 ? 8 : 10);
const clavicleBitsFor = (freeArms: number): number => (freeArms === 2 ? 8 : 9);
const twistBitsFor = (freeArms: number): number => (freeArms === 2 ? 6 : 7);
/** A forearm twists a quarter turn either way. */
const forearmRange = Math.PI / 2;

/** A body's wrist this near to the tracked hand is drawn there [m, rad]; else it is sent on its own. */
const sameWrist = 0.003;
const sameHand = (0.8 * Math.PI) / 180;
/** A rebuilt elbow further off than this [m] is worth a wrist that is off by some tenths of a millimetre. */
const sameElbow = 0.002;

/** A pose as steps. */
interface PoseSteps {
  readonly position: VecSteps;
  readonly orientation: QuatSteps;
}

interface ArmSteps {
  readonly clavicle: readonly [number, number];
  readonly swivel: number;
  readonly forearmTwist: number;
  /** The hand's own wrist and how far beyond it along the arm; an almost straight arm's elbow tells tenths of a millimetre apart. */
  readonly stretch: number;
  /** The body's own wrist where it is not the hand's; null: the arm reaches for the hand. */
  readonly free: { readonly direction: DirectionSteps; readonly flexion: number; readonly hand: QuatSteps } | null;
}

interface TrunkSteps {
  readonly hips: QuatSteps;
  readonly upperChest: QuatSteps;
  readonly neck: QuatSteps;
  readonly spineTwist: number;
  readonly chestTwist: number;
}

interface BodyBits {
  readonly trunk: number;
  readonly twist: number;
  readonly clavicle: number;
}

const bodyBitsFor = (freeArms: number): BodyBits => ({
  trunk: trunkBitsFor(freeArms),
  twist: twistBitsFor(freeArms),
  clavicle: clavicleBitsFor(freeArms),
});

interface BodySteps {
  readonly bits: BodyBits;
  readonly trunk: TrunkSteps;
  readonly arms: Readonly<Record<Side, ArmSteps>>;
}

type Tracking = TrackedPose['tracking'] | 'lost';

/** A whole packet as whole numbers. */
interface PacketSteps {
  readonly timeMs: number;
  readonly jump: boolean;
  readonly head: PoseSteps & { readonly tracking: TrackedPose['tracking'] };
  readonly hands: Readonly<
    Record<Side, { readonly tracking: Tracking; readonly at: PoseSteps | null; readonly grip: number }>
  >;
  readonly curls: Readonly<Record<Side, readonly number[] | null>>;
  readonly body: BodySteps | null;
}

const heightCentre = lowestHead + mostSteps(heightBits) * unit;

const headPosition = ([x, y, z]: VecSteps): Vec3 => vec3(x * unit, y * unit + heightCentre, z * unit);

const limited = (steps: number, bits: number): number => clamp(Math.round(steps), -mostSteps(bits), mostSteps(bits));

function headSteps({ position, orientation }: Pose<'floor'>): PoseSteps {
  return {
    position: [
      limited(position.x / unit, headBits),
      limited((position.y - heightCentre) / unit, heightBits),
      limited(position.z / unit, headBits),
    ],
    orientation: toQuatSteps(orientation, trackedBits),
  };
}

function handSteps(head: Vec3, { position, orientation }: Pose<'floor'>): PoseSteps {
  const from = subtract(position, head);
  return {
    position: [limited(from.x / unit, handBits), limited(from.y / unit, handBits), limited(from.z / unit, handBits)],
    orientation: toQuatSteps(orientation, trackedBits),
  };
}

const handPose = (head: Vec3, { position: [x, y, z], orientation }: PoseSteps): Pose<'floor'> => ({
  position: add(head, vec3(x * unit, y * unit, z * unit)),
  orientation: fromQuatSteps(orientation, trackedBits),
});

/** Rotations of the trunk's joints against the floor, and where the collarbones begin. */
interface Trunk {
  readonly hips: Vec3;
  readonly rotations: Readonly<Record<'hips' | 'spine' | 'chest' | 'upperChest' | 'neck', Quat>>;
  readonly clavicleRoots: Readonly<Record<Side, Vec3>>;
}

/** The axis a joint twists about: the way to the next one. */
const spineAxis = ({ restOffsets }: Skeleton): Vec3 => normalise(add(restOffsets.spine, restOffsets.chest));
const chestAxis = ({ restOffsets }: Skeleton): Vec3 => normalise(add(restOffsets.upperChest, restOffsets.neck));

/** From the head down: the trunk hangs from where the head is. */
function placeTrunk(head: Pose<'floor'>, steps: TrunkSteps, bits: BodyBits, skeleton: Skeleton): Trunk {
  const { restOffsets: offsets, eyesInHead } = skeleton;
  const hips = fromQuatSteps(steps.hips, bits.trunk);
  const upperChest = fromQuatSteps(steps.upperChest, bits.trunk);
  const neck = fromQuatSteps(steps.neck, bits.trunk);
  const twist = (axis: Vec3, step: number) => fromAxisAngle(axis, fromStep(step, Math.PI, bits.twist));
  const spine = multiply(hips, twist(spineAxis(skeleton), steps.spineTwist));
  const chest = multiply(upperChest, twist(chestAxis(skeleton), steps.chestTwist));

  const headJoint = subtract(head.position, rotate(head.orientation, eyesInHead));
  const neckJoint = subtract(headJoint, rotate(neck, offsets.head));
  const upperChestJoint = subtract(neckJoint, rotate(upperChest, offsets.neck));
  const chestJoint = subtract(upperChestJoint, rotate(chest, offsets.upperChest));
  const spineJoint = subtract(chestJoint, rotate(spine, offsets.chest));
  return {
    hips: subtract(spineJoint, rotate(hips, offsets.spine)),
    rotations: { hips, spine, chest, upperChest, neck },
    clavicleRoots: {
      left: add(upperChestJoint, rotate(upperChest, offsets.leftShoulder)),
      right: add(upperChestJoint, rotate(upperChest, offsets.rightShoulder)),
    },
  };
}

interface Shoulder {
  readonly position: Vec3;
  /** Of the collarbone. */
  readonly orientation: Quat;
}

function placeShoulder(
  side: Side,
  trunk: Trunk,
  clavicle: readonly [number, number],
  bits: number,
  { restOffsets }: Skeleton,
): Shoulder {
  const rest = restOffsets[`${side}UpperArm`];
  const [u, v] = across(normalise(rest));
  const turn = addScaled(
    scale(u, fromStep(clavicle[0], clavicleRange, bits)),
    v,
    fromStep(clavicle[1], clavicleRange, bits),
  );
  const orientation = multiply(trunk.rotations.upperChest, fromAxisAngle(normalise(turn), length(turn)));
  return { position: add(trunk.clavicleRoots[side], rotate(orientation, rest)), orientation };
}

interface Arm {
  readonly upperArm: Quat;
  readonly lowerArm: Quat;
  readonly hand: Quat;
}

const boneLengths = (side: Side, { restOffsets }: Skeleton): readonly [number, number] => [
  length(restOffsets[`${side}LowerArm`]),
  length(restOffsets[`${side}Hand`]),
];

/** The directions about the line from shoulder to wrist that the swivel is counted from, and a quarter turn on. */
function swivelAxes(side: Side, trunk: Trunk, axis: Vec3): readonly [Vec3, Vec3] {
  const { upperChest } = trunk.rotations;
  const downAndBack = reject(rotate(upperChest, vec3(0.2 * sideSign(side), -0.88, 0.43)), axis);
  // An arm that points down and back has no such direction: then forward. Both ends know the same arm, to the last bit or nearly.
  const u = normalise(length(downAndBack) > 0.1 ? downAndBack : reject(rotate(upperChest, vec3(0, 0, -1)), axis));
  return [u, cross(axis, u)];
}

/** An arm from shoulder to wrist whose elbow swivels to where it is told; the hand as given. */
function placeArm(
  side: Side,
  trunk: Trunk,
  shoulder: Vec3,
  wrist: Vec3,
  hand: Quat,
  { swivel, forearmTwist }: Pick<ArmSteps, 'swivel' | 'forearmTwist'>,
  skeleton: Skeleton,
): Arm {
  const sigma = sideSign(side);
  const [upper, fore] = boneLengths(side, skeleton);
  const { upperChest } = trunk.rotations;
  const axis = normalise(subtract(wrist, shoulder), rotate(upperChest, vec3(0, -1, 0)));
  const [u, v] = swivelAxes(side, trunk, axis);
  const angle = fromStep(swivel, Math.PI, swivelBits);
  const pole = addScaled(scale(u, Math.cos(angle)), v, Math.sin(angle));
  const { elbow } = solveTwoBones(shoulder, wrist, upper, fore, pole, [axis, u]);
  const along = vec3(sigma, 0, 0);
  const hingeAtRest = vec3(0, sigma, 0);
  const hinge = cross(pole, axis);
  const upperArm = alignDirections(along, hingeAtRest, subtract(elbow, shoulder), hinge);
  const straight = alignDirections(along, hingeAtRest, subtract(wrist, elbow), hinge);
  const lowerArm = multiply(straight, fromAxisAngle(along, fromStep(forearmTwist, forearmRange, forearmBits)));
  return { upperArm, lowerArm, hand };
}

/** Where an arm's wrist is, and how its hand bone is turned. */
interface ArmTarget {
  readonly wrist: Vec3;
  readonly hand: Quat;
}

/** Where the arm ends: at its own wrist, or at the hand. */
function armTarget(
  side: Side,
  shoulder: Vec3,
  hand: Pose<'floor'>,
  { free, stretch }: Pick<ArmSteps, 'free' | 'stretch'>,
  skeleton: Skeleton,
): ArmTarget {
  if (!free) {
    const along = normalise(subtract(hand.position, shoulder));
    return {
      wrist: addScaled(hand.position, along, stretch * stretchUnit),
      hand: multiply(hand.orientation, wristFromHandBone[side]),
    };
  }
  const [upper, fore] = boneLengths(side, skeleton);
  const flexion = (free.flexion / (2 ** flexionBits - 1)) * Math.PI;
  const far = Math.sqrt(upper * upper + fore * fore + 2 * upper * fore * Math.cos(flexion));
  return {
    wrist: addScaled(shoulder, fromDirectionSteps(free.direction, directionBits), far),
    hand: fromQuatSteps(free.hand, freeHandBits),
  };
}

/** The body that a packet's numbers stand for. */
function placeBody(
  head: Pose<'floor'>,
  hands: Readonly<Record<Side, Pose<'floor'>>>,
  { bits, trunk: trunkSteps, arms }: BodySteps,
  skeleton: Skeleton,
): UpperBodyPose {
  const trunk = placeTrunk(head, trunkSteps, bits, skeleton);
  const { hips, spine, chest, upperChest, neck } = trunk.rotations;
  const place = (side: Side) => {
    const shoulder = placeShoulder(side, trunk, arms[side].clavicle, bits.clavicle, skeleton);
    const target = armTarget(side, shoulder.position, hands[side], arms[side], skeleton);
    const arm = placeArm(side, trunk, shoulder.position, target.wrist, target.hand, arms[side], skeleton);
    return { shoulder: shoulder.orientation, ...arm };
  };
  const left = place('left');
  const right = place('right');
  const local = (parent: Quat, child: Quat): Quat => multiply(conjugate(parent), child);
  const localRotations: Record<JointName, Quat> = {
    hips,
    spine: local(hips, spine),
    chest: local(spine, chest),
    upperChest: local(chest, upperChest),
    neck: local(upperChest, neck),
    head: local(neck, head.orientation),
    leftShoulder: local(upperChest, left.shoulder),
    leftUpperArm: local(left.shoulder, left.upperArm),
    leftLowerArm: local(left.upperArm, left.lowerArm),
    leftHand: local(left.lowerArm, left.hand),
    rightShoulder: local(upperChest, right.shoulder),
    rightUpperArm: local(right.shoulder, right.upperArm),
    rightLowerArm: local(right.upperArm, right.lowerArm),
    rightHand: local(right.lowerArm, right.hand),
  };
  return { hipsPosition: trunk.hips, localRotations };
}

type Joints = Readonly<Record<JointName, Pose<'floor'>>>;

function trunkSteps(body: UpperBodyPose, joints: Joints, bits: BodyBits, skeleton: Skeleton): TrunkSteps {
  const twist = (axis: Vec3, from: Quat, to: Quat) =>
    toStep(twistAngle(swingTwist(multiply(conjugate(from), to), axis).twist, axis), Math.PI, bits.twist);
  const hips = body.localRotations.hips;
  return {
    hips: toQuatSteps(hips, bits.trunk),
    upperChest: toQuatSteps(joints.upperChest.orientation, bits.trunk),
    neck: toQuatSteps(joints.neck.orientation, bits.trunk),
    spineTwist: twist(spineAxis(skeleton), hips, joints.spine.orientation),
    chestTwist: twist(chestAxis(skeleton), joints.upperChest.orientation, joints.chest.orientation),
  };
}

/** The collarbone's swing that puts the shoulder nearest to where it is, from where the receiver's collarbone begins. */
function clavicleSteps(
  side: Side,
  trunk: Trunk,
  joints: Joints,
  bits: number,
  { restOffsets }: Skeleton,
): readonly [number, number] {
  const rest = normalise(restOffsets[`${side}UpperArm`]);
  const to = rotate(
    conjugate(trunk.rotations.upperChest),
    normalise(subtract(joints[`${side}UpperArm`].position, trunk.clavicleRoots[side])),
  );
  const turn = scale(normalise(cross(rest, to)), Math.acos(clamp(dot(rest, to), -1, 1)));
  const [u, v] = across(rest);
  return [toStep(dot(turn, u), clavicleRange, bits), toStep(dot(turn, v), clavicleRange, bits)];
}

/** Swivel and twist that make the receiver's arm, between its own shoulder and wrist, look like the sender's. */
function armSteps(
  side: Side,
  trunk: Trunk,
  joints: Joints,
  shoulder: Vec3,
  wrist: Vec3,
  skeleton: Skeleton,
): Pick<ArmSteps, 'swivel' | 'forearmTwist'> & { readonly elbowError: number } {
  const sigma = sideSign(side);
  const axis = normalise(subtract(wrist, shoulder), rotate(trunk.rotations.upperChest, vec3(0, -1, 0)));
  const bend = reject(subtract(joints[`${side}LowerArm`].position, shoulder), axis);
  // A straight arm's elbow is on the line: then the plane in which it would bend.
  const hinge = rotate(joints[`${side}UpperArm`].orientation, vec3(0, sigma, 0));
  const pole = length(bend) > 0.02 ? bend : cross(axis, hinge);
  const [u, v] = swivelAxes(side, trunk, axis);
  const swivel = toStep(Math.atan2(dot(pole, v), dot(pole, u)), Math.PI, swivelBits);
  const untwisted = placeArm(
    side,
    trunk,
    shoulder,
    wrist,
    wristFromHandBone[side],
    { swivel, forearmTwist: 0 },
    skeleton,
  );
  const along = vec3(sigma, 0, 0);
  const turned = multiply(conjugate(untwisted.lowerArm), joints[`${side}LowerArm`].orientation);
  const elbow = add(shoulder, rotate(untwisted.upperArm, skeleton.restOffsets[`${side}LowerArm`]));
  return {
    swivel,
    elbowError: distance(elbow, joints[`${side}LowerArm`].position),
    forearmTwist: toStep(twistAngle(swingTwist(turned, along).twist, along), forearmRange, forearmBits),
  };
}

/** The body as the receiver will rebuild it from these head and hands: every step makes up for the rounding before it. */
function bodySteps(
  body: UpperBodyPose,
  head: Pose<'floor'>,
  hands: Readonly<Record<Side, Pose<'floor'>>>,
  skeleton: Skeleton,
): BodySteps {
  const joints = forwardKinematics(skeleton, body);
  const isFree = (side: Side): boolean => {
    const hand = joints[`${side}Hand`];
    const [upper, fore] = boneLengths(side, skeleton);
    const shoulder = joints[`${side}UpperArm`].position;
    const toHand = subtract(hands[side].position, shoulder);
    // What a straight arm cannot reach it points at.
    const reached = addScaled(shoulder, normalise(toHand), Math.min(length(toHand), upper + fore));
    return (
      distance(hand.position, reached) > sameWrist ||
      angleBetween(hand.orientation, multiply(hands[side].orientation, wristFromHandBone[side])) > sameHand
    );
  };
  const freeArms: Record<Side, boolean> = { left: isFree('left'), right: isFree('right') };
  const count = Number(freeArms.left) + Number(freeArms.right);
  const bits = bodyBitsFor(count);
  const trunkNumbers = trunkSteps(body, joints, bits, skeleton);
  const trunk = placeTrunk(head, trunkNumbers, bits, skeleton);

  const arm = (side: Side): ArmSteps => {
    const clavicle = clavicleSteps(side, trunk, joints, bits.clavicle, skeleton);
    const shoulder = placeShoulder(side, trunk, clavicle, bits.clavicle, skeleton).position;
    const { position, orientation } = joints[`${side}Hand`];
    const [upper, fore] = boneLengths(side, skeleton);
    const far = distance(joints[`${side}UpperArm`].position, position);
    const free = freeArms[side]
      ? {
          direction: toDirectionSteps(subtract(position, shoulder), directionBits),
          flexion: levels(elbowFlexion(upper, fore, far) / Math.PI, flexionBits),
          hand: toQuatSteps(orientation, freeHandBits),
        }
      : null;
    const bent = (stretch: number) => {
      const { wrist } = armTarget(side, shoulder, hands[side], { free, stretch }, skeleton);
      return { stretch, ...armSteps(side, trunk, joints, shoulder, wrist, skeleton) };
    };
    const exact = bent(0);
    if (free || exact.elbowError <= sameElbow) return { clavicle, free, ...exact };
    const stretch = limited((far - distance(shoulder, hands[side].position)) / stretchUnit, stretchBits);
    const stretched = bent(stretch);
    return { clavicle, free, ...(stretched.elbowError < exact.elbowError ? stretched : exact) };
  };
  return { bits, trunk: trunkNumbers, arms: { left: arm('left'), right: arm('right') } };
}

const isFinitePose = ({ position, orientation: { x, y, z, w } }: Pose<'floor'>): boolean =>
  isFiniteVec3(position) && Number.isFinite(x + y + z + w);

const isFiniteBody = ({ hipsPosition, localRotations }: UpperBodyPose): boolean =>
  isFiniteVec3(hipsPosition) && Object.values(localRotations).every(({ x, y, z, w }) => Number.isFinite(x + y + z + w));

const levels = (value: number, bits: number): number =>
  Math.round(clamp(Number.isFinite(value) ? value : 0, 0, 1) * (2 ** bits - 1));

/**
 * The packet's bytes, 64 at most; null where head, a hand or the body is not finite. The skeleton is the sender's own; the body's
 * head is where the pose's head is, as every estimator has it. Positions beyond the ranges of docs/protocol.md come out at their edges.
 */
export function encodePose(packet: PosePacket, skeleton: Skeleton): Uint8Array | null {
  const { head, leftHand, rightHand, body } = packet.pose;
  const tracked = { left: leftHand, right: rightHand };
  const finite = [head, leftHand, rightHand].every((pose) => pose === null || isFinitePose(pose));
  if (!finite || (body && !isFiniteBody(body)) || !Number.isFinite(packet.timeMs)) return null;

  const headNumbers = headSteps(head);
  const headAsSent: Pose<'floor'> = {
    position: headPosition(headNumbers.position),
    orientation: fromQuatSteps(headNumbers.orientation, trackedBits),
  };
  // A lost hand's place is taken by the wrist that the body shows instead.
  const joints = body && forwardKinematics(skeleton, body);
  const shown = (side: Side): Pose<'floor'> | null => {
    const hand = tracked[side];
    if (hand || !joints) return hand;
    const { position, orientation } = joints[`${side}Hand`];
    return { position, orientation: multiply(orientation, conjugate(wristFromHandBone[side])) };
  };
  const at = (side: Side): PoseSteps | null => {
    const pose = shown(side);
    return pose && handSteps(headAsSent.position, pose);
  };
  const places = { left: at('left'), right: at('right') };
  const bodyNumbers =
    body && places.left && places.right
      ? bodySteps(
          body,
          headAsSent,
          {
            left: handPose(headAsSent.position, places.left),
            right: handPose(headAsSent.position, places.right),
          },
          skeleton,
        )
      : null;
  const hand = (side: Side) => ({
    tracking: tracked[side]?.tracking ?? ('lost' as const),
    at: places[side],
    grip: levels(packet.grips[side], gripBits),
  });
  const curl = (side: Side): readonly number[] | null => {
    const fingers = packet.curls[side];
    if (!fingers || !tracked[side] || bodyNumbers?.arms[side].free) return null;
    return fingers.map((finger) => levels(finger, curlBits));
  };
  return writePacket({
    timeMs: Math.round(packet.timeMs) & 0xffff,
    jump: packet.jump,
    head: { ...headNumbers, tracking: head.tracking },
    hands: { left: hand('left'), right: hand('right') },
    curls: { left: curl('left'), right: curl('right') },
    body: bodyNumbers,
  });
}

const trackings: readonly Tracking[] = ['lost', 'emulated', 'tracked'];

function writePacket({ timeMs, jump, head, hands, curls, body }: PacketSteps): Uint8Array {
  const writer = createBitWriter();
  const flag = (set: boolean) => writer.write(set ? 1 : 0, 1);
  writer.write(poseVersion, 4);
  flag(jump);
  flag(body !== null);
  flag(head.tracking === 'tracked');
  for (const side of sides) flag(curls[side] !== null);
  for (const side of sides) flag(body?.arms[side].free != null);
  for (const side of sides) writer.write(trackings.indexOf(hands[side].tracking), 2);
  writer.write(timeMs, 16);
  const [x, y, z] = head.position;
  writeStep(writer, x, headBits);
  writeStep(writer, y, heightBits);
  writeStep(writer, z, headBits);
  writeQuat(writer, head.orientation, trackedBits);
  for (const side of sides) {
    const { at, grip } = hands[side];
    writer.write(grip, gripBits);
    if (!at) continue;
    writeVec(writer, at.position, handBits);
    writeQuat(writer, at.orientation, trackedBits);
  }
  for (const side of sides) for (const finger of curls[side] ?? []) writer.write(finger, curlBits);
  if (body) writeBody(writer, body);
  return writer.bytes();
}

function writeBody(writer: BitWriter, { bits, trunk, arms }: BodySteps): void {
  writeQuat(writer, trunk.hips, bits.trunk);
  writeQuat(writer, trunk.upperChest, bits.trunk);
  writeQuat(writer, trunk.neck, bits.trunk);
  writeStep(writer, trunk.spineTwist, bits.twist);
  writeStep(writer, trunk.chestTwist, bits.twist);
  for (const side of sides) {
    const { clavicle, swivel, forearmTwist, stretch, free } = arms[side];
    writeStep(writer, clavicle[0], bits.clavicle);
    writeStep(writer, clavicle[1], bits.clavicle);
    writeStep(writer, swivel, swivelBits);
    writeStep(writer, forearmTwist, forearmBits);
    if (free) {
      writeDirection(writer, free.direction, directionBits);
      writer.write(free.flexion, flexionBits);
      writeQuat(writer, free.hand, freeHandBits);
    } else {
      writeStep(writer, stretch, stretchBits);
    }
  }
}

/** The numbers of a packet; null for anything that `encodePose` never writes. */
function readPacket(bytes: Uint8Array): PacketSteps | null {
  if (bytes.length > longestPose) return null;
  const reader = createBitReader(bytes);
  const flag = (): boolean => reader.read(1) === 1;
  if (reader.read(4) !== poseVersion) return null;
  const jump = flag();
  const hasBody = flag();
  const headTracking = flag() ? ('tracked' as const) : ('emulated' as const);
  const hasCurl = { left: flag(), right: flag() };
  const isFree = { left: flag(), right: flag() };
  const tracking = { left: trackings[reader.read(2)], right: trackings[reader.read(2)] };
  const timeMs = reader.read(16);
  for (const side of sides) {
    if (tracking[side] === undefined || (isFree[side] && !hasBody)) return null;
    if (hasCurl[side] && (isFree[side] || tracking[side] === 'lost')) return null;
  }

  const x = readStep(reader, headBits);
  const y = readStep(reader, heightBits);
  const z = readStep(reader, headBits);
  const orientation = readQuat(reader, trackedBits);
  if (x === null || y === null || z === null || orientation === null) return null;

  const readHand = (side: Side) => {
    const grip = reader.read(gripBits);
    const sort = tracking[side] ?? 'lost';
    if (sort === 'lost' && !hasBody) return { tracking: sort, at: null, grip };
    const position = readVec(reader, handBits);
    const turned = readQuat(reader, trackedBits);
    return position && turned ? { tracking: sort, at: { position, orientation: turned }, grip } : null;
  };
  const left = readHand('left');
  const right = readHand('right');
  if (!left || !right) return null;
  const readCurl = (side: Side) => (hasCurl[side] ? [0, 1, 2, 3, 4].map(() => reader.read(curlBits)) : null);
  const curls = { left: readCurl('left'), right: readCurl('right') };
  const body = hasBody ? readBody(reader, isFree) : null;
  if ((hasBody && !body) || !reader.ended()) return null;
  return {
    timeMs,
    jump,
    head: { position: [x, y, z], orientation, tracking: headTracking },
    hands: { left, right },
    curls,
    body,
  };
}

function readBody(reader: BitReader, isFree: Readonly<Record<Side, boolean>>): BodySteps | null {
  const count = Number(isFree.left) + Number(isFree.right);
  const bits = bodyBitsFor(count);
  const hips = readQuat(reader, bits.trunk);
  const upperChest = readQuat(reader, bits.trunk);
  const neck = readQuat(reader, bits.trunk);
  const spineTwist = readStep(reader, bits.twist);
  const chestTwist = readStep(reader, bits.twist);
  if (!hips || !upperChest || !neck || spineTwist === null || chestTwist === null) return null;
  const readArm = (side: Side): ArmSteps | null => {
    const u = readStep(reader, bits.clavicle);
    const v = readStep(reader, bits.clavicle);
    const swivel = readStep(reader, swivelBits);
    const forearmTwist = readStep(reader, forearmBits);
    if (u === null || v === null || swivel === null || forearmTwist === null) return null;
    const arm = { clavicle: [u, v] as const, swivel, forearmTwist };
    if (!isFree[side]) {
      const stretch = readStep(reader, stretchBits);
      return stretch === null ? null : { ...arm, stretch, free: null };
    }
    const direction = readDirection(reader, directionBits);
    const flexion = reader.read(flexionBits);
    const hand = readQuat(reader, freeHandBits);
    return direction && hand ? { ...arm, stretch: 0, free: { direction, flexion, hand } } : null;
  };
  const left = readArm('left');
  const right = readArm('right');
  return left && right
    ? { bits, trunk: { hips, upperChest, neck, spineTwist, chestTwist }, arms: { left, right } }
    : null;
}

/** Head and hands of a packet, floor frame, without the body. */
export type PointsPacket = Omit<PosePacket, 'pose'> & { readonly pose: AvatarPose & { readonly body: null } };

function pointsOf({ timeMs, jump, head, hands, curls }: PacketSteps): PointsPacket {
  const position = headPosition(head.position);
  const hand = (side: Side): TrackedPose | null => {
    const { at, tracking } = hands[side];
    return at && tracking !== 'lost' ? { ...handPose(position, at), tracking } : null;
  };
  const curl = (side: Side): FingerCurl | null =>
    (curls[side]?.map((finger) => finger / (2 ** curlBits - 1)) as FingerCurl | undefined) ?? null;
  const grip = (side: Side): number => hands[side].grip / (2 ** gripBits - 1);
  return {
    timeMs,
    jump,
    pose: {
      head: { position, orientation: fromQuatSteps(head.orientation, trackedBits), tracking: head.tracking },
      leftHand: hand('left'),
      rightHand: hand('right'),
      body: null,
    },
    grips: { left: grip('left'), right: grip('right') },
    curls: { left: curl('left'), right: curl('right') },
  };
}

/** What a relay needs: the whole packet checked, head and hands read; null for bad bytes, whatever they are. */
export function decodePoints(bytes: Uint8Array): PointsPacket | null {
  const steps = readPacket(bytes);
  return steps && pointsOf(steps);
}

/** The packet as it was sent, up to rounding; null for bad bytes, whatever they are. The skeleton is the sender's. */
export function decodePose(bytes: Uint8Array, skeleton: Skeleton): PosePacket | null {
  const steps = readPacket(bytes);
  if (!steps) return null;
  const points = pointsOf(steps);
  const { head } = points.pose;
  const { body, hands } = steps;
  if (!body || !hands.left.at || !hands.right.at) return points;
  const at = { left: handPose(head.position, hands.left.at), right: handPose(head.position, hands.right.at) };
  return { ...points, pose: { ...points.pose, body: placeBody(head, at, body, skeleton) } };
}
