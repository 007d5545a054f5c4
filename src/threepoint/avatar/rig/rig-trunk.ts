import type { Vector3 } from 'three';
import type { JointPoses, MutableJointPoses } from '../../core/body/forward-kinematics';
import type { JointName } from '../../core/body/joints';
import { clamp } from '../../core/math/damper';
import { multiply, quat, rotate, rotationBetween } from '../../core/math/quat';
import type { Side } from '../../core/math/side';
import {
  add,
  addScaled,
  copyVec3,
  distance,
  dot,
  lerp,
  type MutableVec3,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from '../../core/math/vec3';
import type { Rig } from './rig';

/** The largest change of an upper arm's length [fraction] before the shoulder joint moves. */
const armGives = 0.06;
/** The least length of a rig's trunk between the body's hips and head [fraction of its own]; see `hipsFraction`. */
const leastTrunk = 0.6;
/** The base of a missing neck bone, from the middle of the shoulders to the head [fraction]. */
const neckFraction = 0.3;
/** The base of a missing clavicle bone, from the neck to the shoulder [fraction]. */
const clavicleFraction = 0.2;

/** A vertebra of the rig, with its offset from the one below at rest, scaled to the body [m]. */
interface Link {
  readonly name: JointName;
  readonly below: JointName;
  readonly offset: MutableVec3;
  /** The fraction of the chain's error that is added to this joint: 1 at the neck. */
  fraction: number;
}

interface Shoulder {
  readonly clavicle: 'leftShoulder' | 'rightShoulder';
  readonly upperArm: 'leftUpperArm' | 'rightUpperArm';
  readonly lowerArm: 'leftLowerArm' | 'rightLowerArm';
  /**
   * The offset from the neck joint to the base of the clavicle in the chest's frame, and along the clavicle in its own
   * frame [m].
   */
  readonly root: MutableVec3;
  readonly along: MutableVec3;
}

const makeShoulder = (side: Side): Shoulder => ({
  clavicle: `${side}Shoulder`,
  upperArm: `${side}UpperArm`,
  lowerArm: `${side}LowerArm`,
  root: vec3(0, 0, 0),
  along: vec3(0, 0, 0),
});

// Scratch variables of one call.
const neck = vec3(0, 0, 0);
const missed = vec3(0, 0, 0);
const root = vec3(0, 0, 0);
const own = vec3(0, 0, 0);
const given = vec3(0, 0, 0);
const before = vec3(0, 0, 0);
const after = vec3(0, 0, 0);
const swing = quat(0, 0, 0, 1);

/**
 * Returns how far the shoulder joint must move from the rig's position to the estimated one, until its distance from
 * the elbow is within `least` to `most` [m]; a fraction.
 */
function shoulderShift(from: Vec3, to: Vec3, elbow: Vec3, least: number, most: number): number {
  const far = distance(from, elbow);
  if (far >= least && far <= most) return 0;
  const bound = far > most ? most : least;
  subtract(to, from, before);
  subtract(from, elbow, after);
  const a = dot(before, before);
  const h = dot(before, after);
  const root = Math.sqrt(Math.max(0, h * h - a * (far * far - bound * bound)));
  return clamp((far > most ? -h - root : -h + root) / Math.max(a, 1e-12), 0, 1);
}

/**
 * Adapts the trunk of a pose to a rig with other proportions than the estimated body: the rig keeps its neck, its
 * shoulders and the proportions of its spine. Head, elbows and hands stay where they were estimated, and so does the
 * pelvis, unless the rig's legs are very short. If an arm cannot reach its elbow, the shoulder joint moves.
 */
export class RigTrunk {
  private readonly links: Link[] = [];
  private readonly neckToHead = vec3(0, 0, 0);
  private readonly shoulders = [makeShoulder('left'), makeShoulder('right')];
  /** The position of the neck at the end of the chain of vertebrae. */
  private readonly reached = vec3(0, 0, 0);
  private readonly neckOffset = vec3(0, 0, 0);
  private topVertebra: JointName = 'hips';
  /**
   * The height of the rig's hips [fraction of the body's]: 1, or the rig's own where its legs are so short that its
   * trunk would have to be squeezed to less than `leastTrunk`.
   */
  hipsFraction = 1;

  constructor(private readonly rig: Rig) {
    let below: JointName = 'hips';
    for (const name of ['spine', 'chest', 'upperChest'] as const) {
      if (!rig.rest(name)) continue;
      this.links.push({ name, below, offset: vec3(0, 0, 0), fraction: 0 });
      below = name;
    }
    this.topVertebra = below;
  }

  /** Measures the rig, scaled by `scale`, for a body in this T-pose. */
  fit(tPose: JointPoses, scale: number): void {
    const { rig } = this;
    /** Transforms a joint of the rig at rest (facing +Z) to the T-pose facing −Z [m]. */
    const at = ({ x, y, z }: Vector3): MutableVec3 => vec3(-x * scale, y * scale, -z * scale);
    const rest = (name: JointName): MutableVec3 | null => {
      const place = rig.rest(name);
      return place && at(place);
    };
    const [hips, head, left, right] = [rest('hips'), rest('head'), rest('leftUpperArm'), rest('rightUpperArm')];
    if (!hips || !head || !left || !right) throw new Error('avatar/rig-trunk: a rig without hips, head or arms');
    const restNeck = rest('neck') ?? lerp(lerp(left, right, 0.5), head, neckFraction);
    subtract(head, restNeck, this.neckToHead);
    // The spine is scaled to the distance from pelvis to head; its joints keep their proportions.
    const hipsHeight = tPose.hips.position.y;
    const top = tPose.head.position.y - this.neckToHead.y;
    this.hipsFraction = top - hipsHeight < leastTrunk * (restNeck.y - hips.y) ? hips.y / hipsHeight : 1;
    const wanted = top - hipsHeight * this.hipsFraction;
    const fraction = Math.max(0.2, wanted / Math.max(1e-3, restNeck.y - hips.y));
    let below = hips;
    for (const link of this.links) {
      const joint = rest(link.name) ?? below;
      subtract(joint, below, link.offset);
      setVec3(link.offset, link.offset.x, link.offset.y * fraction, link.offset.z);
      link.fraction = clamp((joint.y - hips.y) / Math.max(1e-3, restNeck.y - hips.y), 0, 1);
      below = joint;
    }
    subtract(restNeck, below, this.neckOffset);
    setVec3(this.neckOffset, this.neckOffset.x, this.neckOffset.y * fraction, this.neckOffset.z);
    for (const { clavicle, upperArm, root, along } of this.shoulders) {
      const tip = upperArm === 'leftUpperArm' ? left : right;
      const begin = rest(clavicle) ?? lerp(restNeck, tip, clavicleFraction);
      subtract(begin, restNeck, root);
      subtract(tip, begin, along);
    }
  }

  /** Moves the joints of a pose, floor frame, to the positions for this rig. */
  apply(joints: MutableJointPoses): void {
    const { position: hips } = joints.hips;
    setVec3(hips, hips.x, hips.y * this.hipsFraction, hips.z);
    subtract(joints.head.position, rotate(joints.neck.orientation, this.neckToHead, neck), neck);
    for (const { name, below, offset } of this.links) {
      const from = joints[below];
      const { position } = joints[name];
      add(from.position, rotate(from.orientation, offset, position), position);
    }
    const top = joints[this.topVertebra];
    add(top.position, rotate(top.orientation, this.neckOffset, this.reached), this.reached);
    subtract(neck, this.reached, missed);
    for (const { name, fraction } of this.links)
      addScaled(joints[name].position, missed, fraction, joints[name].position);
    copyVec3(neck, joints.neck.position);
    for (const shoulder of this.shoulders) this.applyShoulder(shoulder, joints);
  }

  private applyShoulder(
    { clavicle, upperArm, lowerArm, root: fromNeck, along }: Shoulder,
    joints: MutableJointPoses,
  ): void {
    const collar = joints[clavicle];
    const arm = joints[upperArm];
    const elbow = joints[lowerArm].position;
    copyVec3(arm.position, given);
    add(neck, rotate(joints.upperChest.orientation, fromNeck, root), root);
    add(root, rotate(collar.orientation, along, own), own);
    const long = distance(given, elbow);
    const give = shoulderShift(own, given, elbow, long * (1 - armGives), long * (1 + armGives));
    lerp(own, given, give, arm.position);
    copyVec3(root, collar.position);
    if (give > 0) {
      rotationBetween(subtract(own, root, before), subtract(arm.position, root, after), swing);
      multiply(swing, collar.orientation, collar.orientation);
    }
    rotationBetween(subtract(elbow, given, before), subtract(elbow, arm.position, after), swing);
    multiply(swing, arm.orientation, arm.orientation);
    this.rig.reach(upperArm, distance(arm.position, elbow));
  }
}
