import type { AvatarPose } from '../../core/body/avatar-pose';
import type { InferenceRequest, PoseEstimator } from '../../core/estimation/pose-estimator';
import type { PoseRegressor } from '../../core/estimation/pose-regressor';
import type { PageClock } from '../../core/tracking/page-clock';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import type { FrameTiming } from './frame-timing';

/** The parts of one frame; the loop calls each once, in this order. All of them hear the same time, the page clock's. */
export interface FrameParts<DeviceFrame> {
  /** A pause lies before this frame: what follows motion begins again. */
  resumed(): void;
  /** Head and hands at this time of the page's clock [s], floor frame; null: the head was not seen, the body keeps its last pose. */
  track(time: number, deviceFrame: DeviceFrame | undefined): TrackingFrame | null;
  /** Hears every tracked frame: recorder, calibration. */
  observe(frame: TrackingFrame): void;
  estimator(): PoseEstimator;
  /** Does the task after this animation frame, when the picture is on its way, and before the next. */
  afterwards(task: () => void): void;
  /** Bends the body to the pose. */
  skin(pose: AvatarPose, frame: TrackingFrame): void;
  /** Draws, mirror included; frame: what was tracked, null where nothing was. */
  render(time: number, frame: TrackingFrame | null): void;
  /** A part threw: the page says so; the next frame is tried all the same. */
  fail(error: unknown): void;
}

/** One frame, stage by stage. It waits for nothing: the network is asked afterwards, and its answer is for a later frame. */
export function createFrameLoop<DeviceFrame>(
  parts: FrameParts<DeviceFrame>,
  timing: FrameTiming,
  clock: Pick<PageClock, 'frame' | 'paused'>,
): (timestampMs: number, deviceFrame?: DeviceFrame) => void {
  let begun = 0;

  /** Asks once the picture is on its way, unless the next frame comes first. */
  function askLater(request: InferenceRequest): void {
    const during = begun;
    parts.afterwards(() => {
      if (begun !== during) return;
      timing.resume();
      void request.ask();
      timing.mark('features');
    });
  }

  return (timestampMs, deviceFrame) => {
    begun += 1;
    const time = clock.frame(timestampMs);
    timing.begin(time * 1000);
    try {
      if (clock.paused) parts.resumed();
      const frame = parts.track(time, deviceFrame);
      if (frame) parts.observe(frame);
      timing.mark('tracking');
      if (frame) {
        const { pose, request } = parts.estimator().update(frame);
        timing.mark('kinematics');
        if (request) askLater(request);
        parts.skin(pose, frame);
        timing.mark('skinning');
      }
      parts.render(time, frame);
      timing.mark('render');
    } catch (error) {
      parts.fail(error);
    }
    timing.end();
  };
}

/**
 * The same regressor, with the time until `run` is called counted as features and what `run` takes before its first wait as
 * inference: a run that goes on elsewhere is no cost of this thread.
 */
export function withTiming(regressor: PoseRegressor, timing: FrameTiming): PoseRegressor {
  return {
    contract: regressor.contract,
    // Live: it changes with a graphics device that is lost.
    get provider() {
      return regressor.provider;
    },
    run(features) {
      timing.mark('features');
      const running = regressor.run(features);
      timing.mark('inference');
      return running;
    },
    dispose: () => regressor.dispose(),
  };
}
