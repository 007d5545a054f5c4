import type { Calibration } from '../body/calibration';
import { type ChestSpaceBody, chestSpaceBody, sideSign } from '../body/skeleton';
import { clamp } from '../math/damper';
import type { TrackedPose } from '../math/pose';
import { fromAxes, fromAxisAngle, type MutableQuat, multiply, quat, rotate, slerp } from '../math/quat';
import type { Side } from '../math/side';
import {
  add,
  addScaled,
  cross,
  distance,
  lerp,
  type MutableVec3,
  normalise,
  reject,
  right,
  scale,
  setVec3,
  up,
  vec3,
} from '../math/vec3';
import type { TrackingFrame } from './tracking-frame';

/** A hand of a key pose, in the body's frame (yaw of the trunk), mirrored for the left: x is outward. */
interface HandKey {
  /** The wrist from its own shoulder, in arm lengths: outward, up, backward. */
  readonly at: readonly [number, number, number];
  /** Directions of the knuckles and of the back of the hand: outward, up, backward. */
  readonly knuckles: readonly [number, number, number];
  readonly back: readonly [number, number, number];
}

interface Key {
  /** Seconds from the start of the loop. */
  readonly time: number;
  readonly left: HandKey;
  readonly right: HandKey;
  /** The head's pitch up and yaw to the left [degrees] against the trunk. */
  readonly pitch?: number;
  readonly look?: number;
  /** Yaw of the whole body to the left [degrees], and how low the head is: 1 standing. */
  readonly turn?: number;
  readonly height?: number;
  /** Shift of the head to the left and ahead [m]. */
  readonly sway?: readonly [number, number];
}

const hanging: HandKey = { at: [0.16, -0.95, -0.08], knuckles: [0.05, -1, -0.2], back: [1, 0, -0.1] };
const open: HandKey = { at: [0.18, -0.5, -0.62], knuckles: [0.1, 0.1, -1], back: [0.75, -0.6, 0] };
const waving = (aside: number): HandKey => ({
  at: [0.34 + aside, 0.2, -0.42],
  knuckles: [aside * 1.6, 1, -0.05],
  back: [0, 0.1, 1],
});
const pointing: HandKey = { at: [0.06, 0.02, -0.95], knuckles: [0.02, 0.02, -1], back: [0.3, 1, 0] };
const onHip: HandKey = { at: [0.3, -0.66, -0.06], knuckles: [-0.75, -0.25, -0.5], back: [0.7, 0.4, 0.5] };
const foldedOver: HandKey = { at: [-0.52, -0.35, -0.46], knuckles: [-1, 0.25, -0.05], back: [0, 0.35, -1] };
const foldedUnder: HandKey = { at: [-0.46, -0.47, -0.4], knuckles: [-1, 0.1, 0.1], back: [0, 0.2, -1] };
const guard: HandKey = { at: [-0.16, -0.06, -0.44], knuckles: [-0.2, 0.9, -0.35], back: [0.75, 0.3, -0.5] };
const punch: HandKey = { at: [-0.26, -0.02, -0.9], knuckles: [0, 0, -1], back: [0.15, 1, 0] };
const bowArm: HandKey = { at: [0.5, 0.05, -0.8], knuckles: [0.5, 0, -0.85], back: [0.85, 0.1, 0.5] };
const nocking: HandKey = { at: [-0.28, 0, -0.74], knuckles: [-0.55, 0.05, -0.8], back: [0.55, 0.7, -0.2] };
const drawn: HandKey = { at: [-0.12, 0.12, -0.2], knuckles: [-0.7, 0, -0.7], back: [0.5, 0.75, -0.3] };
const overhead: HandKey = { at: [0.16, 0.92, -0.2], knuckles: [0, 1, -0.1], back: [0.3, 0, 1] };
const aside: HandKey = { at: [0.93, 0.06, -0.12], knuckles: [1, 0, -0.05], back: [0, 1, 0] };
const lowAhead: HandKey = { at: [0.12, -0.62, -0.6], knuckles: [0, -0.35, -1], back: [0.6, 0.75, 0] };

