import type { Calibration } from '../body/calibration';
import type { Side } from '../body/joints';
import { chestSpaceBody, sideSign } from '../body/skeleton';
import { clamp, smoothstep } from '../math/damper';
import { type Pose, transformPose } from '../math/pose';
import { conjugate, fromAxes, identity, multiply, type Quat, slerp } from '../math/quat';
import { add, distance, length, lerp, scale, subtract, type Vec3, vec3 } from '../math/vec3';
import { floorFromHeading, headingFromFloor } from './heading';
import type { TrackedPose, TrackingFrame } from './tracking-frame';

/** Where a hand is taken to be: always somewhere, whether the device sees it or not. */
export type ContinuedHand = Pose<'floor'> & {
  /** Seen in this frame: `tracked`, neither null nor emulated. */
  readonly seen: boolean;
};

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
/** A returning or sinking hand moves at most this fast on its own: under 5 cm in a frame at 60 Hz, at the peak of the ease. */
const easeSpeed = 1.9;

interface HandMemory {
  /** As shown last, heading frame. */
  shown: Pose<'heading'>;
  /** Where the loss began, heading frame, and when; null while seen. */
  lost: { readonly pose: Pose<'heading'>; readonly time: number } | null;
  /** What the return has to bridge: shown = seen + offset at `time`; null when bridged. */
  bridge: { readonly offset: Vec3; readonly turn: Quat; readonly time: number } | null;
}

/** The one place that decides what a lost hand does: hold, sink to rest beside the hip, blend back when it returns. */
export interface HandContinuity {
  follow(frame: TrackingFrame): ContinuedFrame;
  reset(): void;
}

/** A relaxed arm in the heading frame: the wrist beside the thigh, the back of the hand outward, fingers down. */
export function restingHand(side: Side, headHeight: number, calibration: Calibration): Pose<'heading'> {
  const body = chestSpaceBody(calibration);
  const sigma = sideSign(side);
  const shoulder = headHeight - body.eyesInHead.y - body.neckToHead.y + body.clavicle.y;
  return {
    position: vec3(
      sigma * (body.clavicleRoot.x + body.clavicle.x + 0.05 * body.eyeHeight),
      Math.max(shoulder - 0.96 * body.arm, 0.06 * body.eyeHeight),
      0.02 * body.eyeHeight,
    ),
    orientation: fromAxes(vec3(0, 0, sigma), vec3(sigma, 0, 0), vec3(0, 1, 0)),
  };
}

const easeDuration = (shortest: number, way: number): number => Math.max(shortest, way / easeSpeed);

/** One per avatar; frames in order of time. Before a hand was ever seen it rests. */
export function createHandContinuity(calibration: () => Calibration): HandContinuity {
  const memories: Record<Side, HandMemory | null> = { left: null, right: null };

  function followHand(side: Side, tracked: TrackedPose | null, frame: TrackingFrame): ContinuedHand {
    const fromFloor = headingFromFloor(frame.head);
    const toFloor = floorFromHeading(frame.head);
    const rest = restingHand(side, frame.head.position.y, calibration());
    const seen = tracked !== null && tracked.tracking === 'tracked';
    const memory = memories[side] ?? {
      shown: rest,
      lost: { pose: rest, time: Number.NEGATIVE_INFINITY },
      bridge: null,
    };

    if (seen) {
      const now = transformPose(fromFloor, tracked);
      if (memories[side] === null) memory.lost = null;
      if (memory.lost) {
        memory.bridge = {
          offset: subtract(memory.shown.position, now.position),
          turn: multiply(conjugate(now.orientation), memory.shown.orientation),
          time: frame.time,
        };
        memory.lost = null;
      }
      memory.shown = now;
      if (memory.bridge) {
        const { offset, turn, time } = memory.bridge;
        const share = smoothstep(0, easeDuration(blendSeconds, length(offset)), frame.time - time);
        if (share >= 1) memory.bridge = null;
        memory.shown = {
          position: add(now.position, scale(offset, 1 - share)),
          orientation: multiply(now.orientation, slerp(turn, identity, share)),
        };
      }
    } else {
      memory.bridge = null;
      memory.lost ??= { pose: memory.shown, time: frame.time };
      const { pose, time } = memory.lost;
      const duration = easeDuration(easeSeconds, distance(pose.position, rest.position));
      const share = smoothstep(holdSeconds, holdSeconds + duration, clamp(frame.time - time, 0, 1e6));
      memory.shown = {
        position: lerp(pose.position, rest.position, share),
        orientation: slerp(pose.orientation, rest.orientation, share),
      };
    }
    memories[side] = memory;
    return seen && !memory.bridge
      ? { position: tracked.position, orientation: tracked.orientation, seen }
      : { ...transformPose(toFloor, memory.shown), seen };
  }

  return {
    follow: (frame) => ({
      time: frame.time,
      head: frame.head,
      leftHand: followHand('left', frame.leftHand, frame),
      rightHand: followHand('right', frame.rightHand, frame),
    }),
    reset() {
      memories.left = null;
      memories.right = null;
    },
  };
}
