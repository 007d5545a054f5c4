import type { Calibration, TrackingFrame } from 'threepoint/core';
import {
  add,
  createNormalRandom,
  dot,
  identity,
  length,
  type Quat,
  scale,
  subtract,
  type TrackedPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { addNoise, simulatedNoise, type TrackingNoise } from './disturbances';
import type { Driver } from './drive';

/** The calibration of the person who stands there. */
export const standing: Calibration = { eyeHeight: 1.62, armSpan: 1.48 };

export type WavedPoint = 'head' | 'rightHand';

/** How a drawn joint follows a tracked point that goes to and fro. */
export interface Response {
  /** How late [ms] it is against the same estimator with all the time it wants. */
  readonly lagMs: number;
  /** How far it goes, relative to that. */
  readonly gain: number;
}

const ways: Readonly<Record<WavedPoint, Vec3>> = { head: vec3(0.08, 0, 0), rightHand: vec3(0, 0.15, -0.05) };
/** A frequency [Hz] at which filters have no effect. */
const slowHz = 0.1;
/** The rate of the frames [Hz]. */
const rateHz = 60;
/** Before anything counts, and at least counted, in whole cycles. */
const [settleSeconds, countedSeconds] = [3, 4];
/** Joints that go less [m] than this do not follow at all. */
const still = 0.002;

const tracked = (position: Vec3, orientation: Quat): TrackedPose => ({ position, orientation, tracking: 'tracked' });

/** A person who stands with bent elbows, one point displaced [m]. */
function stance(time: number, point: WavedPoint | null, displaced: Vec3): TrackingFrame {
  const at = (name: WavedPoint | 'leftHand', rest: Vec3) =>
    tracked(name === point ? add(rest, displaced) : rest, identity);
  return {
    time,
    head: at('head', vec3(0, standing.eyeHeight, 0)),
    leftHand: at('leftHand', vec3(-0.2, 1.08, -0.32)),
    rightHand: at('rightHand', vec3(0.2, 1.08, -0.32)),
  };
}

/** The fundamental of a joint's way: cosine and sine parts by axis [m]. */
interface Fundamental {
  readonly cosine: Vec3;
  readonly sine: Vec3;
}

async function fundamentals(
  driver: Driver,
  point: WavedPoint,
  hz: number,
  joints: readonly string[],
): Promise<Readonly<Record<string, Fundamental>>> {
  const cycles = Math.max(1, Math.ceil(countedSeconds * hz));
  const counted = Math.round((cycles * rateHz) / hz);
  const settling = settleSeconds * rateHz;
  const sums = new Map(joints.map((joint) => [joint, { cosine: [0, 0, 0], sine: [0, 0, 0] }]));
  const way = ways[point];
  for (let row = -settling; row < counted; row++) {
    const phase = (2 * Math.PI * hz * row) / rateHz;
    const swing = Math.sin(phase);
    const frame = stance(row / rateHz, point, scale(way, swing));
    const drawn = await driver.draw(frame);
    if (row < 0) continue;
    for (const [joint, { cosine, sine }] of sums) {
      const { x, y, z } = drawn.joints[joint] as Vec3;
      [x, y, z].forEach((value, axis) => {
        cosine[axis] = (cosine[axis] ?? 0) + (2 * value * Math.cos(phase)) / counted;
        sine[axis] = (sine[axis] ?? 0) + (2 * value * Math.sin(phase)) / counted;
      });
    }
  }
  const vector = ([x = 0, y = 0, z = 0]: readonly number[]) => vec3(x, y, z);
  return Object.fromEntries(
    [...sums].map(([joint, { cosine, sine }]) => [joint, { cosine: vector(cosine), sine: vector(sine) }]),
  );
}

/** How joints follow a wave of each frequency [Hz] of one tracked point; null: the joint stays where it is. */
export async function measureResponse(
  driver: () => Driver,
  point: WavedPoint,
  frequencies: readonly number[],
  joints: readonly string[],
): Promise<Readonly<Record<string, Response | null>>[]> {
  const slow = await fundamentals(driver(), point, slowHz, joints);
  const responses: Readonly<Record<string, Response | null>>[] = [];
  for (const hz of frequencies) {
    const quick = await fundamentals(driver(), point, hz, joints);
    responses.push(Object.fromEntries(joints.map((joint) => [joint, responseOf(slow[joint]!, quick[joint]!, hz)])));
  }
  return responses;
}

/** The quick wave as a multiple of the slow one, by its projection on that: amplitude ratio, and phase as a time. */
function responseOf(slow: Fundamental, quick: Fundamental, hz: number): Response | null {
  const power = length(slow.cosine) ** 2 + length(slow.sine) ** 2;
  if (Math.sqrt(power) < still) return null;
  const inPhase = (dot(quick.sine, slow.sine) + dot(quick.cosine, slow.cosine)) / power;
  const ahead = (dot(quick.cosine, slow.sine) - dot(quick.sine, slow.cosine)) / power;
  const lagMs = (-Math.atan2(ahead, inPhase) / (2 * Math.PI * hz)) * 1000;
  return { lagMs, gain: Math.hypot(inPhase, ahead) };
}

/**
 * Root mean square [mm] of what joints move from frame to frame while the wearer stands still and the trackers are
 * noisy.
 */
export async function measureTremble(
  driver: Driver,
  joints: readonly string[],
  noise: TrackingNoise = simulatedNoise,
): Promise<Readonly<Record<string, number>>> {
  const normal = createNormalRandom(15);
  const sums = new Map(joints.map((joint) => [joint, 0]));
  const [settling, counted] = [2 * rateHz, 10 * rateHz];
  let before: Readonly<Record<string, Vec3>> | null = null;
  for (let row = -settling; row < counted; row++) {
    const frame = stance(row / rateHz, null, vec3(0, 0, 0));
    const { head, leftHand, rightHand } = frame;
    const drawn = await driver.draw({
      ...frame,
      head: addNoise(head, noise.head, normal),
      leftHand: leftHand && addNoise(leftHand, noise.hands, normal),
      rightHand: rightHand && addNoise(rightHand, noise.hands, normal),
    });
    if (before && row >= 0) {
      for (const joint of joints) {
        const went = length(subtract(drawn.joints[joint] as Vec3, before[joint] as Vec3)) * 1000;
        sums.set(joint, (sums.get(joint) ?? 0) + went * went);
      }
    }
    before = drawn.joints;
  }
  return Object.fromEntries([...sums].map(([joint, sum]) => [joint, Math.sqrt(sum / counted)]));
}
