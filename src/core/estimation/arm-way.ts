import { bisect } from '../math/bisection';
import { clamp, smoothstep } from '../math/damper';
import { between, rotate } from '../math/quat';
import { addScaled, cross, distance, lerp, normalise, subtract, type Vec3 } from '../math/vec3';
import { type HandWay, sinkSeconds } from '../tracking/hand-continuity';
import { alongArc, directionArc } from '../tracking/shoulder-arc';

/** An arm as it hangs in this frame: its shoulder, floor frame, and the lengths [m] of its bones. */
export interface Arm {
  readonly shoulder: Vec3;
  readonly upperArm: number;
  readonly forearm: number;
}

/** The directions of an arm's bones, unit, and of the elbow's hinge, floor frame: who whirls about does not fling an arm on its way. */
export interface DrawnArm {
  readonly upperArm: Vec3;
  readonly forearm: Vec3;
  readonly hinge: Vec3;
}

type Bones = Pick<DrawnArm, 'upperArm' | 'forearm'>;

/** Floor frame. */
interface ElbowAndWrist {
  readonly elbow: Vec3;
  readonly wrist: Vec3;
}

/** An arm that is not yet where its hand belongs. */
export interface ArmWay {
  /** Where elbow and wrist belonged in the frame before, floor frame; null: it sets out. */
  readonly goal: ElbowAndWrist | null;
  /** To rest, rather than back to a hand that is seen. */
  readonly rests: boolean;
  /** The furthest [m] that it was away, and the share of that which is left. */
  readonly metres: number;
  readonly left: number;
  /** Beyond what its goal moves by itself [m/s]. */
  readonly speed: number;
}

/** What an arm remembers of its ways. */
export interface ArmCourse {
  /** As it was drawn, and where. */
  readonly drawn: DrawnArm;
  readonly joints: ElbowAndWrist;
  /** When its hand was sent where it belongs now [s]; null: nobody sent it. */
  readonly since: number | null;
  /** Null: it is where it belongs. */
  readonly way: ArmWay | null;
}

/** A way back takes about so long [s] at least. */
const returnSeconds = 0.2;
/** A way goes at most this fast [m/s]: 2.8 and 3.75 cm in a frame at 60 Hz. */
const [restSpeed, returnSpeed] = [1.7, 2.25];
/** The share of the shortest time in which it gets up to its speed, and down from it. */
const wayRamp = 0.2;
/** So long [s] after a hand is seen again its arm begins to hurry, if it is not there yet, and is there at the latest: no measured way took more than 0.52 s. */
const [hurrySeconds, latestSeconds] = [0.7, 0.9];
/** A way is measured in so many steps. */
const waySteps = 8;
/** Ways longer than the first [m] begin to hold back the elbow of a hand that hurries on; from the second on it goes this share of its way less. */
const [freeElbow, heldElbow] = [0.05, 0.4];
const heldShare = 0.66;
/** So near to its reach [arm lengths] an arm whose hand is a guess begins to stay bent; on a way back in the share that is left. */
const softBend = 0.06;

/** The way that an arm is on in this frame: a new one where its hand was sent elsewhere; null: none, or nobody knows where from. */
export function wayOf(before: ArmCourse | null, sent: HandWay | undefined): ArmWay | null {
  if (!before || !sent) return null;
  return before.since === sent.since ? before.way : { goal: null, rests: sent.rests, metres: 0, left: 1, speed: 0 };
}

/** The place [m, floor frame] to reach for: nearer than where the hand was sent as that comes near the arm's reach, so that no arm snaps straight. */
export function softTarget({ shoulder, upperArm, forearm }: Arm, sent: HandWay, way: ArmWay | null): Vec3 {
  const place = sent.goal.position;
  const left = way?.left ?? 0;
  const soft = softBend * (sent.rests ? 1 : left * left);
  const arm = upperArm + forearm;
  const far = distance(shoulder, place);
  const near = arm * (1 - soft);
  if (soft <= 0 || far <= near) return place;
  const reach = arm - soft * arm * Math.exp((near - far) / (soft * arm));
  return addScaled(shoulder, subtract(place, shoulder), reach / far);
}

/** Elbow and wrist of an arm whose bones point these ways, floor frame. */
export function jointsOf(arm: Arm, bones: Bones): ElbowAndWrist {
  const elbow = addScaled(arm.shoulder, bones.upperArm, arm.upperArm);
  return { elbow, wrist: addScaled(elbow, bones.forearm, arm.forearm) };
}

/**
 * One frame of an arm's way from where it was drawn to where its hand belongs, along arcs about shoulder and elbow. Neither elbow nor
 * wrist goes further than the hand's goal itself went in this frame and what the way's speed allows beyond that. `outside`: by where an
 * arm swings that goes all the way round, unit, floor frame.
 */
