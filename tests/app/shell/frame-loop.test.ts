import { describe, expect, test } from 'vitest';
import { createFrameLoop, type FrameParts, withTiming } from '../../../src/app/shell/frame-loop';
import { createFrameTiming } from '../../../src/app/shell/frame-timing';
import type { AvatarPose } from '../../../src/core/body/avatar-pose';
import type { InferenceRequest, PoseEstimator } from '../../../src/core/estimation/pose-estimator';
import type { PoseRegressor } from '../../../src/core/estimation/pose-regressor';
import { createPageClock } from '../../../src/core/tracking/page-clock';
import type { TrackingFrame } from '../../../src/core/tracking/tracking-frame';

const head = {
  position: { x: 0, y: 1.6, z: 0 },
  orientation: { x: 0, y: 0, z: 0, w: 1 },
  tracking: 'tracked',
} as const;
const tracked: TrackingFrame = { time: 1, head, leftHand: null, rightHand: null };
const pose: AvatarPose = { head, leftHand: null, rightHand: null, body: null };

/** The parts of a frame, each of which writes its name down. */
function observedParts(change: Partial<FrameParts<string>> = {}) {
  const calls: string[] = [];
  const later: (() => void)[] = [];
  const request: InferenceRequest = {
    async ask() {
      calls.push('ask');
    },
  };
  const estimator: PoseEstimator = {
    name: 'learned',
    calibrate: () => void calls.push('calibrate'),
    reset: () => void calls.push('reset'),
    update: () => {
      calls.push('update');
      return { pose, request };
    },
    fault: () => null,
  };
  const parts: FrameParts<string> = {
    resumed: () => void calls.push('resumed'),
    track: (_, deviceFrame) => {
      calls.push(`track ${deviceFrame ?? 'desktop'}`);
      return tracked;
    },
    observe: () => void calls.push('observe'),
    estimator: () => estimator,
    afterwards: (task) => void later.push(task),
    skin: () => void calls.push('skin'),
    render: (_, frame) => void calls.push(frame ? 'render' : 'render without tracking'),
    fail: (error) => void calls.push(`fail ${String(error)}`),
    ...change,
  };
  return {
    parts,
    calls,
    later,
    loop: createFrameLoop(
      parts,
      createFrameTiming(() => 0),
      createPageClock(() => 0),
    ),
  };
}

describe('one frame', () => {
  test('is drawn at once, of what this frame tracked, and waits for no network', () => {
    const { loop, calls } = observedParts();
    loop(0, 'xr');
    expect(calls).toEqual(['track xr', 'observe', 'update', 'skin', 'render']);
  });

  test('asks its network when the picture is on its way', () => {
    const { loop, calls, later } = observedParts();
    loop(0);
    expect(calls).toEqual(['track desktop', 'observe', 'update', 'skin', 'render']);
    for (const task of later) task();
    expect(calls.at(-1)).toBe('ask');
  });

  test('asks for nothing that a newer frame has overtaken', () => {
    const { loop, calls, later } = observedParts();
    loop(0);
    loop(16);
    for (const task of later) task();
    expect(calls.filter((call) => call === 'ask')).toHaveLength(1);
  });

  test('without a tracked head the last body stays and the world is drawn', () => {
    const { loop, calls } = observedParts({ track: () => null });
    loop(0);
    expect(calls).toEqual(['render without tracking']);
  });

  test('after a pause what follows motion begins again, before anything of the frame is read', () => {
    const { loop, calls } = observedParts();
    loop(0);
    loop(400);
    expect(calls).not.toContain('resumed');
    calls.length = 0;
    loop(20_000);
    expect(calls.slice(0, 2)).toEqual(['resumed', 'track desktop']);
  });

  test('a part that throws is told of, and the next frame runs', () => {
    let broken = true;
    const { loop, calls } = observedParts({
      skin: () => {
        if (broken) throw new Error('no bones');
      },
    });
    loop(0);
    expect(calls.at(-1)).toBe('fail Error: no bones');
    broken = false;
    loop(1);
    expect(calls.at(-1)).toBe('render');
  });
});

test("what a run does before it first waits is inference, not the caller's features", async () => {
  let now = 0;
  const timing = createFrameTiming(() => now);
  const regressor = withTiming(
    {
      contract: {} as PoseRegressor['contract'],
      provider: 'wasm',
      async run(features) {
        now += 2;
        await Promise.resolve();
        now += 3;
        return features;
      },
      dispose: () => Promise.resolve(),
    },
    timing,
  );
  const { parts, later } = observedParts();
  const estimator: PoseEstimator = {
    ...parts.estimator(),
    update: () => ({
      pose,
      request: {
        async ask() {
          now += 1;
          await regressor.run(new Float32Array(1));
        },
      },
    }),
  };
  const loop = createFrameLoop(
    { ...parts, estimator: () => estimator },
    timing,
    createPageClock(() => 0),
  );
  loop(0);
  for (const task of later) task();
  // What is left for later counts with the next frame; what a run does elsewhere with none.
  loop(16);
  const { features, inference } = timing.summary().stages;
  expect([features.p50Ms, inference.p50Ms]).toEqual([1, 2]);
});
