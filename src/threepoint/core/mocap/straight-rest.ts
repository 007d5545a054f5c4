import { conjugate, fromAxisAngle, multiply, type Quat, rotate, rotationBetween } from '../math/quat';
import { type Side, sides } from '../math/side';
import { median } from '../math/statistics';
import { add, cross, dot, length, normalise, reject, subtract, type Vec3, zero } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion, type SkeletonPose } from '../motion/imported-motion';
import { type BodyJoints, downward, outward, sampledFrames } from './body-axes';

/** The smallest cosine between a bone and the direction of its straight limb. */
const straight = 0.9;
/** The smallest cosine between a clavicle and the side. */
const clavicleOutward = 0.5;
/** The cosine between hand and forearm at rest up to which a hand is bent. */
const bentHand = 0.5;
/** The smallest increase of that cosine in the motion that shows that only the rest is bent. */
const straighter = 0.5;
/** The smallest bend of an elbow [sine] that defines the axis of its hinge. */
const bentElbow = 0.35;

/** Returns the joints of an arm: shoulder, elbow and hand. */
export const armOf = (joints: BodyJoints, side: Side): readonly [number, number, number] => [
  joints[`${side}UpperArm`]!,
  joints[`${side}LowerArm`]!,
  joints[`${side}Hand`]!,
];

/** Rotates joints of a pose about one of them, with all that hangs from it. */
class Straightener {
  readonly pose: SkeletonPose;

  constructor(readonly file: ImportedMotion) {
    this.pose = createSkeletonPose(file.names.length);
    for (const [i, at] of file.rest.entries()) Object.assign(this.pose.positions[i]!, at);
  }

  #hangsFrom(joint: number, ancestor: number): boolean {
    let at = joint;
    while (at >= 0 && at !== ancestor) at = this.file.parents[at]!;
    return at === ancestor;
  }

  turn(joint: number, rotation: Quat): void {
    const { positions, rotations } = this.pose;
    const pivot = { ...positions[joint]! };
    for (const i of positions.keys()) {
      if (!this.#hangsFrom(i, joint)) continue;
      add(pivot, rotate(rotation, subtract(positions[i]!, pivot)), positions[i]!);
      multiply(rotation, rotations[i]!, rotations[i]!);
    }
  }

  /** Points every bone of a limb along a direction. */
  point(limb: readonly (number | undefined)[], way: Vec3, least: (bone: number) => number): void {
    const { positions } = this.pose;
    for (let i = 0; i + 1 < limb.length; i++) {
      const [from, to] = [limb[i], limb[i + 1]];
      if (from === undefined || to === undefined) continue;
      const bone = subtract(positions[to]!, positions[from]!);
      if (!(length(bone) > 0) || dot(normalise(bone, zero), way) > least(i)) continue;
      this.turn(from, rotationBetween(normalise(bone, zero), way));
    }
  }
}

/**
 * Returns the axis about which an elbow bends, in the forearm's axes at rest; null: the elbow is straight in all
 * frames. It points down in T-pose on the left, up on the right.
 */
function hingeOf(file: ImportedMotion, joints: BodyJoints, side: Side): Vec3 | null {
  const [shoulder, elbow, hand] = armOf(joints, side);
  const poses = createSkeletonPose(file.names.length);
  const sum = { x: 0, y: 0, z: 0 };
  let count = 0;
  for (const frame of sampledFrames(file.frameCount)) {
    const { positions, rotations } = file.pose(frame, poses);
    const upper = normalise(subtract(positions[elbow]!, positions[shoulder]!), zero);
    const lower = normalise(subtract(positions[hand]!, positions[elbow]!), zero);
    const axis = cross(upper, lower);
    if (length(axis) < bentElbow) continue;
    count += 1;
    add(sum, rotate(conjugate(rotations[elbow]!), axis), sum);
  }
  return count >= 3 && length(sum) > 0.3 * count * bentElbow ? normalise(sum, zero) : null;
}

/**
 * Returns the cosine between a hand and its forearm in a pose, and the directions of both; null: nothing with a length
 * hangs from the hand.
 */
function handIn(
  positions: readonly Vec3[],
  parents: readonly number[],
  [, elbow, hand]: readonly [number, number, number],
): { readonly cosine: number; readonly hand: Vec3; readonly forearm: Vec3 } | null {
  const [from, wrist] = [positions[elbow]!, positions[hand]!];
  const ends = positions.filter((_, i) => parents[i] === hand);
  const sum = ends.reduce((all, end) => add(all, subtract(end, wrist)), zero);
  const forearm = subtract(wrist, from);
  if (!(length(sum) > 0.05 * ends.length * length(forearm))) return null;
  const [way, along] = [normalise(sum, zero), normalise(forearm, zero)];
  return { cosine: dot(way, along), hand: way, forearm: along };
}

/** Turns hands that are bent at rest and not in the motion along their forearms. null: no hand is bent so. */
export function straightHands(
  file: ImportedMotion,
  joints: BodyJoints,
): { readonly pose: SkeletonPose; readonly notes: readonly string[] } | null {
  const { parents } = file;
  const body = new Straightener(file);
  const notes: string[] = [];
  const poses = createSkeletonPose(file.names.length);
  for (const side of sides) {
    const arm = armOf(joints, side);
    const rest = handIn(file.rest, parents, arm);
    if (!rest || rest.cosine > bentHand) continue;
    const cosines = Array.from(
      sampledFrames(file.frameCount, 100),
      (frame) => handIn(file.pose(frame, poses).positions, parents, arm)?.cosine ?? rest.cosine,
    );
    if (median(cosines) - rest.cosine < straighter) continue;
    body.turn(arm[2], rotationBetween(rest.hand, rest.forearm));
    notes.push(`its ${side} hand is bent at rest and not in the motion; it was straightened`);
  }
  return notes.length > 0 ? { pose: body.pose, notes } : null;
}

/**
 * Builds the T-pose of a body whose bones point elsewhere when all angles are zero: each straight limb is turned as a
 * whole, arms to the sides and legs down. The hinge axes of the elbows show the twist of the arms. `notes`: what
 * was assumed, a sentence each.
 */
export function straightRest(
  file: ImportedMotion,
  joints: BodyJoints,
  floor: Quat,
): { readonly pose: SkeletonPose; readonly notes: readonly string[] } {
  const body = new Straightener(file);
  const notes = ['its bones at rest are no T-pose; the T-pose was built from its straight limbs'];
  for (const side of sides) {
    const [shoulder, elbow, hand] = armOf(joints, side);
    const out = outward(floor, side);
    const arm = [joints[`${side}Shoulder`], shoulder, elbow, hand];
    body.point(arm, out, (bone) => (bone === 0 ? clavicleOutward : 0.9999));
    const hinge = hingeOf(file, joints, side);
    if (!hinge) notes.push(`its ${side} elbow never bends; the twist of the arm is assumed`);
    else {
      const turned = reject(rotate(body.pose.rotations[elbow]!, hinge), out);
      const wanted = side === 'left' ? downward(floor) : rotate(fromAxisAngle(out, Math.PI), downward(floor));
      const angle = Math.atan2(dot(cross(turned, wanted), out), dot(turned, wanted));
      body.turn(shoulder, fromAxisAngle(out, angle));
    }
    const leg = (['UpperLeg', 'LowerLeg', 'Foot'] as const).map((part) => joints[`${side}${part}`]);
    body.point(leg, downward(floor), () => straight);
  }
  return { pose: body.pose, notes };
}
