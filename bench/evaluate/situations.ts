import type { Calibration, TrackingFrame } from 'threepoint/core';
import {
  createRandom,
  fromAxisAngle,
  invertTransform,
  multiply,
  right,
  type TrackedPose,
  type Transform,
  transformPose,
  up,
  vec3,
} from 'threepoint/math';
import {
  type Loss,
  type LossLength,
  lasting,
  loseHands,
  offsetTrackers,
  raiseNoise,
  resampleFrames,
  scheduleLosses,
  seedOf,
  type Tracker,
  type TrackingNoise,
} from './disturbances';
import type { RecordedFrame } from './recordings';

/** A piece of a recording with what its person calibrated. */
export interface Piece {
  /** Clip and first second: the seed of all that happens to it. */
  readonly name: string;
  readonly calibration: Calibration;
  readonly frames: readonly RecordedFrame[];
}

/** One frame as an estimator meets it. */
export interface StagedFrame extends RecordedFrame {
  /** The page forgets the past before it. */
  readonly reset?: true;
  /** Frames are missing before it. */
  readonly resumes?: true;
  /** From this frame's floor to that of the truth; left out: the same. */
  readonly truthFromFloor?: Transform<'floor', 'floor'>;
}

/** A piece with one thing done to it. */
export interface Staged {
  readonly calibration: Calibration;
  readonly rateHz: number;
  readonly frames: readonly StagedFrame[];
  readonly losses: readonly Loss[];
}

/** Does one thing to a piece at `rateHz`; `number` counts the pieces, where directions take turns. */
export type Stage = (piece: Piece, rateHz: number, number: number) => Staged;

/** Nothing is done to it. */
export const undisturbed: Stage = ({ calibration, frames }, rateHz) => ({ calibration, rateHz, frames, losses: [] });

/** Seconds of the losses; the page's tables and one between. */
const lossSeconds = [0.1, 0.5, 1, 2] as const;

/** Hides hands at times that the piece's name and the name of the losses seed. */
export const lost =
  (losses: string | number, lengthOf: LossLength): Stage =>
  (piece, rateHz) => {
    const scheduled = scheduleLosses(piece.frames.length, rateHz, lengthOf, seedOf(`${piece.name} ${losses}`));
    return { calibration: piece.calibration, rateHz, frames: loseHands(piece.frames, scheduled), losses: scheduled };
  };

/** Loses hands, but reports them as guessed at their last tracked position. */
const guessed =
  (seconds: number): Stage =>
  (piece, rateHz) => {
    const losses = scheduleLosses(
      piece.frames.length,
      rateHz,
      lasting(seconds),
      seedOf(`${piece.name} guessed ${seconds}`),
    );
    const frames = [...piece.frames];
    for (const { side, start, end } of losses) {
      const last = piece.frames[start - 1]?.frame[`${side}Hand`];
      if (!last) continue;
      for (let row = start; row < end; row++) {
        const { frame, truth } = frames[row] as RecordedFrame;
        frames[row] = { truth, frame: { ...frame, [`${side}Hand`]: { ...last, tracking: 'emulated' } } };
      }
    }
    return { calibration: piece.calibration, rateHz, frames, losses };
  };

export const axes = ['x', 'y', 'z'] as const;
export type Axis = (typeof axes)[number];

const directions = axes.flatMap((axis) => [-1, 1].map((sign) => ({ axis, sign })));

/** Mounts a tracker so far [m] elsewhere along an axis. */
export const mounted =
  (tracker: Tracker, axis: Axis, metres: number): Stage =>
  (piece, rateHz, number) => ({
    ...undisturbed(piece, rateHz, number),
    frames: offsetTrackers(piece.frames, tracker, { ...vec3(0, 0, 0), [axis]: metres }),
  });

/** Mounts a tracker so far [m] elsewhere, in another direction for every piece. */
const mountedInTurn =
  (tracker: Tracker, metres: number): Stage =>
  (piece, rateHz, number) => {
    const { axis, sign } = directions[number % directions.length]!;
    return mounted(tracker, axis, sign * metres)(piece, rateHz, number);
  };

/** Raises the noise of the simulated trackers to that of a device. */
export const noisy =
  (noise: TrackingNoise): Stage =>
  (piece, rateHz, number) => ({
    ...undisturbed(piece, rateHz, number),
    frames: raiseNoise(piece.frames, noise, seedOf(piece.name)),
  });

export const scaled =
  (key: 'eyeHeight' | 'armSpan', percent: number): Stage =>
  (piece, rateHz, number) => ({
    ...undisturbed(piece, rateHz, number),
    calibration: { ...piece.calibration, [key]: piece.calibration[key] * (1 + percent / 100) },
  });

