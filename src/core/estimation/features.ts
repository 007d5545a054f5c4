import { estimatedJoints } from '../body/joints';
import type { ChestSpaceBody } from '../body/skeleton';
import type { Pose } from '../math/pose';
import { rotate } from '../math/quat';
import { right, up } from '../math/vec3';
import type { JointPositions } from './joint-positions';
import type { ThreePoints } from './solve-ik';

/** Numbers per frame; their order is in docs/estimation.md. */
export const featureCount = 46;

/** Where in a frame's features begin the head's turn, left and right wrist − headset [arm lengths] (their turn follows), the IK joints − headset [eye heights]. */
export const [headFeature, leftHandFeature, rightHandFeature, ikFeatureOffset] = [1, 7, 16, 27];
/** From a wrist to its turn. */
export const firstAxisFeature = 3;
/** Arm length in eye heights. */
export const armFeature = 45;

/**
 * One frame's features from three points and the IK solution, both in this frame's heading frame. seen: 1 where the device saw
 * the hand in this frame, else 0.
 */
export function frameFeatures(
  points: ThreePoints,
  seen: { readonly left: boolean; readonly right: boolean },
  ikJoints: JointPositions,
  body: ChestSpaceBody,
): Float32Array {
  const features = new Float32Array(featureCount);
  const headset = points.head.position;
  let next = 0;
  const write = (x: number, y: number, z: number): void => {
    features[next++] = x;
    features[next++] = y;
    features[next++] = z;
  };
  const writeTurn = ({ orientation }: Pose<'heading'>): void => {
    for (const axis of [right, up]) {
      const column = rotate(orientation, axis);
      write(column.x, column.y, column.z);
    }
  };
  features[next++] = headset.y / body.eyeHeight;
  writeTurn(points.head);
  for (const hand of [points.leftHand, points.rightHand]) {
    const { x, y, z } = hand.position;
    write((x - headset.x) / body.arm, (y - headset.y) / body.arm, (z - headset.z) / body.arm);
    writeTurn(hand);
  }
  features[next++] = seen.left ? 1 : 0;
  features[next++] = seen.right ? 1 : 0;
  for (const joint of estimatedJoints) {
    const { x, y, z } = ikJoints[joint];
    write((x - headset.x) / body.eyeHeight, (y - headset.y) / body.eyeHeight, (z - headset.z) / body.eyeHeight);
  }
  features[next] = body.arm / body.eyeHeight;
  return features;
}

/** The recent frames' features, read at ages in seconds, so that a window means the same at 60, 72 and 120 Hz. */
export interface FeatureWindow {
  /** Appends a frame; a time that does not advance replaces the newest. */
  push(timeSeconds: number, features: Float32Array): void;
  /** Features at `ages` before the newest frame, concatenated; linear between frames, the oldest before the start. */
  read(ages: readonly number[]): Float32Array;
  clear(): void;
}

export function createFeatureWindow(longestAgeSeconds: number): FeatureWindow {
  let frames: { readonly time: number; readonly features: Float32Array }[] = [];
  return {
    push(time, features) {
      const newest = frames.at(-1);
      if (newest && time < newest.time - longestAgeSeconds) frames = [];
      while (frames.length > 0 && frames.at(-1)!.time >= time) frames.pop();
      frames.push({ time, features });
      // One frame beyond the longest age stays, to interpolate from.
      while (frames.length > 2 && frames[1]!.time < time - longestAgeSeconds) frames.shift();
    },
    read(ages) {
      const newest = frames.at(-1);
      const result = new Float32Array(ages.length * featureCount);
      if (!newest) return result;
      ages.forEach((age, slot) => {
        const wanted = Math.max(newest.time - age, frames[0]!.time);
        let after = frames.length - 1;
        while (after > 0 && frames[after - 1]!.time >= wanted) after -= 1;
        const late = frames[after]!;
        const early = frames[Math.max(0, after - 1)]!;
        const gap = late.time - early.time;
        const share = gap > 0 ? (wanted - early.time) / gap : 1;
        for (let i = 0; i < featureCount; i++) {
          result[slot * featureCount + i] = early.features[i]! * (1 - share) + late.features[i]! * share;
        }
      });
      return result;
    },
    clear() {
      frames = [];
    },
  };
}
