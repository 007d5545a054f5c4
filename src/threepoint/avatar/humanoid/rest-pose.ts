import type { VRM } from '@pixiv/three-vrm';
import { Matrix4, type Object3D, Quaternion, Vector3 } from 'three';
import { type BoneName, handFingerBones, neededBones } from '../../core/humanoid/bones';
import { type Side, sides } from '../../core/math/side';
import { placeOf, skinMovedBy } from '../scene-meshes';
import { boneNode } from './needed-bones';

// In this file a body at rest faces +Z, as a VRM does: its left is +X.
const left = new Vector3(1, 0, 0);
const right = new Vector3(-1, 0, 0);
const up = new Vector3(0, 1, 0);
const down = new Vector3(0, -1, 0);

/** The largest lean of a body at rest [rad]; a larger one is a rotated scene. */
const maxLean = 0.6;
/** The range of plausible heights [m]; other bodies are in another unit and are scaled to the default height. */
const smallest = 0.4;
const largest = 4;
const usual = 1.6;
/** The height of the ankle above the sole [fraction of the height of the head joint]. */
const ankleFraction = 0.065;
/** The angle from which a limb counts as bent [rad]. */
const armBend = 0.03;
const handBend = 0.1;
const legBend = 0.05;
const handRoll = 0.15;

/** Returns the rotations that map axes to axes. */
function axisRotations(): Matrix4[] {
  const units = [left, right, up, down, new Vector3(0, 0, 1), new Vector3(0, 0, -1)];
  return units.flatMap((x) =>
    units.filter((y) => x.dot(y) === 0).map((y) => new Matrix4().makeBasis(x, y, x.clone().cross(y)).transpose()),
  );
}

/** Returns the angle between two rotations [rad]. */
const between = (a: Matrix4, b: Matrix4): number =>
  new Quaternion().setFromRotationMatrix(a).angleTo(new Quaternion().setFromRotationMatrix(b));

/**
 * Returns the rotation that brings a body upright and facing +Z: by right angles if that suffices, because bodies lean
 * a little.
 */
function standing(hips: Vector3, head: Vector3, toLeft: Vector3): Matrix4 {
  const y = head.clone().sub(hips).normalize();
  const x = toLeft.clone().addScaledVector(y, -toLeft.dot(y)).normalize();
  const exact = new Matrix4().makeBasis(x, y, x.clone().cross(y)).transpose();
  const [nearest = exact] = axisRotations().sort((a, b) => between(a, exact) - between(b, exact));
  return between(nearest, exact) < maxLean ? nearest : exact;
}

/**
 * The bones of a body while its rest pose is settled. They are rotated and moved in the world frame, even if other
 * nodes lie between them.
 */
class RestingBody {
  constructor(
    readonly vrm: VRM,
    readonly name: string,
  ) {}

  /** null: the body has no such bone. */
  node(bone: BoneName): Object3D | null {
    return boneNode(this.vrm, bone);
  }

  at(bone: BoneName): Vector3 | null {
    const node = this.node(bone);
    return node && placeOf(node);
  }

  /** Rotates a bone and its descendants about its joint; further bones of the list move with it. */
  turn(bones: readonly BoneName[], rotation: Quaternion): void {
    const nodes = bones.flatMap((bone) => this.node(bone) ?? []);
    const [pivot] = nodes;
    if (!pivot) return;
    const centre = placeOf(pivot);
    const move = new Matrix4()
      .makeTranslation(centre)
      .multiply(new Matrix4().makeRotationFromQuaternion(rotation))
      .multiply(new Matrix4().makeTranslation(centre.negate()));
    const wanted = nodes.map((node) => move.clone().multiply(node.matrixWorld));
    for (const [index, node] of nodes.entries()) setWorld(node, wanted[index] as Matrix4);
  }

  complain(what: string): never {
    throw new Error(`${this.name}: ${what}`);
  }
}

function setWorld(node: Object3D, world: Matrix4): void {
  const parent = node.parent?.matrixWorld ?? new Matrix4();
  node.matrix.multiplyMatrices(parent.clone().invert(), world);
  node.matrix.decompose(node.position, node.quaternion, node.scale);
  node.updateWorldMatrix(false, true);
}