/** A headset that sits tilted [rad] on the head, where the calibration knows it. */
const tilted =
  (gazePitch: number): Stage =>
  (piece, rateHz, number) => ({
    ...undisturbed(piece, rateHz, number),
    calibration: { ...piece.calibration, gazePitch },
    frames: piece.frames.map(({ frame, truth }) => {
      const orientation = multiply(frame.head.orientation, fromAxisAngle(right, gazePitch));
      return { truth, frame: { ...frame, head: { ...frame.head, orientation } } };
    }),
  });

export const atRate =
  (hz: number): Stage =>
  (piece, rateHz, number) => ({
    ...undisturbed(piece, hz, number),
    frames: resampleFrames(piece.frames, rateHz, hz),
  });

/** Numbers in [0, 1) of a text. */
const randomOf = (text: string): (() => number) => createRandom(seedOf(text));

/**
 * The wearer resets the reference space every three to five seconds: the floor turns and moves, and the page forgets
 * the past.
 */
const recentred: Stage = (piece, rateHz, number) => {
  const random = randomOf(`${piece.name} recentred`);
  const wait = () => Math.round((3 + 2 * random()) * rateHz);
  let next = wait();
  let floor: Transform<'floor', 'floor'> | null = null;
  const frames = piece.frames.map(({ frame, truth }, row): StagedFrame => {
    const reset = row === next;
    if (reset) {
      next = row + wait();
      const orientation = fromAxisAngle(up, (2 * random() - 1) * Math.PI);
      floor = { orientation, position: vec3(2 * random() - 1, 0, 2 * random() - 1) };
    }
    if (!floor) return { frame, truth };
    return { frame: onFloor(floor, frame), truth, truthFromFloor: invertTransform(floor), ...(reset && { reset }) };
  });
  return { ...undisturbed(piece, rateHz, number), frames };
};

function onFloor(floor: Transform<'floor', 'floor'>, frame: TrackingFrame): TrackingFrame {
  const moved = <P extends TrackedPose | null>(pose: P): P => pose && { ...pose, ...transformPose(floor, pose) };
  return { ...frame, head: moved(frame.head), leftHand: moved(frame.leftHand), rightHand: moved(frame.rightHand) };
}

/** The longest hitch, the system's menu, and the headset put down [s]. */
const pauses = [
  { seconds: 0.25, missing: true },
  { seconds: 1.5, missing: false },
  { seconds: 2, missing: true },
] as const;

/**
 * In turn: a hitch, a while in the device's own menu (head alone, hands are for no one), frames that stop for longer.
 */
const paused: Stage = (piece, rateHz, number) => {
  const random = randomOf(`${piece.name} paused`);
  const frames: StagedFrame[] = [];
  let turn = Math.floor(3 * random());
  let row = 0;
  while (row < piece.frames.length) {
    const run = Math.round((1.5 + random()) * rateHz);
    const resumes = row > 0 && pauses[(turn + 2) % 3]!.missing;
    piece.frames.slice(row, row + run).forEach((frame, index) => {
      frames.push(resumes && index === 0 ? { ...frame, resumes } : frame);
    });
    row += run;
    const { seconds, missing } = pauses[turn++ % 3]!;
    const length = Math.round(seconds * rateHz);
    if (!missing) {
      for (const { frame, truth } of piece.frames.slice(row, row + length)) {
        frames.push({ truth, frame: { ...frame, leftHand: null, rightHand: null, suspended: true } });
      }
    }
    row += length;
  }
  return { ...undisturbed(piece, rateHz, number), frames };
};

/** Everything that docs/accuracy.md measures and the page meets, by name. */
export const situations: Readonly<Record<string, Stage>> = {
  ...Object.fromEntries(lossSeconds.map((seconds) => [`hand lost ${seconds} s`, lost(seconds, lasting(seconds))])),
  'hand guessed 1 s': guessed(1),
  'headset ±3 cm': mountedInTurn('headset', 0.03),
  'grips ±3 cm': mountedInTurn('grips', 0.03),
  'headset tilted 12°': tilted(-0.21),
  'eye height −5 %': scaled('eyeHeight', -5),
  'eye height +5 %': scaled('eyeHeight', 5),
  'arm span −5 %': scaled('armSpan', -5),
  'arm span +5 %': scaled('armSpan', 5),
  '72 Hz': atRate(72),
  '90 Hz': atRate(90),
  '120 Hz': atRate(120),
  recentred,
  paused,
};
