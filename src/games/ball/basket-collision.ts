import {
  add,
  addScaled,
  clamp,
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
} from 'threepoint/math';
import { velocityAt } from '../ballistics';
import type { Basket, TimedLaunch } from './ball-state';
import { basketDepth, basketRadius, type MutableOpening, makeOpening } from './basket';
import { ballInAir, ballRadius, floorContactTime } from './flight';

/** Restitution: the share of the normal speed after a bounce. */
const basketBounce = 0.45;

/** Writes the basket's opening between two poses, interpolated linearly. */
function basketAt(from: Basket, to: Basket, time: number, target: MutableOpening): void {
  const share = to.at > from.at ? clamp((time - from.at) / (to.at - from.at), 0, 1) : 1;
  lerp(from.position, to.position, share, target.position);
  normalise(lerp(from.normal, to.normal, share, target.normal), to.normal, target.normal);
}

/** The position of a ball relative to the basket. */
interface Clearance {
  /**
   * Distance of the ball's surface from the basket, or of its centre from the opening above it [m]; negative: inside.
   */
  distance: number;
  /** Distance that the ball can move at least before it meets the basket or its opening [m]. */
  free: number;
  /** Direction from the basket to the ball, unit. */
  readonly out: MutableVec3;
  /** Whether the ball is above the opening, where a descent is a catch. */
  overOpening: boolean;
}

// Scratch of one call: every tick computes the flying balls.
const outward = vec3(0, 0, 0);
const sideways = vec3(0, 0, 0);
const askew = vec3(0, 0, 0);

function measure(ball: Vec3, { position, normal }: MutableOpening, near: Clearance): void {
  const from = subtract(ball, position, outward);
  const height = dot(from, normal);
  reject(from, normal, sideways);
  const radial = length(sideways);
  normalise(sideways, setVec3(askew, normal.y, normal.z, normal.x), outward);
  near.overOpening = height > 0 && radial <= basketRadius;
  if (near.overOpening) {
    near.distance = height;
    // Sideways the ball meets the rim only if its centre is at most its radius above the opening.
    near.free = Math.min(height, Math.max(height - ballRadius, basketRadius - radial));
    copyVec3(normal, near.out);
    return;
  }
  // The nearest point of the closed cylinder below the opening.
  const beyond = radial - basketRadius;
  const above = Math.max(height, -basketDepth - height);
  if (beyond <= 0 && above <= 0) {
    // Inside the walls: take the shorter way out.
    near.distance = near.free = Math.max(beyond, above) - ballRadius;
    if (beyond > above) copyVec3(outward, near.out);
    else scale(normal, height > -basketDepth / 2 ? 1 : -1, near.out);
    return;
  }
  const aside = Math.max(beyond, 0);
  const over = Math.max(above, 0) * (height > 0 ? 1 : -1);
  addScaled(scale(outward, aside, near.out), normal, over, near.out);
  near.distance = near.free = length(near.out) - ballRadius;
  normalise(near.out, outward, near.out);
}

/** A catch by the basket, or a bounce off it. */
type BasketContact =
  | { readonly kind: 'caught'; readonly time: number }
  | { readonly kind: 'bounced'; readonly launch: TimedLaunch };

/** Distance at which a ball counts as touching [m]; steps end this far from the basket. */
const touching = 5e-4;
/** Step for a ball that touches the basket and moves away [s]. */
const partingStep = 1 / 1000;
/** Scratch: the ball's centre and velocity, and the basket. */
const middle = vec3(0, 0, 0);
const flown = vec3(0, 0, 0);
const relative = vec3(0, 0, 0);
const opening = makeOpening();
const near: Clearance = { distance: 0, free: 0, out: vec3(0, 0, 0), overOpening: false };

/** Returns an upper bound of the closing speed of ball and basket [m/s]. */
function closingSpeed(launch: TimedLaunch, from: Basket, to: Basket, start: number, end: number): number {
  const seconds = to.at - from.at;
  const turning = Math.acos(clamp(dot(from.normal, to.normal), -1, 1));
  // The basket turns about the centre of its opening; this is the longest lever.
  const arm = Math.hypot(basketRadius, basketDepth) + ballRadius;
  const basketSpeed = (distance(from.position, to.position) + 2 * turning * arm) / seconds;
  const fastest = Math.max(
    length(velocityAt(launch, start - launch.time, flown)),
    length(velocityAt(launch, end - launch.time, flown)),
  );
  return fastest + basketSpeed + 1e-6;
}

/**
 * Returns the first meeting of a flying ball and the moving basket; null: none. It is a catch if the ball's centre
 * descends through the opening; rim, walls and bottom bounce. Steps are as long as the distance permits at the closing
 * speed (conservative advancement), so that nothing tunnels.
 */
export function firstBasketContact(launch: TimedLaunch, from: Basket, to: Basket): BasketContact | null {
  const start = Math.max(launch.time, from.at);
  const end = Math.min(to.at, floorContactTime(launch));
  if (!(end > start)) return null;
  const closing = closingSpeed(launch, from, to, start, end);
  let time = start;
  while (time < end) {
    ballInAir(launch, time, middle);
    basketAt(from, to, time, opening);
    measure(middle, opening, near);
    if (near.distance > touching) {
      time += Math.max(near.free, touching) / closing;
      continue;
    }
    velocityAt(launch, time - launch.time, flown);
    const into = dot(subtract(flown, basketVelocity(from, to), relative), near.out);
    if (near.overOpening && into < 0) return { kind: 'caught', time };
    if (!near.overOpening && into < 0) {
      const velocity = addScaled(flown, near.out, -(1 + basketBounce) * into);
      // Start just outside, so that the same contact is not found again.
      const position = addScaled(middle, near.out, 1.2 * touching - near.distance);
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

/** Returns the basket's velocity at the contact with the ball, from the last `measure`. */
function basketVelocity(from: Basket, to: Basket): Vec3 {
  const seconds = to.at - from.at;
  scale(subtract(to.position, from.position, moved), 1 / seconds, moved);
  const { position, normal } = opening;
  scale(subtract(to.normal, from.normal, turning), 1 / seconds, turning);
  subtract(middle, position, offset);
  // A change n' of the normal moves the point h·n + s by h·n' − (s·n')·n.
  const height = dot(offset, normal);
  const along = dot(reject(offset, normal, flat), turning);
  return add(moved, addScaled(scale(turning, height, turning), normal, -along, turning), moved);
}