/** The key poses of a loop of half a minute, in which an actor shows the body's range of motion. */
const keys: readonly Key[] = [
  { time: 0, left: hanging, right: hanging },
  { time: 1.2, left: hanging, right: hanging, look: 8 },
  { time: 2.1, left: hanging, right: waving(0), look: -6, pitch: 2 },
  { time: 2.5, left: hanging, right: waving(0.16), look: -8, pitch: 2 },
  { time: 2.9, left: hanging, right: waving(-0.12), look: -6, pitch: 2 },
  { time: 3.3, left: hanging, right: waving(0.16), look: -8, pitch: 2 },
  { time: 3.7, left: hanging, right: waving(-0.08), look: -4, pitch: 2 },
  { time: 4.7, left: open, right: open },
  { time: 5.7, left: open, right: open, look: 12, pitch: -6 },
  { time: 6.8, left: onHip, right: onHip, look: -10 },
  { time: 8.0, left: onHip, right: onHip, look: 14, sway: [0.04, 0] },
  { time: 9.2, left: pointing, right: onHip, look: 6, turn: -14 },
  { time: 10.1, left: pointing, right: onHip, look: 4, turn: -14, pitch: 4 },
  { time: 11.4, left: foldedUnder, right: foldedOver, pitch: -3 },
  { time: 13.2, left: foldedUnder, right: foldedOver, look: 16, sway: [-0.03, 0] },
  { time: 14.4, left: guard, right: guard, turn: 10, height: 0.97 },
  { time: 14.75, left: punch, right: guard, turn: -12, height: 0.965, sway: [0.02, 0.07] },
  { time: 15.15, left: guard, right: guard, turn: 6, height: 0.97 },
  { time: 15.5, left: guard, right: punch, turn: 28, height: 0.96, sway: [-0.02, 0.09] },
  { time: 15.95, left: guard, right: guard, turn: 8, height: 0.97 },
  { time: 17.2, left: hanging, right: hanging, turn: 0 },
  { time: 18.4, left: bowArm, right: nocking, turn: -42, look: 38 },
  { time: 19.0, left: bowArm, right: nocking, turn: -44, look: 40 },
  { time: 20.2, left: bowArm, right: drawn, turn: -48, look: 46 },
  { time: 21.2, left: bowArm, right: drawn, turn: -48, look: 46, pitch: 2 },
  { time: 21.5, left: bowArm, right: { ...drawn, at: [0.06, 0.1, -0.1] }, turn: -48, look: 46 },
  { time: 22.9, left: hanging, right: hanging, turn: -10 },
  { time: 24.2, left: aside, right: aside, pitch: 5 },
  { time: 25.4, left: overhead, right: overhead, pitch: 20, height: 1.005 },
  { time: 26.6, left: aside, right: aside, pitch: 0 },
  { time: 27.9, left: lowAhead, right: lowAhead, height: 0.7, pitch: -14, sway: [0, 0.12] },
  { time: 29.0, left: lowAhead, right: lowAhead, height: 0.68, pitch: -8, sway: [0, 0.12] },
  { time: 30.4, left: hanging, right: hanging },
  { time: 32.0, left: hanging, right: hanging, turn: 90 },
  { time: 33.6, left: hanging, right: open, turn: 180, look: 10 },
  { time: 35.4, left: hanging, right: hanging, turn: 290 },
  { time: 36.8, left: hanging, right: hanging, turn: 360 },
];

/** Length of the loop [s]. */
const actorLoopSeconds = keys.at(-1)?.time ?? 0;

/** Returns the minimum-jerk progress from 0 to 1, by which hands move between two points (Flash & Hogan 1985). */
const minimumJerk = (t: number): number => t * t * t * (10 - 15 * t + 6 * t * t);

const radians = (degrees: number): number => (degrees * Math.PI) / 180;

/** A cache of bodies by calibration, because the actor uses one for many frames. */
const bodies = new WeakMap<Calibration, ChestSpaceBody>();

function bodyOf(calibration: Calibration): ChestSpaceBody {
  const known = bodies.get(calibration);
  if (known) return known;
  const body = chestSpaceBody(calibration);
  bodies.set(calibration, body);
  return body;
}

/**
 * Returns head and wrists at a time [s] of an endless loop by a person of these measures, floor frame, standing near
 * the origin and facing −Z at first. Position and speed are continuous; hands stay within reach.
 */
