import { sideSign } from '../body/skeleton';
import {
  alignDirections,
  angleBetween,
  conjugate,
  fromAxisAngle,
  identity,
  multiply,
  type Quat,
  restDirections,
  rotate,
  rotationBetween,
  twistAngle,
  twistOf,
} from '../math/quat';
import { type Side, sides } from '../math/side';
import { parentsFirst } from '../math/tree';
import { add, dot, down, normalise, right, scale, subtract, up, zero } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion, type SkeletonPose } from '../motion/imported-motion';
import { type BodyJoints, bodyFloor, defaultFloor, standing, trunkDirection, turnBetween, upAtRest } from './body-axes';
import { armOf, bodyTree, level, ObservedBody, spineOf } from './observed-body';
import { meanRotation } from './observed-rotations';
import { directions } from './read-skeleton-map';
import { armFault, type RestJoints } from './rest-joints';
import {
  asRightAngle,
  isTurnedBy,
  largestLean,
  largestYaw,
  majority,
  nearestRightAngle,
  sharedRest,
} from './right-angles';
import { truthJoints } from './skeleton-map';

/** The largest angle of a hand, and of an arm whose elbow bends forward, against a right angle [rad]. */
const rightHand = 0.75;
const rightArm = 0.65;
/** The largest turn about the vertical [rad] of a joint of the trunk against its rest where the motion is clear. */
const clearYaw = 0.7;
/** The largest mean bend of a hand against its forearm at rest, and the largest mean twist [rad]. */
const largestBend = 1.05;
const largestPronation = 1.4;
/** The cosine between a hand and its forearm above which it is straight but for its mean bend. */
const straightHand = 0.7;
/** The largest twist between an arm at rest and one whose elbow bends forward [rad]. */
const largestTwist = 2.1;
/** The smallest cosine between the axes of an elbow in its two bones at rest. */
const sameHinge = 0.5;

/** The T-pose of a body in its file’s axes, and how it was found. */
export interface TPose {
  readonly pose: SkeletonPose;
  /** The rotation from the file’s axes to the floor frame. */
  readonly floor: Quat;
  /** How sure head and hands are, from 0 to 1: 1 where the file states its T-pose, at rest or in a frame. */
  readonly sureness: number;
  /** What was assumed, a sentence each. */
  readonly notes: readonly string[];
}

/** Returns the joints at rest, rotated, by their names. */
const restTurned = ({ file, joints }: ObservedBody, turn: Quat): RestJoints =>
  new Map(
    truthJoints.flatMap((joint) =>
      joints[joint] === undefined ? [] : [[joint, rotate(turn, file.rest[joints[joint]]!)]],
    ),
  );

/** Returns the rotation to the floor of a rest in which a person stands; null: it is none. */
function standingRest(body: ObservedBody): Quat | null {
  const { file, joints } = body;
  const above = upAtRest(file.rest, joints);
  const turn = above && bodyFloor(file.rest, joints, directions[above]);
  if (!turn) return null;
  const { turn: right } = nearestRightAngle(turn);
  const rest = restTurned(body, right);
  const isAcross = (part: 'UpperArm' | 'UpperLeg'): boolean => {
    const [left, other] = [rest.get(`left${part}`), rest.get(`right${part}`)];
    return !left || !other || normalise(subtract(other, left), zero).x > level;
  };
  const stands = isAcross('UpperArm') && isAcross('UpperLeg') && sides.every((side) => armFault(rest, side) === null);
  return stands ? right : null;
}

/** Returns the rotation in which the trunk at rest stands and faces ahead, by the joints that it carries. */
function trunkAtRest({ file, joints }: ObservedBody): Quat | null {
  const {
    hips,
    neck,
    leftUpperArm,
    rightUpperArm,
    leftShoulder = leftUpperArm,
    rightShoulder = rightUpperArm,
  } = joints;
  const trunk = { hips, neck, leftUpperArm: leftShoulder!, rightUpperArm: rightShoulder! };
  return bodyFloor(file.rest, trunk, trunkDirection(file.rest, joints));
}

/** Finds how the joints of a body are rotated in T-pose, each against the floor frame. */
class TPoseFinder {
  readonly notes: string[] = [];
  readonly #trunk: readonly number[];
  /** The rotation of a rest in which a person stands. */
  readonly #standing: Quat | null;
  /** That rotation, or the one that most joints of the trunk share. */
  readonly shared: Quat | null;
  /** Whether joints take the right angle that is next: the file has right angles, and no frame shows its T-pose. */
  readonly #snaps: boolean;
  sureness = 1;
  /** The parts of the body that do not rest as in T-pose. */
  readonly changed = new Set<string>();

  constructor(readonly body: ObservedBody) {
    const { file, joints } = body;
    const spine = spineOf(file, joints);
    const clavicles = sides.flatMap((side) => joints[`${side}Shoulder`] ?? []);
    this.#trunk = [...new Set([...spine, ...clavicles])];
    const means = this.#trunk.map((joint) => body.mean(joint));
    this.#standing = standingRest(body);
    const stands = trunkAtRest(body);
    this.shared = this.#standing ?? (stands && sharedRest(means.slice(0, spine.length), stands));
    const right = means.filter((mean) => asRightAngle(mean) !== null);
    this.#snaps = !body.posed && (this.shared !== null || right.length > majority * means.length);
  }

