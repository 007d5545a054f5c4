import { recordOf, type TrackingFrame } from 'threepoint/core';
import {
  add,
  createNormalRandom,
  createRandom,
  fromAxisAngle,
  length,
  lerp,
  multiply,
  normalise,
  rotate,
  type Side,
  slerp,
  type TrackedPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { trackers as simulated } from '../../src/threepoint/core/mocap/mocap-rules.json';
import { rateHz as handTrackingHz, quantiles } from './hand-tracking-losses.json';
import type { MeasuredFrame } from './measures';
import { type RecordedFrame, truthJoints } from './recordings';

/** One hand unseen in the frames [start, end). */
export interface Loss {
  readonly side: Side;
  readonly start: number;
  readonly end: number;
}

/** The minimum time between the end of a loss and the next loss or the clip's end [s]. */
export const aftermathSeconds = 0.5;
const [earliestSeconds, startSpreadSeconds] = [0.5, 1];
const [restSeconds, restSpreadSeconds] = [1.5, 1.5];

/** A seed of a text: the same clip meets the same losses in any selection of clips (FNV-1a). */
export function seedOf(text: string): number {
  let hash = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) hash = Math.imul(hash ^ byte, 0x01000193);
  return hash | 0;
}

/** Draws the length of a loss [s] from numbers in [0, 1). */
export type LossLength = (random: () => number) => number;

/** Losses that all last as long [s]. */
export const lasting =
  (seconds: number): LossLength =>
  () =>
    seconds;

/** The share of losses that last so long [s] or less. */
export interface LossQuantile {
  readonly share: number;
  readonly seconds: number;
}

/** Draws lengths between quantiles in ascending order: geometric, from the first to the last. */
export const lossLengthFrom =
  (losses: readonly LossQuantile[]): LossLength =>
  (random) => {
    const share = random();
    const above = losses.findIndex((quantile) => quantile.share > share);
    const [from, to] = [losses.at(above < 0 ? -1 : above - 1)!, losses.at(above)!];
    const within = from === to ? 0 : (share - from.share) / (to.share - from.share);
    return from.seconds * (to.seconds / from.seconds) ** within;
  };

/** Losses at seeded times, of either hand; up to the first that the clip is too short for, with its aftermath. */
export function scheduleLosses(frames: number, rateHz: number, lengthOf: LossLength, seed: number): Loss[] {
  const random = createRandom(seed);
  const losses: Loss[] = [];
  const drawLength = () => Math.max(1, Math.round(lengthOf(random) * rateHz));
  let start = Math.round((earliestSeconds + startSpreadSeconds * random()) * rateHz);
  for (let length = drawLength(); start + length + aftermathSeconds * rateHz <= frames; length = drawLength()) {
    const side = random() < 0.5 ? 'left' : 'right';
    losses.push({ side, start, end: start + length });
    start += length + Math.round((restSeconds + restSpreadSeconds * random()) * rateHz);
  }
  return losses;
}

/** Returns the frames without the lost hands; the truth stays. */
export function loseHands(frames: readonly RecordedFrame[], losses: readonly Loss[]): RecordedFrame[] {
  const lossy = [...frames];
  for (const { side, start, end } of losses) {
    for (let row = start; row < end; row++) {
      const before = lossy[row];
      if (before) lossy[row] = { ...before, frame: { ...before.frame, [`${side}Hand`]: null } };
    }
  }
  return lossy;
}

export const trackers = ['headset', 'grips'] as const;
export type Tracker = (typeof trackers)[number];

/**
 * Returns the frames with the headset or both grips mounted `offset` [m] away, along the device's own axes (+x right,
 * +y up or out of the back of the hand, −z forward); the left hand's x is mirrored, so that +x is one side of the body
 * for neither.
 */
export function offsetTrackers(frames: readonly RecordedFrame[], tracker: Tracker, offset: Vec3): RecordedFrame[] {
  const moved = <P extends TrackedPose | null>(pose: P, by: Vec3): P =>
    pose && { ...pose, position: add(pose.position, rotate(pose.orientation, by)) };
  return frames.map(({ frame, truth }) => ({
    truth,
    frame:
      tracker === 'headset'
        ? { ...frame, head: moved(frame.head, offset) }
        : {
            ...frame,
            leftHand: moved(frame.leftHand, { ...offset, x: -offset.x }),
            rightHand: moved(frame.rightHand, offset),
          },
  }));
}

/** Standard deviations of a tracker's noise: by axis [m] and by component of a rotation vector [rad]. */
export interface TrackerNoise {
  readonly metres: number;
  readonly radians: number;
}

/** The noise of a device's trackers. */
export type TrackingNoise = Readonly<Record<'head' | 'hands', TrackerNoise>>;

/** The noise of the simulated trackers, which every recording of the evaluation has. */
export const simulatedNoise: TrackingNoise = {
  head: noiseOf(simulated.positionNoise.head, simulated.rotationNoiseDegrees.head),
  hands: noiseOf(simulated.positionNoise.hands, simulated.rotationNoiseDegrees.hands),
};