function assertFiniteJoints(body: RestingBody): void {
  for (const bone of neededBones) {
    const node = body.node(bone);
    if (node && !node.matrixWorld.elements.every(Number.isFinite))
      body.complain(`the joint of ${bone} lies nowhere (${placeOf(node).toArray().join(', ')})`);
  }
}

/** Throws if the joints have implausible distances, such as an arm longer than the body. */
function assertBodyProportions(body: RestingBody): void {
  const head = body.at('head')!;
  const hips = body.at('hips')!;
  const trunk = head.distanceTo(hips);
  const limbs: readonly (readonly [BoneName, BoneName])[] = [
    ['leftUpperArm', 'leftLowerArm'],
    ['leftLowerArm', 'leftHand'],
    ['rightUpperArm', 'rightLowerArm'],
    ['rightLowerArm', 'rightHand'],
  ];
  for (const [from, to] of limbs) {
    const fraction = body.at(from)!.distanceTo(body.at(to)!) / trunk;
    if (fraction > 0.02 && fraction < 5) continue;
    const part = `${Number(fraction.toPrecision(2))} times as far from ${from} as the head from the hips`;
    body.complain(`its joints are no body’s: ${to} lies ${part}`);
  }
}

/** Returns whether a negative scale mirrors the skin. */
function mirrored(body: RestingBody): boolean {
  return body.node('hips')!.matrixWorld.determinant() < 0;
}

/** Transforms the scene so that the body stands on the floor, faces +Z and has a plausible size. */
function standUpright(body: RestingBody): void {
  const { scene } = body.vrm;
  const apply = (matrix: Matrix4) => setWorld(scene, matrix.multiply(scene.matrixWorld));
  if (mirrored(body)) apply(new Matrix4().makeScale(-1, 1, 1));
  const hips = body.at('hips')!;
  const head = body.at('head')!;
  const toLeft = body.at('leftUpperArm')!.sub(body.at('rightUpperArm')!);
  const trunk = head.distanceTo(hips);
  if (!(trunk > 0) || !(toLeft.length() > trunk * 0.01))
    body.complain('its joints lie all in one place: is the scene scaled to nothing?');
  const turned = standing(hips, head, toLeft);
  if (between(turned, new Matrix4()) > 1e-6) apply(turned);
  const size = body.at('head')!.y - lowest(body);
  if (!(size > smallest && size < largest)) apply(new Matrix4().makeScale(usual / size, usual / size, usual / size));
}

/** Returns the height [m] of the soles, estimated from the bones; for a body without legs that of average legs. */
function lowest(body: RestingBody): number {
  const head = body.at('head')!.y;
  const feet = [body.at('leftFoot'), body.at('rightFoot')].flatMap((foot) => foot?.y ?? []);
  if (feet.length === 0) return head - 2.6 * (head - body.at('hips')!.y);
  const ankle = Math.min(...feet);
  return ankle - (head - ankle) * ankleFraction;
}

/** Returns the height [m] of the lowest skin of the feet; null: they move none. */
function sole(body: RestingBody): number | null {
  const feet = new Set<Object3D>();
  for (const side of sides) body.node(`${side}Foot`)?.traverse((node) => feet.add(node));
  const skin = skinMovedBy(body.vrm.scene, feet);
  return skin.length > 0 ? skin.reduce((least, { y }) => Math.min(least, y), Number.POSITIVE_INFINITY) : null;
}

/**
 * Moves the soles to the floor and the pelvis above the origin, if they are off by more than is seen. Soles that bones
 * alone show may be off by the thickness of shoes.
 */
function putOnFloor(body: RestingBody): void {
  const skin = sole(body);
  const floor = skin ?? lowest(body);
  const hips = body.at('hips')!;
  const shoes = (body.at('head')!.y - floor) * 0.06;
  const seen = skin === null ? shoes : 0.005;
  const move = new Vector3(hips.x, Math.abs(floor) < seen ? 0 : floor, Math.abs(hips.z) < shoes ? 0 : hips.z).negate();
  const { scene } = body.vrm;
  if (move.length() > 1e-4) setWorld(scene, new Matrix4().makeTranslation(move).multiply(scene.matrixWorld));
}