  /** Returns the rotations of the joints of the trunk, each judged against the joint that carries it. */
  #ofTrunk(): Map<number, Quat> {
    const { file } = this.body;
    const found = new Map<number, Quat>();
    for (const joint of parentsFirst(file.parents).filter((each) => this.#trunk.includes(each))) {
      const carrier = found.get(file.parents[joint]!);
      // The mean posture of what carries the joint is no posture of its own.
      const upright = carrier ? multiply(carrier, conjugate(this.body.mean(file.parents[joint]!))) : identity;
      const mean = multiply(upright, this.body.mean(joint));
      found.set(joint, this.#restNear(joint, mean) ?? mean);
    }
    return found;
  }

  /** Returns the rotation of a joint of the trunk that its file states or suggests; null: its mean is another one. */
  #restNear(joint: number, mean: Quat): Quat | null {
    const sure = this.body.sure(joint);
    const yaw = largestYaw + sure * (clearYaw - largestYaw);
    const isHead = joint === this.body.joints.head;
    // The places of the joints of a standing rest show how the trunk leans.
    const lean = this.#standing && !isHead ? Math.PI : largestLean;
    if (this.shared && isTurnedBy(mean, this.shared, yaw, lean)) return this.shared;
    // Heads look aside and down: theirs is the next right angle, however far.
    const right = this.#snaps ? asRightAngle(mean, isHead ? Math.PI : undefined) : null;
    this.changed.add(isHead ? 'head' : 'trunk');
    if (isHead && !right) this.sureness = Math.min(this.sureness, sure);
    return right;
  }

  /** Returns the rotation of upper arm or forearm in T-pose: its bone to the side, its elbow bending forward. */
  #ofArm(side: Side, joint: number, end: number): Quat {
    const out = scale(right, sideSign(side));
    const hinge = this.body.hinge(joint, armOf(this.body.joints, side));
    if (!hinge) return this.body.pointing(joint, end, out);
    const wanted = side === 'left' ? down : up;
    const found = alignDirections(restDirections(this.body.bone(joint, end), hinge), out, wanted);
    return (this.#snaps && asRightAngle(found, rightArm)) || found;
  }

  /** Returns the rotations of an arm at rest where it is a T-pose’s; null: it is not. */
  #armAtRest(side: Side): Quat | null {
    const { shared } = this;
    const { joints } = this.body;
    if (!shared) return null;
    const [shoulder, elbow, hand] = armOf(joints, side);
    if (armFault(restTurned(this.body, shared), side)) return null;
    const hinges = [shoulder, elbow].map((joint) => this.body.hinge(joint, [shoulder, elbow, hand]));
    if (!hinges[0] || !hinges[1]) return shared;
    const way = rotate(shared, this.body.bone(elbow, hand));
    const raised = multiply(rotationBetween(way, scale(right, sideSign(side))), shared);
    const twist = angleBetween(raised, this.#ofArm(side, elbow, hand));
    // At rest a hinge has one axis in both of its bones.
    return twist < largestTwist && dot(hinges[0], hinges[1]) > sameHinge ? shared : null;
  }

