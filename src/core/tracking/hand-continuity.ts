import type { Calibration } from '../body/calibration';
import type { Side } from '../body/joints';
import { type ChestSpaceBody, chestSpaceBody, sideSign } from '../body/skeleton';
import { clamp, evenStep } from '../math/damper';
import { invertTransform, type Pose, type Transform, transformPose } from '../math/pose';
import { conjugate, fromAxes, identity, multiply, type Quat, rotate, slerp } from '../math/quat';
import { add, addScaled, dot, length, lerp, normalise, scale, subtract, type Vec3, vec3 } from '../math/vec3';
import { type BodyHeading, createBodyHeading } from './body-heading';
import { alongArc, directionArc } from './shoulder-arc';
import type { TrackedPose, TrackingFrame } from './tracking-frame';

/** Where a hand is taken to be: always somewhere, whether the device sees it or not. */
export type ContinuedHand = Pose<'floor'> & {
  /** Seen in this frame: `tracked`, neither null nor emulated. */
  readonly seen: boolean;
  /** How much its place is known, in [0, 1]. 1: it is there; 0: it rests, a guess; between: on its way from one to the other. */
  readonly trust: number;
  /** Where it belongs and since when. The place above is on its way there. */
  readonly way: HandWay;
};

/** Where a hand belongs: where it is seen, held for a moment, or rests. */
export interface HandWay {
  readonly goal: Pose<'floor'>;
  /** Whether that is the rest beside the hip, a guess. */
  readonly rests: boolean;
  /** When the hand was sent there [s]; another time is another way. */
  readonly since: number;
  /** So long ago [s]. */
  readonly age: number;
}

/** A tracking frame in which no hand is missing. */
export interface ContinuedFrame {
  readonly time: number;
  readonly head: Pose<'floor'>;
  readonly leftHand: ContinuedHand;
  readonly rightHand: ContinuedHand;
}

/** Holds a hand this long before letting it sink: most losses are shorter. */
const holdSeconds = 0.1;
/** Then it goes to rest in so long [s]: most come back near where they were. */
export const sinkSeconds = 2.5;
/** It is doubted sooner than it rests [s]: nothing hurries after a guess. */
const doubtSeconds = 0.3;
const blendSeconds = 0.2;
/** Mean speed [m/s] of a returning hand on long ways; a quarter faster at most: 4.8 cm in a frame at 60 Hz. */
const returnSpeed = 2.3;

/** A hand about its shoulder, body frame: which way, how far [m], and how it is turned. */
interface Reach {
  readonly direction: Vec3;
  readonly distance: number;
  readonly orientation: Quat;
}

interface HandMemory {
  /** When the hand was last sent to another place: lost for long enough, or seen again. */
  since: number;
  /** As shown last. */
  shown: Reach;
  trust: number;
  /** Where the loss began and when; null while seen. */
  lost: { readonly from: Reach; readonly trust: number; readonly time: number } | null;
  /** What the return has to bridge: shown = seen + offset at `time`, floor frame, so that turning about does not fling it; null when bridged. */
  bridge: {
    readonly offset: Vec3;
    /** How far half-way it goes round the shoulder. */
    readonly detour: Vec3;
    /** From the shoulder [m] where it began: it goes no further out than its ends. */
    readonly distance: number;
    readonly turn: Quat;
    readonly trust: number;
    readonly seconds: number;
    readonly time: number;
  } | null;
}

/** The one place that decides what a lost hand does: hold, sink to rest beside the hip, blend back when it returns. */
export interface HandContinuity {
  follow(frame: TrackingFrame): ContinuedFrame;
  reset(): void;
}

/** From the upright shoulder to the wrist of an arm that hangs: outward, up, forward, in arm lengths; a little bent. */
const hanging = { outward: 0.1, up: -0.93, forward: 0.06 };
/** A wrist rests no lower than this above the floor [eye heights]. */
const lowestRest = 0.06;

/** The shoulder of an upright trunk under a head joint at this height [m], body frame. */
function uprightShoulder(side: Side, headJoint: number, body: ChestSpaceBody): Vec3 {
  return vec3(
    sideSign(side) * (body.clavicleRoot.x + body.clavicle.x),
    headJoint - body.neckToHead.y + body.clavicle.y,
    -body.neckToHead.z + body.clavicle.z,
  );
}

/** A relaxed arm below a head joint at this height [m], body frame: the wrist beside the thigh, the back of the hand outward, fingers down. */
export function restingHand(side: Side, headJoint: number, calibration: Calibration): Pose<'body'> {
  const body = chestSpaceBody(calibration);
  const sigma = sideSign(side);
  const shoulder = uprightShoulder(side, headJoint, body);
  const { outward, up, forward } = hanging;
  const wrist = add(shoulder, scale(vec3(sigma * outward, up, -forward), body.arm));
  return {
    position: { ...wrist, y: Math.max(wrist.y, lowestRest * body.eyeHeight) },
    orientation: fromAxes(vec3(0, 0, sigma), vec3(sigma, 0, 0), vec3(0, 1, 0)),
  };
}

/** Nearer to its shoulder than this [arm lengths] a hand that passes by would whirl its elbow round. */
const clearOfShoulder = 0.5;

/** What to add half-way to a straight way between two places about the shoulder, so that it passes at a distance where both ends keep one. */
function detourAround(from: Vec3, to: Vec3, arm: number, outside: Vec3): Vec3 {
  const way = subtract(to, from);
  const share = clamp(-dot(from, way) / Math.max(dot(way, way), 1e-9), 0, 1);
  const nearest = lerp(from, to, share);
  const wanted = Math.min(clearOfShoulder * arm, length(from), length(to));
  const missing = Math.max(wanted - length(nearest), 0);
  return scale(normalise(addScaled(nearest, outside, 0.2 * missing), outside), missing);
}