const sideBones = (side: Side, names: readonly string[]): BoneName[] =>
  names.map((name) => `${side}${name}` as BoneName);

/** Rotates the first of `bones` so that it points along `way`, if it is off by more than `least` [rad]. */
function point(body: RestingBody, bones: readonly BoneName[], to: Vector3 | null, way: Vector3, least: number): void {
  const from = body.at(bones[0]!);
  if (!from || !to) return;
  const direction = to.clone().sub(from).normalize();
  if (!(direction.angleTo(way) > least)) return;
  body.turn(bones, new Quaternion().setFromUnitVectors(direction, way));
}

/** Returns the mean position of the finger roots; null: the hand has no fingers. */
function knuckles(body: RestingBody, side: Side): Vector3 | null {
  const roots = sideBones(side, ['IndexProximal', 'MiddleProximal', 'RingProximal', 'LittleProximal']);
  const found = roots.flatMap((root) => body.at(root) ?? []);
  if (found.length === 0) return null;
  return found.reduce((sum, root) => sum.add(root), new Vector3()).divideScalar(found.length);
}

/** Straightens an arm to the side with the palm down: the rest pose to which rotations of a pose are relative. */
function straightenArm(body: RestingBody, side: Side): void {
  const out = side === 'left' ? left : right;
  const hand = sideBones(side, ['Hand', ...handFingerBones]);
  const lowerArm = sideBones(side, ['LowerArm']).concat(hand);
  const upperArm = sideBones(side, ['UpperArm']).concat(lowerArm);
  point(body, upperArm, body.at(lowerArm[0]!), out, armBend);
  point(body, lowerArm, body.at(hand[0]!), out, armBend);
  point(body, hand, knuckles(body, side), out, handBend);
  const index = body.at(`${side}IndexProximal`);
  const little = body.at(`${side}LittleProximal`) ?? body.at(`${side}RingProximal`);
  if (!index || !little) return;
  // With the palm down, the index finger is in front of the others.
  const across = index.sub(little);
  const roll = Math.atan2(across.y, across.z);
  if (Math.abs(roll) > handRoll) body.turn(hand, new Quaternion().setFromAxisAngle(left, roll));
}

/** Straightens a leg downwards; the feet keep their orientation. */
function straightenLeg(body: RestingBody, side: Side): void {
  const foot = sideBones(side, ['Foot', 'Toes']);
  const lowerLeg = sideBones(side, ['LowerLeg']).concat(foot);
  const upperLeg = sideBones(side, ['UpperLeg']).concat(lowerLeg);
  const node = body.node(foot[0]!);
  const stood = node?.getWorldQuaternion(new Quaternion());
  point(body, upperLeg, body.at(lowerLeg[0]!), down, legBend);
  point(body, lowerLeg, body.at(foot[0]!), down, legBend);
  if (!node || !stood) return;
  const back = stood.multiply(node.getWorldQuaternion(new Quaternion()).invert());
  if (2 * Math.acos(Math.min(1, Math.abs(back.w))) > 1e-3) body.turn(foot, back);
}

/**
 * Brings a body from a file into the rest pose: upright on the floor, of plausible size, facing +Z, arms straight to
 * the sides with palms down, legs straight down. The scene may have any scale and rotation. Throws an Error that names
 * the file if the joints are implausible.
 */
export function settleRest(vrm: VRM, name: string): void {
  const body = new RestingBody(vrm, name);
  vrm.scene.updateMatrixWorld(true);
  assertFiniteJoints(body);
  standUpright(body);
  assertFiniteJoints(body);
  assertBodyProportions(body);
  for (const side of sides) {
    straightenArm(body, side);
    straightenLeg(body, side);
  }
  putOnFloor(body);
  vrm.nodeConstraintManager?.setInitState();
  vrm.springBoneManager?.reset();
}