export function actorFrame(timeSeconds: number, calibration: Calibration): TrackingFrame {
  const loops = Math.floor(timeSeconds / actorLoopSeconds);
  const time = timeSeconds - loops * actorLoopSeconds;
  let next = 1;
  while (next < keys.length - 1 && keys[next]!.time <= time) next += 1;
  const from = keys[next - 1] as Key;
  const to = keys[next] as Key;
  const fraction = minimumJerk(clamp((time - from.time) / (to.time - from.time), 0, 1));
  const mixed = (a = 0, b = 0): number => a + (b - a) * fraction;

  const body = bodyOf(calibration);
  const e = calibration.eyeHeight;
  fromAxisAngle(up, radians(mixed(from.turn, to.turn)), trunk);
  setVec3(sway, -mixed(from.sway?.[0], to.sway?.[0]), 0, -mixed(from.sway?.[1], to.sway?.[1]));
  const height = e * (1 + mixed((from.height ?? 1) - 1, (to.height ?? 1) - 1));
  const breath = 0.003 * Math.sin(timeSeconds * 1.5);
  const eyes = vec3(0.012 * Math.sin(timeSeconds * 0.61), height + breath, 0.01 * Math.sin(timeSeconds * 0.43 + 1));
  add(eyes, rotate(trunk, sway, sway), eyes);
  fromAxisAngle(right, radians(mixed(from.pitch, to.pitch) + 1.2 * Math.sin(timeSeconds * 0.8)), nod);
  const orientation = fromAxisAngle(up, radians(mixed(from.look, to.look) + 2 * Math.sin(timeSeconds * 0.37)));
  multiply(trunk, multiply(orientation, nod, orientation), orientation);
  // The trunk is placed below the head joint of a level head, so that a glance moves no shoulder.
  setVec3(neck, 0, -body.eyesInHead.y - body.neckToHead.y, -body.eyesInHead.z);
  add(eyes, rotate(trunk, neck, neck), neck);

  const moment = { from, to, fraction, timeSeconds, body, shoulderAhead: 0.01 * e };
  return {
    time: timeSeconds,
    head: { position: eyes, orientation, tracking: 'tracked' },
    leftHand: handAt('left', moment),
    rightHand: handAt('right', moment),
  };
}

/** A point in time between two keys. */
interface KeyInterpolation {
  readonly from: Key;
  readonly to: Key;
  readonly fraction: number;
  readonly timeSeconds: number;
  readonly body: ChestSpaceBody;
  /** The offset of the shoulders behind the neck [m]. */
  readonly shoulderAhead: number;
}

// Scratch of one frame: the trunk's yaw, and what hangs on it.
const trunk = quat(0, 0, 0, 1);
const sway = vec3(0, 0, 0);
const nod = quat(0, 0, 0, 1);
const neck = vec3(0, 0, 0);
// Scratch of one hand.
const shoulder = vec3(0, 0, 0);
const reachFrom = vec3(0, 0, 0);
const reachTo = vec3(0, 0, 0);
const tremor = vec3(0, 0, 0);
const knuckles = vec3(0, 0, 0);
const back = vec3(0, 0, 0);
const side = vec3(0, 0, 0);
const turnedFrom = quat(0, 0, 0, 1);
const turnedTo = quat(0, 0, 0, 1);

function handAt(which: Side, moment: KeyInterpolation): TrackedPose {
  const { from, to, fraction, timeSeconds, body } = moment;
  const sigma = sideSign(which);
  setVec3(shoulder, sigma * (body.clavicleRoot.x + body.clavicle.x), body.clavicle.y, moment.shoulderAhead);
  outward(sigma, from[which].at, reachFrom);
  addScaled(shoulder, reachFrom, body.arm * 0.97, reachFrom);
  outward(sigma, to[which].at, reachTo);
  addScaled(shoulder, reachTo, body.arm * 0.97, reachTo);
  // On long paths hands swing forward a little, so that they do not pass through the trunk.
  const bulge = -0.22 * distance(reachFrom, reachTo) * Math.sin(Math.PI * fraction) ** 2;
  setVec3(
    tremor,
    0.005 * Math.sin(timeSeconds * 1.1 + sigma),
    0.004 * Math.sin(timeSeconds * 1.5),
    0.005 * Math.sin(timeSeconds * 0.9 + 2 * sigma) + bulge,
  );
  const position = lerp(reachFrom, reachTo, fraction);
  add(position, tremor, position);
  const far = distance(position, shoulder);
  const longest = body.arm * 0.985;
  if (far > longest) lerp(shoulder, position, longest / far, position);
  add(neck, rotate(trunk, position, position), position);
  const orientation = slerp(
    handOrientation(sigma, from[which], turnedFrom),
    handOrientation(sigma, to[which], turnedTo),
    fraction,
  );
  return { position, orientation: multiply(trunk, orientation, orientation), tracking: 'tracked' };
}

/** Writes a key's direction, whose x is outward, for a side. */
const outward = (sigma: number, direction: readonly [number, number, number], target: MutableVec3): MutableVec3 =>
  setVec3(target, sigma * direction[0], direction[1], direction[2]);

/** Writes the wrist orientation for the directions of the knuckles (exact) and of the back of the hand (nearest). */
function handOrientation(sigma: number, key: HandKey, target: MutableQuat): MutableQuat {
  scale(normalise(outward(sigma, key.knuckles, knuckles), undefined, knuckles), -1, knuckles);
  reject(outward(sigma, key.back, back), knuckles, back);
  normalise(back, undefined, back);
  return fromAxes(cross(back, knuckles, side), back, knuckles, target);
}