/** The tracking of one device, for the rows of robustness that depend on it. */
export interface DeviceTracking {
  /** The name of its noise in the table. */
  readonly name: string;
  readonly noise: TrackingNoise;
  /** The lengths of its hands' losses, ascending; at least two. */
  readonly losses: readonly LossQuantile[];
}

/** White noise that no still headset shows, the same for head and hands: 0.3 mm by axis and 0.1° about a random one. */
const strong = noiseOf(0.0003, 0.1);

/** The tracking that is assumed without a measured one: strong noise, and losses of a commercial headset. */
export const usualTracking: DeviceTracking = {
  name: 'strong noise',
  noise: { head: strong, hands: strong },
  losses: quantiles.map(({ share, frames }) => ({ share, seconds: frames / handTrackingHz })),
};

function noiseOf(metres: number, degrees: number): TrackerNoise {
  return { metres, radians: (degrees * Math.PI) / 180 / Math.sqrt(3) };
}

/** The pose with noise added, from normally distributed numbers. */
export function addNoise<P extends TrackedPose>(pose: P, { metres, radians }: TrackerNoise, normal: () => number): P {
  const by = (size: number) => vec3(normal() * size, normal() * size, normal() * size);
  const turn = by(radians);
  const angle = length(turn);
  return {
    ...pose,
    position: add(pose.position, by(metres)),
    orientation: multiply(pose.orientation, fromAxisAngle(normalise(turn), angle)),
  };
}

/** Recorded frames with the simulated trackers' noise raised to `noise`: independent variances add up. */
export function raiseNoise(frames: readonly RecordedFrame[], noise: TrackingNoise, seed: number): RecordedFrame[] {
  const normal = createNormalRandom(seed);
  const missing = (tracker: 'head' | 'hands'): TrackerNoise => {
    const rest = (part: keyof TrackerNoise) =>
      Math.sqrt(Math.max(0, noise[tracker][part] ** 2 - simulatedNoise[tracker][part] ** 2));
    return { metres: rest('metres'), radians: rest('radians') };
  };
  const [ofHead, ofHands] = [missing('head'), missing('hands')];
  return frames.map(({ frame, truth }) => ({
    truth,
    frame: {
      ...frame,
      head: addNoise(frame.head, ofHead, normal),
      leftHand: frame.leftHand && addNoise(frame.leftHand, ofHands, normal),
      rightHand: frame.rightHand && addNoise(frame.rightHand, ofHands, normal),
    },
  }));
}

/** Source rows on either side of each row at another rate, and how far between them. */
function rowsAtRate(rows: number, fromHz: number, toHz: number): { before: number; after: number; share: number }[] {
  // The tolerance keeps the last row where the rates divide and rounding does not.
  const count = rows === 0 ? 0 : Math.floor(((rows - 1) * toHz) / fromHz + 1e-9) + 1;
  return Array.from({ length: count }, (_, row) => {
    const at = (row * fromHz) / toHz;
    const before = Math.min(rows - 1, Math.floor(at + 1e-9));
    return { before, after: Math.min(rows - 1, before + 1), share: Math.max(0, at - before) };
  });
}

const lerpTruth = (a: RecordedFrame['truth'], b: RecordedFrame['truth'], share: number): RecordedFrame['truth'] =>
  recordOf(truthJoints, (joint) => lerp(a[joint], b[joint], share));

/**
 * The recording as a device of another rate would have it: positions linear, rotations along the shorter arc; a hand
 * seen on both sides only.
 */
export function resampleFrames(frames: readonly RecordedFrame[], fromHz: number, toHz: number): RecordedFrame[] {
  const pose = <P extends TrackedPose | null>(a: P, b: P, share: number): P | null =>
    a &&
    b && {
      ...a,
      position: lerp(a.position, b.position, share),
      orientation: slerp(a.orientation, b.orientation, share),
    };
  const first = frames[0]?.frame.time ?? 0;
  return rowsAtRate(frames.length, fromHz, toHz).map(({ before, after, share }, row) => {
    const [a, b] = [frames[before] as RecordedFrame, frames[after] as RecordedFrame];
    const frame: TrackingFrame = {
      time: first + row / toHz,
      head: pose(a.frame.head, b.frame.head, share) ?? a.frame.head,
      leftHand: pose(a.frame.leftHand, b.frame.leftHand, share),
      rightHand: pose(a.frame.rightHand, b.frame.rightHand, share),
    };
    return { frame, truth: lerpTruth(a.truth, b.truth, share) };
  });
}

/**
 * Estimates at another rate, joints and truth alike, so that their jerk compares; what the network alone said is left
 * out.
 */
export function resampleEstimates(frames: readonly MeasuredFrame[], fromHz: number, toHz: number): MeasuredFrame[] {
  return rowsAtRate(frames.length, fromHz, toHz).map(({ before, after, share }) => {
    const [a, b] = [frames[before] as MeasuredFrame, frames[after] as MeasuredFrame];
    const joints = Object.fromEntries(
      Object.entries(a.joints).map(([name, position]) => [name, lerp(position, b.joints[name] ?? position, share)]),
    );
    return { joints, truth: lerpTruth(a.truth, b.truth, share), raw: null, wrists: { left: null, right: null } };
  });
}
