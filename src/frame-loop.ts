import type { AvatarPose } from './core/body/avatar-pose';
import type { PoseEstimator } from './core/estimation/pose-estimator';
import type { PoseRegressor } from './core/estimation/pose-regressor';
import type { TrackingFrame } from './core/tracking/tracking-frame';
import type { FrameTiming } from './frame-timing';

/** The parts of one frame; the loop calls each once, in this order. */
export interface FrameParts<DeviceFrame> {
  /** Head and hands now, floor frame; null: the head was not seen, the body keeps its last pose. */
  track(timeMs: number, deviceFrame: DeviceFrame | undefined): TrackingFrame | null;
  /** Hears every tracked frame: recorder, calibration. */
  observe(frame: TrackingFrame): void;
  estimator(): PoseEstimator;
  /** Whether inference settles within the frame's microtasks, so that waiting for it costs no frame. */
  inferenceSettlesInFrame(): boolean;
  /** Does the task after this animation frame, when the picture is on its way, and before the next. */
  afterwards(task: () => void): void;
  /** Bends the body to the pose. */
  skin(pose: AvatarPose, frame: TrackingFrame): void;
  /** Draws, mirror included; frame: what was tracked, null where nothing was. */
  render(timeMs: number, frame: TrackingFrame | null): void;
  /** A part threw: the page says so; the next frame is tried all the same. */
  fail(error: unknown): void;
}

/**
 * One frame, stage by stage. Every device pose is read before the first await, and drawing follows within the same
 * animation frame: either what is awaited settles in microtasks, or nothing is, and the network is asked afterwards.
 */
export function createFrameLoop<DeviceFrame>(
  parts: FrameParts<DeviceFrame>,
  timing: FrameTiming,
): (timeMs: number, deviceFrame?: DeviceFrame) => Promise<void> {
  let begun = 0;

  /** What the next frame will draw, unless that one came first. */
  function askLater(estimator: PoseEstimator, frame: TrackingFrame): void {
    const during = begun;
    parts.afterwards(() => {
      if (begun !== during) return;
      timing.resume();
      void estimator.prepare(frame);
      timing.mark('features');
    });
  }

  return async (timeMs, deviceFrame) => {
    begun += 1;
    timing.begin(timeMs);
    try {
      const frame = parts.track(timeMs, deviceFrame);
      if (frame) parts.observe(frame);
      timing.mark('tracking');
      if (frame) {
        const estimator = parts.estimator();
        if (parts.inferenceSettlesInFrame()) {
          const prepared = estimator.prepare(frame);
          timing.mark('features');
          await prepared;
          timing.mark('inference');
        } else askLater(estimator, frame);
        const pose = estimator.estimate(frame);
        timing.mark('kinematics');
        parts.skin(pose, frame);
        timing.mark('skinning');
      }
      parts.render(timeMs, frame);
      timing.mark('render');
    } catch (error) {
      parts.fail(error);
    }
    timing.end();
  };
}

/**
 * The same regressor, with the time until `run` is called counted as features and what `run` takes as inference. A run
 * that outlives its frame is no cost of this thread: of it only the start counts.
 */
export function withTiming(regressor: PoseRegressor, timing: FrameTiming): PoseRegressor {
  return {
    contract: regressor.contract,
    // Live: a graphics device that is lost changes both.
    get provider() {
      return regressor.provider;
    },
    get resolvesInFrame() {
      return regressor.resolvesInFrame;
    },
    async run(features) {
      timing.mark('features');
      const running = regressor.run(features);
      // What it does before its first wait is over here; whoever called goes on before anything is awaited.
      timing.mark('inference');
      if (!regressor.resolvesInFrame) return running;
      const output = await running;
      timing.mark('inference');
      return output;
    },
    dispose: () => regressor.dispose(),
  };
}