export function goOn(
  before: ArmCourse,
  way: ArmWay,
  to: DrawnArm,
  sent: HandWay,
  arm: Arm,
  outside: Vec3,
  deltaSeconds: number,
): { readonly drawn: DrawnArm; readonly way: ArmWay | null } {
  const at = bonesBetween(before.drawn, to, outside);
  const toGo = furthestWay(arm, at);
  const metres = Math.max(way.metres, toGo);
  const speed = speedOf(way, metres, toGo, deltaSeconds);
  const beyond = speed * Math.max(deltaSeconds, 0) + hurryOf(way, metres, sent.age);
  // What the hand itself went, not what an arm that does not reach it goes with its shoulder.
  const goal = { elbow: jointsOf(arm, to).elbow, wrist: sent.goal.position };
  const limits = limitsOf(before, way, goal, jointsOf(arm, at(0)), metres, beyond);
  /** By how much [m] this share of the way would be too far for one frame. */
  const excess = (share: number): number => {
    const next = jointsOf(arm, at(share));
    return Math.max(
      distance(before.joints.elbow, next.elbow) - limits.elbow,
      distance(before.joints.wrist, next.wrist) - limits.wrist,
    );
  };
  const share = furthestWithin(excess);
  // There for a second frame, so that nothing softens its reach any more; but no sooner than a return takes, lest it snap straight. How far
  // it went there does not tell: an arm that keeps up with a quick hand goes as far in every frame.
  if (share === 1 && way.left === 0 && sent.age >= shortestOf(way)) return { drawn: to, way: null };
  const next = at(share);
  const left = (toGo * (1 - share)) / Math.max(metres, 1e-9);
  const unbent = lerp(to.hinge, rotate(between(before.drawn.upperArm, next.upperArm), before.drawn.hinge), left);
  return {
    drawn: { ...next, hinge: normalise(addScaled(cross(next.upperArm, next.forearm), unbent, 0.1), to.hinge) },
    way: { ...way, goal, metres, left, speed },
  };
}

/** An arm's bones at a share in [0, 1] of the arcs from one arm to another. */
function bonesBetween(from: DrawnArm, to: DrawnArm, outside: Vec3): (share: number) => Bones {
  const upperArm = directionArc(from.upperArm, to.upperArm, outside);
  const forearm = directionArc(from.forearm, to.forearm, outside);
  return (share) => ({
    upperArm: rotate(alongArc(upperArm, share), from.upperArm),
    forearm: rotate(alongArc(forearm, share), from.forearm),
  });
}

/** How far [m] elbow or wrist have to go, whichever has more of it. */
function furthestWay(arm: Arm, at: (share: number) => Bones): number {
  const places = Array.from({ length: waySteps + 1 }, (_, step) => jointsOf(arm, at(step / waySteps)));
  const metresOf = (joint: keyof ElbowAndWrist): number =>
    places.reduce((sum, next, step) => sum + distance(next[joint], (places[step - 1] ?? next)[joint]), 0);
  return Math.max(metresOf('elbow'), metresOf('wrist'));
}

const shortestOf = ({ rests }: ArmWay): number => (rests ? sinkSeconds : returnSeconds);

/** Up to the way's top speed [m/s] evenly, and evenly down to a stand at its end. */
function speedOf(way: ArmWay, metres: number, toGo: number, deltaSeconds: number): number {
  const shortest = shortestOf(way);
  const top = Math.min(way.rests ? restSpeed : returnSpeed, metres / (shortest * (1 - wayRamp)));
  const acceleration = top / (shortest * wayRamp);
  return Math.min(way.speed + acceleration * deltaSeconds, top, Math.sqrt(2 * acceleration * toGo));
}

/** How much further [m] an arm goes in one frame whose hand has been seen again for `age` [s]: at last as far as there is to go. */
function hurryOf({ rests }: ArmWay, metres: number, age: number): number {
  const late = rests ? 0 : clamp((age - hurrySeconds) / (latestSeconds - hurrySeconds), 0, 1);
  return (Math.max(metres, 1e-9) * late ** 2) / (1 - late);
}

/** How far [m] elbow and wrist may go in this frame: as far as the goal went and so far beyond it, the elbow on long ways less. */
function limitsOf(
  before: ArmCourse,
  way: ArmWay,
  goal: ElbowAndWrist,
  carried: ElbowAndWrist,
  metres: number,
  beyond: number,
): Readonly<Record<keyof ElbowAndWrist, number>> {
  const went = (joint: keyof ElbowAndWrist): number =>
    way.goal ? distance(way.goal[joint], goal[joint]) : distance(before.joints[joint], carried[joint]);
  const wrist = went('wrist');
  const behind = 1 - heldShare * smoothstep(freeElbow, heldElbow, metres);
  return { wrist: beyond + wrist, elbow: beyond + Math.min(went('elbow'), behind * wrist) };
}

/** The largest share in [0, 1] that does not exceed what is allowed; where every one does, the one that does so least. */
function furthestWithin(excess: (share: number) => number): number {
  if (excess(1) <= 0) return 1;
  let best = { share: 0, excess: excess(0) };
  for (let step = 1; step < waySteps; step++) {
    const now = { share: step / waySteps, excess: excess(step / waySteps) };
    if (now.excess <= 0 || now.excess < best.excess) best = now;
  }
  if (best.excess > 0) return best.share;
  return bisect(best.share, best.share + 1 / waySteps, (share) => excess(share) > 0, 6)[0];
}