  /** Returns whether a hand mostly is on its forearm as at rest. */
  #isHandAtRest(side: Side): boolean {
    const [, elbow, hand] = armOf(this.body.joints, side);
    const mean = meanRotation(this.body.against(hand, elbow));
    const twist = twistOf(mean, this.body.bone(elbow, hand));
    return angleBetween(twist, identity) < largestPronation && angleBetween(twist, mean) < largestBend;
  }

  /** Returns the rotation of a hand in T-pose on a forearm in T-pose. */
  #ofHand(side: Side, forearm: Quat): Quat {
    // Rests are symmetric: where one hand is as at rest, the motion bends the other one.
    if (this.shared && sides.some((each) => this.#isHandAtRest(each))) return forearm;
    const [, elbow, hand] = armOf(this.body.joints, side);
    const mean = meanRotation(this.body.against(hand, elbow));
    this.changed.add(`${side} hand`);
    const right = this.#snaps ? asRightAngle(mean, rightHand) : null;
    if (!right) this.sureness = Math.min(this.sureness, this.body.sure(hand, elbow));
    const turned = multiply(forearm, right ?? mean);
    const way = this.body.handWay(hand);
    if (!way) return turned;
    const [along, out] = [rotate(turned, way), rotate(forearm, this.body.bone(elbow, hand))];
    return dot(along, out) > straightHand ? multiply(rotationBetween(along, out), turned) : turned;
  }

  /** Writes the rotations of an arm. */
  #poseArm(side: Side, rotations: Map<number, Quat>): void {
    const [shoulder, elbow, hand] = armOf(this.body.joints, side);
    const rest = this.#armAtRest(side);
    if (!rest) {
      this.changed.add(`${side} arm`);
      if (!this.body.posed && !this.body.hinge(elbow, armOf(this.body.joints, side)))
        this.notes.push(`its ${side} elbow never bends; the twist of the arm is assumed`);
    }
    const forearm = rest ?? this.#ofArm(side, elbow, hand);
    rotations.set(shoulder, rest ?? this.#ofArm(side, shoulder, elbow));
    rotations.set(elbow, forearm);
    rotations.set(hand, this.#ofHand(side, forearm));
  }

  /** Writes the rotations of a leg. */
  #poseLeg(side: Side, rotations: Map<number, Quat>): void {
    const { shared } = this;
    const { joints, file } = this.body;
    const [hip, knee, foot] = (['UpperLeg', 'LowerLeg', 'Foot'] as const).map((part) => joints[`${side}${part}`]);
    if (hip === undefined || knee === undefined || foot === undefined) return;
    const way = normalise(subtract(file.rest[foot]!, file.rest[hip]!), zero);
    if (shared && dot(rotate(shared, way), down) > standing) return;
    this.changed.add(`${side} leg`);
    rotations.set(hip, this.body.pointing(hip, knee, down));
    rotations.set(knee, this.body.pointing(knee, foot, down));
    rotations.set(foot, this.body.mean(foot));
  }

  /** Returns the rotation of every joint of the file from its rest to the T-pose in the floor frame. */
  rotations(): readonly Quat[] {
    const { shared } = this;
    const { joints, file } = this.body;
    const found = this.#ofTrunk();
    for (const side of sides) {
      this.#poseArm(side, found);
      this.#poseLeg(side, found);
    }
    const tree = bodyTree(file, joints);
    const all: Quat[] = file.names.map(() => identity);
    for (const joint of parentsFirst(file.parents)) {
      const parent = file.parents[joint]!;
      const carried = parent < 0 ? (shared ?? this.body.mean(joint)) : all[parent]!;
      // Joints between those of the body may have any axes, too.
      const between = parent >= 0 && !shared && tree.has(joint);
      all[joint] =
        found.get(joint) ?? (between ? multiply(carried, meanRotation(this.body.against(joint, parent))) : carried);
    }
    return all;
  }

  /** Returns the rotation from the file’s axes to the floor: it faces as the rest does if that is a T-pose. */
  floor(): Quat {
    const { shared, changed } = this;
    const usual = multiply(defaultFloor, turnBetween(this.body.above, '+y'));
    if (!shared || [...changed].some((part) => /arm|leg/.test(part))) return usual;
    const since = multiply(shared, conjugate(usual));
    const yaw = fromAxisAngle(up, twistAngle(since, up));
    return angleBetween(yaw, since) < largestLean ? multiply(yaw, usual) : usual;
  }
}

/** Returns the joints of a file at rest whose joints have these rotations in its axes. */
function poseOf({ parents, rest, names }: ImportedMotion, rotations: readonly Quat[]): SkeletonPose {
  const pose = createSkeletonPose(names.length);
  for (const joint of parentsFirst(parents)) {
    Object.assign(pose.rotations[joint]!, rotations[joint]);
    const parent = parents[joint]!;
    if (parent < 0) continue;
    const offset = rotate(rotations[parent]!, subtract(rest[joint]!, rest[parent]!));
    add(pose.positions[parent]!, offset, pose.positions[joint]!);
  }
  return pose;
}

/** Returns what was assumed of the axes, a sentence each. */
function axisNotes({ file, joints, above }: ObservedBody, shared: Quat | null, floor: Quat): readonly string[] {
  const atRest = upAtRest(file.rest, joints) ?? '+y';
  if (atRest !== above)
    return [`the person would lie in most frames; the axis that makes them stand was taken as up (${above})`];
  const { ahead } = nearestRightAngle(floor);
  return shared && (above !== '+y' || ahead !== '+z') ? [`it rests with ${above} up, facing ${ahead}`] : [];
}

/**
 * Finds the T-pose of a body in the frames of its motion: gravity gives its vertical, hips and shoulders its heading,
 * the elbows the twist of its arms, and the mean rotations of trunk, head and hands their axes. Joints whose rest
 * agrees with the frames, or is at right angles to them, keep that exactly. A first frame in T-pose stands for all.
 * Throws a sentence where left and right lie on each other.
 */
export function findTPose(file: ImportedMotion, joints: BodyJoints): TPose {
  const body = new ObservedBody(file, joints);
  const finder = new TPoseFinder(body);
  const rotations = finder.rotations();
  const floor = finder.floor();
  const toFile = conjugate(floor);
  const notes = [...axisNotes(body, finder.shared, floor), ...finder.notes];
  if (finder.changed.size > 0) {
    const source = body.posed ? 'that of its first frame was taken' : 'it was estimated from the motion';
    const sure = finder.sureness < 1 ? `, ${finder.sureness.toFixed(2)} of 1 sure` : '';
    notes.push(`its rest pose is not a T-pose; ${source} (${[...finder.changed].join(', ')}${sure})`);
    if (sure) notes.push('gaze and hands are taken to be straight on average; most motions bend them by 5° to 30°');
  }
  const pose = poseOf(
    file,
    rotations.map((rotation) => multiply(toFile, rotation)),
  );
  return { pose, floor, sureness: finder.sureness, notes };
}
