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
  /** Present while it is not simply where it is seen or held. */
  readonly way?: HandWay;
};

/** A way from where an arm is drawn to where its hand belongs. */
export interface HandWay {
  /** Where the hand is seen, or rests. */
  readonly goal: Pose<'floor'>;
  /** The share of the way still to go: 1 at its beginning, 0 at the goal. */
  readonly left: number;
  /** When it began [s]; another time is another way. */
  readonly since: number;
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
const easeSeconds = 0.3;
const blendSeconds = 0.2;
/** Mean speed [m/s] of a returning or sinking hand on long ways; a quarter faster at most: 3.9 cm in a frame at 60 Hz. */
const easeSpeed = 1.8;

/** A hand about its shoulder, body frame: which way, how far [m], and how it is turned. */
interface Reach {
  readonly direction: Vec3;
  readonly distance: number;
  readonly orientation: Quat;
}

interface HandMemory {
  /** As shown last. */
  shown: Reach;
  trust: number;
  /** Where the loss began and when, and when the way to rest begins; null while seen. */
  lost: { readonly from: Reach; readonly trust: number; readonly time: number; readonly departs: number } | null;
  /** What the return has to bridge: shown = seen + offset at `time`, floor frame, so that turning about does not fling it; null when bridged. */
  bridge: {
    readonly offset: Vec3;
    /** How far half-way it goes round the shoulder. */
    readonly detour: Vec3;
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
      shown: rest,
      trust: seen ? 1 : 0,
      lost: seen
        ? null
        : { from: rest, trust: 0, time: Number.NEGATIVE_INFINITY, departs: Number.NEGATIVE_INFINITY },
      bridge: null,
    };
    memories[side] = memory;
    let way: HandWay | null = null;

    if (seen) {
      const seenInBody = transformPose(invertTransform(floorFromBody), tracked);
      const now = reachOf(seenInBody);
      if (memory.lost) {
        const [place, shownPlace] = [placeOf(now), placeOf(memory.shown)];
        const offset = subtract(shownPlace, place);
        const detour = detourAround(place, shownPlace, body.arm, outside);
        memory.bridge = {
          offset: rotate(floorFromBody.orientation, offset),
          detour: rotate(floorFromBody.orientation, detour),
          turn: multiply(conjugate(now.orientation), memory.shown.orientation),
          trust: memory.trust,
          seconds: Math.max(blendSeconds, (length(offset) + 3 * length(detour)) / easeSpeed),
          time,
        };
        memory.lost = null;
      }
      memory.shown = now;
      memory.trust = 1;
      if (memory.bridge) {
        const { offset, detour, turn, trust, seconds, time: since } = memory.bridge;
        const missing = 1 - evenStep(0, seconds, time - since);
        if (missing <= 0) memory.bridge = null;
        memory.trust = 1 + (trust - 1) * missing;
        way = { goal: { position: tracked.position, orientation: tracked.orientation }, left: missing, since };
        const aside = addScaled(scale(offset, missing), detour, 4 * missing * (1 - missing));
        memory.shown = reachOf({
          position: add(seenInBody.position, rotate(conjugate(floorFromBody.orientation), aside)),
          orientation: multiply(now.orientation, slerp(identity, turn, missing)),
        });
      }
      if (!memory.bridge) return { position: tracked.position, orientation: tracked.orientation, seen, trust: 1 };
    } else {
      // Who was on the way back turns round at once; else the hand is held first.
      const departs = memory.bridge ? time : time + holdSeconds;
      memory.bridge = null;
      memory.lost ??= { from: memory.shown, trust: memory.trust, time, departs };
      const { from, trust, time: since } = memory.lost;
      const arc = directionArc(from.direction, rest.direction, outside);
      const metres = arc.angle * Math.max(from.distance, rest.distance) + Math.abs(from.distance - rest.distance);
      const duration = Math.max(easeSeconds, metres / easeSpeed);
      const share = evenStep(holdSeconds, holdSeconds + duration, Math.min(time - since, 1e6));
      memory.trust = trust * (1 - share);
      memory.shown = {
        direction: rotate(alongArc(arc, share), from.direction),
        distance: from.distance + (rest.distance - from.distance) * share,
        orientation: slerp(from.orientation, rest.orientation, share),
      };
      if (time > memory.lost.departs || share > 0) {
        const goal = transformPose(floorFromBody, {
          position: add(shoulder, placeOf(rest)),
          orientation: rest.orientation,
        });
        way = { goal, left: 1 - share, since: memory.lost.departs };
      }
    }
    const { orientation } = memory.shown;
    const pose = transformPose(floorFromBody, { position: add(shoulder, placeOf(memory.shown)), orientation });
    return { ...pose, seen, trust: memory.trust, ...(way && { way }) };
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
