import { clamp } from 'threepoint/core/math/damper';
import {
  add,
  addScaled,
  copyVec3,
  distance,
  dot,
  length,
  lerp,
  type MutableVec3,
  normalise,
  reject,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/core/math/vec3';
import { fallsTo, positionAt, velocityAt } from '../ballistics';
import type { Basket, TimedLaunch } from './ball-state';

/** Of every ball [m]. */
export const ballRadius = 0.075;
/** The basket: a round opening, walls straight down from it [m]. */
export const basketRadius = 0.22;
export const basketDepth = 0.3;
/** The rim is a tube of this radius about the opening's edge [m]. */
export const rimTube = 0.017;

/** Share of the speed into a surface that a bounce gives back. */
const floorBounce = 0.62;
const basketBounce = 0.45;
/** Share of the speed along the floor that a bounce leaves. */
const floorGrip = 0.8;
/** A bounce that would leave the floor more slowly than this [m/s] rolls instead. */
const rollsBelow = 0.7;
/** A rolling ball's speed shrinks to 1/e in this time [s]. */
const rollSeconds = 1.1;

/** Where a ball in the air is at a time [s of the match]; before its launch: where it set off. */
export const ballInAir = (launch: TimedLaunch, time: number, target?: MutableVec3): MutableVec3 =>
  positionAt(launch, Math.max(time - launch.time, 0), target);

/** Where a rolling ball is: it loses speed by the second and goes speed · rollSeconds in all. */
export const ballOnFloor = (launch: TimedLaunch, time: number, target?: MutableVec3): MutableVec3 =>
  addScaled(
    launch.position,
    launch.velocity,
    rollSeconds * (1 - Math.exp(-Math.max(time - launch.time, 0) / rollSeconds)),
    target,
  );

/** When a ball in the air touches the floor [s of the match]. */
export const touchesFloor = (launch: TimedLaunch): number => launch.time + fallsTo(launch, ballRadius);

/** How a ball leaves the floor that it touches at `time`; `rolls`: for good. */
export function floorBounceOf(
  launch: TimedLaunch,
  time: number,
): { readonly launch: TimedLaunch; readonly rolls: boolean } {
  const position = ballInAir(launch, time);
  position.y = ballRadius;
  const velocity = velocityAt(launch, time - launch.time);
  const upward = -velocity.y * floorBounce;
  const rolls = upward < rollsBelow;
  setVec3(velocity, velocity.x * floorGrip, rolls ? 0 : upward, velocity.z * floorGrip);
  return { launch: { time, position, velocity }, rolls };
}

/** An opening that its owner overwrites. */
interface MutableOpening {
  readonly position: MutableVec3;
  readonly normal: MutableVec3;
}

/** The basket between two of its places, moved along the straight line and turned evenly. */
function basketAt(from: Basket, to: Basket, time: number, target: MutableOpening): void {
  const share = to.at > from.at ? clamp((time - from.at) / (to.at - from.at), 0, 1) : 1;
  lerp(from.position, to.position, share, target.position);
  normalise(lerp(from.normal, to.normal, share, target.normal), to.normal, target.normal);
}

/** What the outside of the basket is to a ball: how far away, and which way out. */
interface Nearness {
  /** From the ball's skin to the basket, or from its middle to the opening if that is next [m]; below 0: within. */
  far: number;
  /** How far the ball can go at least before it meets either, or the rim on its way out over it [m]. */
  free: number;
  /** Unit: from the basket to the ball. */
  readonly out: MutableVec3;
  /** Above the opening: what comes further down is in. */
  overOpening: boolean;
}

// Memory of one call: a ball in the air is looked at in every tick.
const outward = vec3(0, 0, 0);
const sideways = vec3(0, 0, 0);
const askew = vec3(0, 0, 0);

function measure(ball: Vec3, { position, normal }: MutableOpening, near: Nearness): void {
  const from = subtract(ball, position, outward);
  const height = dot(from, normal);
  reject(from, normal, sideways);
  const radial = length(sideways);
  normalise(sideways, setVec3(askew, normal.y, normal.z, normal.x), outward);
  near.overOpening = height > 0 && radial <= basketRadius;
  if (near.overOpening) {
    near.far = height;
    // On its way out the skin meets the rim where the middle is no higher over it than the ball's radius.
    near.free = Math.min(height, Math.max(height - ballRadius, basketRadius - radial));
    copyVec3(normal, near.out);
    return;
  }
  // The nearest point of a closed cylinder that hangs under the opening.
  const beyond = radial - basketRadius;
  const above = Math.max(height, -basketDepth - height);
  if (beyond <= 0 && above <= 0) {
    // Inside the walls: the way out that is shorter.
    near.far = near.free = Math.max(beyond, above) - ballRadius;
    if (beyond > above) copyVec3(outward, near.out);
    else scale(normal, height > -basketDepth / 2 ? 1 : -1, near.out);
    return;
  }
  const aside = Math.max(beyond, 0);
  const over = Math.max(above, 0) * (height > 0 ? 1 : -1);
  addScaled(scale(outward, aside, near.out), normal, over, near.out);
  near.far = near.free = length(near.out) - ballRadius;
  normalise(near.out, outward, near.out);
}

/** A ball meets the basket. */
export type BasketMeeting =
  | { readonly kind: 'caught'; readonly time: number }
  | { readonly kind: 'bounced'; readonly launch: TimedLaunch };

/** As near as a ball comes before it touches [m]; steps end this far from everything. */
const touching = 5e-4;
/** A ball that touches and parts is looked at again after this [s]. */
const partingStep = 1 / 1000;

/** The ball's middle and velocity. */
const middle = vec3(0, 0, 0);
const flown = vec3(0, 0, 0);
const relative = vec3(0, 0, 0);
const opening: MutableOpening = { position: vec3(0, 0, 0), normal: vec3(0, 0, 0) };
const near: Nearness = { far: 0, free: 0, out: vec3(0, 0, 0), overOpening: false };

/** How fast ball and basket may come nearer to each other at most [m/s]. */
function closingSpeed(launch: TimedLaunch, from: Basket, to: Basket, start: number, end: number): number {
  const seconds = to.at - from.at;
  const turning = Math.acos(clamp(dot(from.normal, to.normal), -1, 1));
  // Everything of the basket within reach of the ball turns about the opening's middle.
  const arm = Math.hypot(basketRadius, basketDepth) + ballRadius;
  const basketSpeed = (distance(from.position, to.position) + 2 * turning * arm) / seconds;
  const fastest = Math.max(
    length(velocityAt(launch, start - launch.time, flown)),
    length(velocityAt(launch, end - launch.time, flown)),
  );
  return fastest + basketSpeed + 1e-6;
}

/**
 * What happens first between a flying ball and the basket that moves from one place to another meanwhile; null: nothing. The ball's
 * middle going down through the opening is a catch; rim, walls and bottom bounce. Steps are as long as the distance allows at
 * the greatest speed there is, so nothing is too fast or too thin to be met.
 */
export function meetsBasket(launch: TimedLaunch, from: Basket, to: Basket): BasketMeeting | null {
  const start = Math.max(launch.time, from.at);
  const end = Math.min(to.at, touchesFloor(launch));
  if (!(end > start)) return null;
  const closing = closingSpeed(launch, from, to, start, end);
  let time = start;
  while (time < end) {
    ballInAir(launch, time, middle);
    basketAt(from, to, time, opening);
    measure(middle, opening, near);
    if (near.far > touching) {
      time += Math.max(near.free, touching) / closing;
      continue;
    }
    velocityAt(launch, time - launch.time, flown);
    const into = dot(subtract(flown, basketVelocity(from, to), relative), near.out);
    if (near.overOpening && into < 0) return { kind: 'caught', time };
    if (!near.overOpening && into < 0) {
      const velocity = addScaled(flown, near.out, -(1 + basketBounce) * into);
      // From just outside, so that the same touch is not met again.
      const position = addScaled(middle, near.out, 1.2 * touching - near.far);
      return { kind: 'bounced', launch: { time, position, velocity } };
    }
    time += partingStep;
  }
  return null;
}

const moved = vec3(0, 0, 0);
const turning = vec3(0, 0, 0);
const offset = vec3(0, 0, 0);
const flat = vec3(0, 0, 0);

/** How fast the basket's body moves where the ball touches it, both as they were measured last. */
function basketVelocity(from: Basket, to: Basket): Vec3 {
  const seconds = to.at - from.at;
  scale(subtract(to.position, from.position, moved), 1 / seconds, moved);
  const { position, normal } = opening;
  scale(subtract(to.normal, from.normal, turning), 1 / seconds, turning);
  subtract(middle, position, offset);
  // A normal that changes by n' carries what lies at h·n + s along by h·n' − (s·n')·n.
  const height = dot(offset, normal);
  const along = dot(reject(offset, normal, flat), turning);
  return add(moved, addScaled(scale(turning, height, turning), normal, -along, turning), moved);
}
