import { clamp } from '../../math/damper';
import {
  add,
  addScaled,
  distance,
  dot,
  length,
  lerp,
  normalise,
  reject,
  scale,
  subtract,
  type Vec3,
  vec3,
} from '../../math/vec3';
import { fallsTo, gravity, positionAt, velocityAt } from '../ballistics';
import type { Basket, TimedLaunch } from './ball-state';

/** Of every ball [m]. */
export const ballRadius = 0.075;
/** The basket: a round opening, walls straight down from it [m]. */
export const basketRadius = 0.22;
export const basketDepth = 0.3;

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
export const ballInAir = (launch: TimedLaunch, time: number): Vec3 =>
  positionAt(launch, Math.max(time - launch.time, 0));

/** Where a rolling ball is: it loses speed by the second and goes speed · rollSeconds in all. */
export const ballOnFloor = (launch: TimedLaunch, time: number): Vec3 =>
  addScaled(
    launch.position,
    launch.velocity,
    rollSeconds * (1 - Math.exp(-Math.max(time - launch.time, 0) / rollSeconds)),
  );

/** When a ball in the air touches the floor [s of the match]. */
export const touchesFloor = (launch: TimedLaunch): number => launch.time + fallsTo(launch, ballRadius);

/** How a ball leaves the floor that it touches at `time`; `rolls`: for good. */
export function floorBounceOf(
  launch: TimedLaunch,
  time: number,
): { readonly launch: TimedLaunch; readonly rolls: boolean } {
  const position = { ...ballInAir(launch, time), y: ballRadius };
  const velocity = velocityAt(launch, time - launch.time);
  const upward = -velocity.y * floorBounce;
  const rolls = upward < rollsBelow;
  return {
    launch: {
      time,
      position,
      velocity: vec3(velocity.x * floorGrip, rolls ? 0 : upward, velocity.z * floorGrip),
    },
    rolls,
  };
}

/** The basket between two of its places, moved along the straight line and turned evenly. */
function basketAt(from: Basket, to: Basket, time: number): Basket {
  const share = to.at > from.at ? clamp((time - from.at) / (to.at - from.at), 0, 1) : 1;
  return {
    at: time,
    position: lerp(from.position, to.position, share),
    normal: normalise(lerp(from.normal, to.normal, share), to.normal),
  };
}

/** What the outside of the basket is to a ball: how far away, and which way out. */
interface Nearness {
  /** From the ball's skin to the basket, or from its middle to the opening if that is next [m]; below 0: within. */
  readonly far: number;
  /** Unit: from the basket to the ball. */
  readonly out: Vec3;
  /** Above the opening: what comes further down is in. */
  readonly overOpening: boolean;
}

function nearness(ball: Vec3, { position, normal }: Basket): Nearness {
  const from = subtract(ball, position);
  const height = dot(from, normal);
  const sideways = reject(from, normal);
  const radial = length(sideways);
  const outward = normalise(sideways, vec3(normal.y, normal.z, normal.x));
  if (height > 0 && radial <= basketRadius) return { far: height, out: normal, overOpening: true };
  // The nearest point of a closed cylinder that hangs under the opening.
  const beyond = radial - basketRadius;
  const above = Math.max(height, -basketDepth - height);
  if (beyond <= 0 && above <= 0) {
    // Inside the walls: the way out that is shorter.
    return beyond > above
      ? { far: beyond - ballRadius, out: outward, overOpening: false }
      : { far: above - ballRadius, out: scale(normal, height > -basketDepth / 2 ? 1 : -1), overOpening: false };
  }
  const aside = Math.max(beyond, 0);
  const over = Math.max(above, 0) * (height > 0 ? 1 : -1);
  const away = addScaled(scale(outward, aside), normal, over);
  return { far: length(away) - ballRadius, out: normalise(away, outward), overOpening: false };
}

/** A ball meets the basket. */
export type BasketMeeting =
  | { readonly kind: 'caught'; readonly time: number }
  | { readonly kind: 'bounced'; readonly launch: TimedLaunch };

/** As near as a ball comes before it touches [m]; steps end this far from everything. */
const touching = 5e-4;
/** A ball that touches and parts is looked at again after this [s]. */
const partingStep = 1 / 1000;

/**
 * What happens first between a flying ball and the basket that moves from one place to another meanwhile; null: nothing. The ball's
 * middle going down through the opening is a catch; rim, walls and bottom bounce. Steps are as long as the distance allows at
 * the greatest speed there is, so nothing is too fast or too thin to be met.
 */
export function meetsBasket(launch: TimedLaunch, from: Basket, to: Basket): BasketMeeting | null {
  const start = Math.max(launch.time, from.at);
  const end = Math.min(to.at, touchesFloor(launch));
  if (!(end > start)) return null;
  const seconds = to.at - from.at;
  const turning = Math.acos(clamp(dot(from.normal, to.normal), -1, 1));
  // Everything of the basket within reach of the ball turns about the opening's middle.
  const arm = Math.hypot(basketRadius, basketDepth) + ballRadius;
  const basketSpeed = (distance(from.position, to.position) + 2 * turning * arm) / seconds;
  const fastest = Math.max(
    length(velocityAt(launch, start - launch.time)),
    length(velocityAt(launch, end - launch.time)),
  );
  const closing = fastest + basketSpeed + 1e-6;

  let time = start;
  while (time < end) {
    const ball = ballInAir(launch, time);
    const before = nearness(ball, basketAt(from, to, time));
    if (before.far <= touching) {
      const velocity = subtract(velocityAt(launch, time - launch.time), basketVelocity(ball, from, to, time));
      const into = dot(velocity, before.out);
      if (before.overOpening && into < 0) return { kind: 'caught', time };
      if (!before.overOpening && into < 0) {
        const bounced = addScaled(velocityAt(launch, time - launch.time), before.out, -(1 + basketBounce) * into);
        // From just outside, so that the same touch is not met again.
        const position = addScaled(ball, before.out, 1.2 * touching - before.far);
        return { kind: 'bounced', launch: { time, position, velocity: bounced } };
      }
      time += partingStep;
    } else {
      time += before.far / closing;
    }
  }
  return null;
}

/** How fast the basket's body moves where the ball touches it. */
function basketVelocity(ball: Vec3, from: Basket, to: Basket, time: number): Vec3 {
  const seconds = to.at - from.at;
  const moved = scale(subtract(to.position, from.position), 1 / seconds);
  const { position, normal } = basketAt(from, to, time);
  const turning = scale(subtract(to.normal, from.normal), 1 / seconds);
  const offset = subtract(ball, position);
  // A normal that changes by n' carries what lies at h·n + s along by h·n' − (s·n')·n.
  const height = dot(offset, normal);
  return add(moved, addScaled(scale(turning, height), normal, -dot(reject(offset, normal), turning)));
}

/** The speed [m/s] with which something sets off upward and ahead at 45° to come down at its own height this far away [m]. */
export const speedForDistance = (metres: number): number => Math.sqrt(gravity * metres);
