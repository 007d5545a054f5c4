import { conjugate, multiply, type Quat, quat, slerp, writeQuat } from '../math/quat';
import mocapRules from './mocap-rules.json' with { type: 'json' };
import type { Piece } from './person';
import { bodyJoints, trackedJoints } from './skeleton-map';
import { positionsWidth, rotationAt, rotationsWidth, type TruthMotion } from './truth-motion';

const { rateHz, shortestPieceSeconds, teleportSpeed } = mocapRules;

/** Returns the frames at which a motion jumps, and the pieces between them that are long enough to be motion. */
export function splitAtJumps({ positions, rateHz: rate, frameCount }: TruthMotion): {
  readonly cuts: readonly number[];
  readonly pieces: readonly Piece[];
} {
  const cuts: number[] = [];
  for (let frame = 1; frame < frameCount; frame++) {
    const at = frame * positionsWidth;
    for (let i = 0; i < 3 * bodyJoints.length; i += 3) {
      const [x, y, z] = [0, 1, 2].map((axis) => positions[at + i + axis]! - positions[at - positionsWidth + i + axis]!);
      if (Math.hypot(x!, y!, z!) * rate <= teleportSpeed) continue;
      cuts.push(frame);
      break;
    }
  }
  const bounds = [0, ...cuts, frameCount];
  const shortest = Math.max(4, Math.round(shortestPieceSeconds * rate));
  const pieces = bounds.slice(1).map((to, i) => ({ from: bounds[i]!, to }));
  return { cuts, pieces: pieces.filter(({ from, to }) => to - from >= shortest) };
}

/** A piece of a motion at 60 Hz in single precision, with the numbers of `TruthMotion`. */
export interface ResampledClip {
  readonly frameCount: number;
  readonly positions: Float32Array<ArrayBuffer>;
  readonly rotations: Float32Array<ArrayBuffer>;
}

// Scratch of `resampleClip`: a joint's rotations in the two frames that are mixed.
const rotationBefore = quat(0, 0, 0, 1);
const rotationAfter = quat(0, 0, 0, 1);

/**
 * Returns the piece at 60 Hz: every nth frame where that is exact, else interpolated; relative to a floor at this
 * height [m], its head turned back by `neutral`.
 */
export function resampleClip(motion: TruthMotion, { from, to }: Piece, floor: number, neutral: Quat): ResampledClip {
  const { positions, rateHz: rate } = motion;
  const length = to - from;
  const step = rate / rateHz;
  const every = Math.abs(step - Math.round(step)) < 1e-3 && step >= 1 ? Math.round(step) : null;
  const frameCount = every ? Math.ceil(length / every) : Math.floor(((length - 1) / rate) * rateHz) + 1;
  const clip: ResampledClip = {
    frameCount,
    positions: new Float32Array(frameCount * positionsWidth),
    rotations: new Float32Array(frameCount * rotationsWidth),
  };
  const back = conjugate(neutral);
  for (let frame = 0; frame < frameCount; frame++) {
    const time = every ? frame * every : (frame / rateHz) * rate;
    const before = Math.min(Math.floor(time), Math.max(0, length - 2));
    const fraction = time - before;
    const [first, second] = [from + before, from + Math.min(before + 1, length - 1)];
    for (let i = 0; i < positionsWidth; i++) {
      const value =
        positions[first * positionsWidth + i]! * (1 - fraction) + positions[second * positionsWidth + i]! * fraction;
      clip.positions[frame * positionsWidth + i] = i % 3 === 1 ? value - floor : value;
    }
    for (let joint = 0; joint < trackedJoints.length; joint++) {
      rotationAt(motion, first, joint, rotationBefore);
      rotationAt(motion, second, joint, rotationAfter);
      const turn = slerp(rotationBefore, rotationAfter, fraction, rotationBefore);
      if (joint === 0) multiply(turn, back, turn);
      writeQuat(turn, clip.rotations, frame * rotationsWidth + 4 * joint);
    }
  }
  return clip;
}
