import type { Body } from 'threepoint';
import type { AvatarPose, TrackingFrame } from 'threepoint/core';
import type { FrameTiming } from './session/frame-timing';

/** The page's steps of a frame. The loop calls each once, in this order, all with the same time on the body's clock. */
export interface FrameParts<DeviceFrame> {
  /** Head and hands at this time [s], floor frame; null: the head was not seen, the body keeps its last pose. */
  track(time: number, deviceFrame: DeviceFrame | undefined): TrackingFrame | null;
  /** Passes a tracked frame to recorder, calibration and games. */
  observe(frame: TrackingFrame): void;
  /** The body of this frame; null: there was none yet. */
  estimate(frame: TrackingFrame | null): AvatarPose | null;
  /** Bends the avatar to the pose. */
  skin(pose: AvatarPose, frame: TrackingFrame): void;
  /** Draws, mirror included; frame: what was tracked, null where nothing was. */
  render(time: number, frame: TrackingFrame | null): void;
  /** A step threw: the page reports it and continues with the next frame. */
  fail(error: unknown): void;
}

/** One frame of the page, stage by stage, each with its time. It waits for nothing. */
export function createFrameLoop<DeviceFrame>(
  parts: FrameParts<DeviceFrame>,
  body: Pick<Body, 'tick'>,
  timing: FrameTiming,
): (timestampMs: number, deviceFrame?: DeviceFrame) => void {
  return (timestampMs, deviceFrame) => {
    try {
      const time = body.tick(timestampMs);
      timing.begin(time * 1000);
      const frame = parts.track(time, deviceFrame);
      if (frame) parts.observe(frame);
      timing.mark('tracking');
      const pose = parts.estimate(frame);
      timing.mark('kinematics');
      if (frame && pose) parts.skin(pose, frame);
      timing.mark('skinning');
      parts.render(time, frame);
      timing.mark('render');
    } catch (error) {
      parts.fail(error);
    }
    timing.end();
  };
}