/** Whether the hand was missed for longer than it is held. */
const rests = ({ lost }: HandMemory, time: number): boolean => lost !== null && time >= lost.time + holdSeconds;

/** One per avatar; frames in order of time. Before a hand was ever seen it rests. */
export function createHandContinuity(calibration: () => Calibration): HandContinuity {
  const memories: Record<Side, HandMemory | null> = { left: null, right: null };
  const bodyHeading: BodyHeading = createBodyHeading();
  let lastTime: number | null = null;

  function followHand(
    side: Side,
    tracked: TrackedPose | null,
    time: number,
    floorFromBody: Transform<'floor', 'body'>,
    headJoint: number,
    body: ChestSpaceBody,
  ): ContinuedHand {
    const shoulder = uprightShoulder(side, headJoint, body);
    const outside = normalise(vec3(sideSign(side), -0.2, -1));
    const reachOf = ({ position, orientation }: Pose<'body'>): Reach => {
      const way = subtract(position, shoulder);
      return { direction: normalise(way, vec3(0, -1, 0)), distance: length(way), orientation };
    };
    const placeOf = ({ direction, distance }: Reach): Vec3 => scale(direction, distance);
    const rest = reachOf(restingHand(side, headJoint, calibration()));
    const seen = tracked !== null && tracked.tracking === 'tracked';
    const memory = memories[side] ?? {
      since: time,
      shown: rest,
      trust: seen ? 1 : 0,
      lost: seen ? null : { from: rest, trust: 0, time: Number.NEGATIVE_INFINITY },
      bridge: null,
    };
    memories[side] = memory;

    let goal: Pose<'floor'>;
    if (seen) {
      goal = { position: tracked.position, orientation: tracked.orientation };
      const seenInBody = transformPose(invertTransform(floorFromBody), tracked);
      const now = reachOf(seenInBody);
      if (memory.lost) {
        const [place, shownPlace] = [placeOf(now), placeOf(memory.shown)];
        const offset = subtract(shownPlace, place);
        const detour = detourAround(place, shownPlace, body.arm, outside);
        memory.bridge = {
          offset: rotate(floorFromBody.orientation, offset),
          detour: rotate(floorFromBody.orientation, detour),
          distance: memory.shown.distance,
          turn: multiply(conjugate(now.orientation), memory.shown.orientation),
          trust: memory.trust,
          seconds: Math.max(blendSeconds, (length(offset) + 3 * length(detour)) / returnSpeed),
          time,
        };
        memory.since = time;
        memory.lost = null;
      }
      memory.shown = now;
      memory.trust = 1;
      if (memory.bridge) {
        const { offset, detour, distance, turn, trust, seconds, time: since } = memory.bridge;
        const missing = 1 - evenStep(0, seconds, time - since);
        if (missing <= 0) memory.bridge = null;
        memory.trust = 1 + (trust - 1) * missing;
        const aside = addScaled(scale(offset, missing), detour, 4 * missing * (1 - missing));
        const passing = reachOf({
          position: add(seenInBody.position, rotate(conjugate(floorFromBody.orientation), aside)),
          orientation: multiply(now.orientation, slerp(identity, turn, missing)),
        });
        memory.shown = { ...passing, distance: Math.min(passing.distance, Math.max(distance, now.distance)) };
      }
    } else {
      // On its way back it stops, elsewhere than where it was to go.
      if (memory.bridge) memory.since = time;
      memory.bridge = null;
      memory.lost ??= { from: memory.shown, trust: memory.trust, time };
      const { from, trust, time: since } = memory.lost;
      const arc = directionArc(from.direction, rest.direction, outside);
      const age = Math.min(time - since, 1e6);
      const share = evenStep(holdSeconds, holdSeconds + sinkSeconds, age);
      memory.trust = trust * (1 - evenStep(holdSeconds, holdSeconds + doubtSeconds, age));
      memory.shown = {
        direction: rotate(alongArc(arc, share), from.direction),
        distance: from.distance + (rest.distance - from.distance) * share,
        orientation: slerp(from.orientation, rest.orientation, share),
      };
      if (time >= since + holdSeconds) memory.since = Math.max(memory.since, since + holdSeconds);
      const belongs = rests(memory, time) ? rest : from;
      goal = transformPose(floorFromBody, {
        position: add(shoulder, placeOf(belongs)),
        orientation: belongs.orientation,
      });
    }
    const way = { goal, rests: rests(memory, time), since: memory.since, age: time - memory.since };
    if (seen && !memory.bridge) return { ...goal, seen, trust: 1, way };
    const { orientation } = memory.shown;
    const pose = transformPose(floorFromBody, { position: add(shoulder, placeOf(memory.shown)), orientation });
    return { ...pose, seen, trust: memory.trust, way };
  }

  return {
    follow({ time, head, leftHand, rightHand }) {
      const body = chestSpaceBody(calibration());
      const headJoint = subtract(head.position, rotate(head.orientation, body.eyesInHead));
      const floorFromBody: Transform<'floor', 'body'> = {
        position: { ...headJoint, y: 0 },
        orientation: bodyHeading.follow(head.orientation, lastTime === null ? 0 : time - lastTime),
      };
      lastTime = time;
      return {
        time,
        head,
        leftHand: followHand('left', leftHand, time, floorFromBody, headJoint.y, body),
        rightHand: followHand('right', rightHand, time, floorFromBody, headJoint.y, body),
      };
    },
    reset() {
      memories.left = null;
      memories.right = null;
      bodyHeading.reset();
      lastTime = null;
    },
  };
}
