import { add, length, scale, type Vec3, vec3 } from '../math/vec3';
import type { BvhJoint } from '../motion/read-bvh';
import mocapRules from './mocap-rules.json' with { type: 'json' };

const { cmuconvert } = mocapRules;

/** The children of the lost thorax bone, and the joints that identify a file of cmuconvert. */
const thoraxChildren = ['Neck', 'LeftShoulder', 'RightShoulder'];
const trunk = ['LowerBack', 'Spine', 'Spine1', ...thoraxChildren];
const sides = ['Left', 'Right'] as const;

const lost = (offset: Vec3, beside: Vec3): boolean => length(offset) < 0.01 * length(beside);
const eachAxis = ([x, y, z]: readonly number[], v: Vec3): Vec3 => vec3(x! * v.x, y! * v.y, z! * v.z);

/**
 * Restores the bones of the CMU database that cmuconvert lost: the thorax, and the wrist of either arm.
 * In such a skeleton neck and shoulders lie on Spine1 and the finger base on the hand; their rotations are there, their
 * lengths are not. The thorax follows from the two bones below it by least squares on the skeletons of 26 people: with
 * each person left out its end is 0.4 cm off on average, 1.1 cm at most. In every skeleton of the database the wrist
 * bone is half as long as the radius and lies along it at rest. Other skeletons stay as they are. `notes`: what was
 * done, a sentence each.
 */
export function restoreLostBones(joints: readonly BvhJoint[]): {
  readonly joints: readonly BvhJoint[];
  readonly notes: readonly string[];
} {
  const offsets = new Map(joints.map(({ name, offset }) => [name, offset]));
  const notes: string[] = [];
  const placed = new Map<string, Vec3>();
  if (trunk.every((name) => offsets.has(name))) {
    const upper = offsets.get('Spine1')!;
    if (thoraxChildren.every((name) => lost(offsets.get(name)!, upper))) {
      const { thoraxFromLowerBack, thoraxFromUpperBack } = cmuconvert;
      const thorax = add(eachAxis(thoraxFromLowerBack, offsets.get('Spine')!), eachAxis(thoraxFromUpperBack, upper));
      for (const name of thoraxChildren) placed.set(name, thorax);
      notes.push(
        'cmuconvert lost the thorax bone; it is put back, estimated from the two below (0.4 cm off on average)',
      );
    }
  }
  for (const side of sides) {
    const hand = offsets.get(`${side}Hand`);
    const base = offsets.get(`${side}FingerBase`);
    if (!hand || !base || !lost(base, hand)) continue;
    const wrist = scale(hand, cmuconvert.wristOfRadius);
    placed.set(`${side}FingerBase`, wrist);
    const thumb = offsets.get(`${side[0]}Thumb`);
    if (thumb && lost(thumb, hand)) placed.set(`${side[0]}Thumb`, wrist);
    notes.push(`cmuconvert lost the ${side.toLowerCase()} wrist bone; it is put back, half as long as the radius`);
  }
  return { joints: joints.map((joint) => ({ ...joint, offset: placed.get(joint.name) ?? joint.offset })), notes };
}

/**
 * Returns the joints of a cmuconvert skeleton where hands begin: its `LeftHand` lies in mid-forearm, where the radius
 * ends.
 */
export const handsOfCmuconvert = (names: readonly string[]): Partial<Record<'leftHand' | 'rightHand', string>> =>
  sides.every((side) => names.includes(`${side}FingerBase`) && names.includes(`${side}Hand`))
    ? { leftHand: 'LeftFingerBase', rightHand: 'RightFingerBase' }
    : {};
