import { describe, expect, test } from 'vitest';
import type { AvatarPose } from '../src/core/body/avatar-pose';
import type { PoseEstimator } from '../src/core/estimation/pose-estimator';
import type { PoseRegressor } from '../src/core/estimation/pose-regressor';
import type { TrackingFrame } from '../src/core/tracking/tracking-frame';
import { createFrameLoop, type FrameParts, withTiming } from '../src/frame-loop';
import { createFrameTiming } from '../src/frame-timing';

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
  const estimator: PoseEstimator = {
    name: 'learned',
    calibrate: () => void calls.push('calibrate'),
    reset: () => void calls.push('reset'),
    prepare: async () => {
      calls.push('prepare');
      await Promise.resolve();
      calls.push('prepared');
    },
    rawJoints: () => null,
    fault: () => null,
    estimate: () => {
      calls.push('estimate');
      return pose;
    },
  };
  const parts: FrameParts<string> = {
    track: (_, deviceFrame) => {
      calls.push(`track ${deviceFrame ?? 'desktop'}`);
      return tracked;
    },
    observe: () => void calls.push('observe'),
    estimator: () => estimator,
    inferenceSettlesInFrame: () => true,
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
    ),
  };
}

describe('one frame', () => {
  test('reads the device before anything is awaited, and draws what this frame tracked', async () => {
    const { loop, calls } = observedParts();
    const frame = loop(0, 'xr');
    expect(calls).toEqual(['track xr', 'observe', 'prepare']);
    await frame;
    expect(calls).toEqual(['track xr', 'observe', 'prepare', 'prepared', 'estimate', 'skin', 'render']);
  });

  test('waits for no inference that outlives the frame, and asks for it when the picture is drawn', () => {
    const { loop, calls, later } = observedParts({ inferenceSettlesInFrame: () => false });
    void loop(0);
    expect(calls).toEqual(['track desktop', 'observe', 'estimate', 'skin', 'render']);
    for (const task of later) task();
    expect(calls.at(-1)).toBe('prepare');
  });

  test('asks for nothing that a newer frame has overtaken', () => {
    const { loop, calls, later } = observedParts({ inferenceSettlesInFrame: () => false });
    void loop(0);
    void loop(16);
    for (const task of later) task();
    expect(calls.filter((call) => call === 'prepare')).toHaveLength(1);
  });

  test('without a tracked head the last body stays and the world is drawn', async () => {
    const { loop, calls } = observedParts({ track: () => null });
    await loop(0);
    expect(calls).toEqual(['render without tracking']);
  });

  test('a part that throws is told of, and the next frame runs', async () => {
    let broken = true;
    const { loop, calls } = observedParts({
      skin: () => {
        if (broken) throw new Error('no bones');
      },
    });
    await loop(0);
    expect(calls.at(-1)).toBe('fail Error: no bones');
    broken = false;
    await loop(1);
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
      resolvesInFrame: true,
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
  const { parts } = observedParts();
  const estimator: PoseEstimator = {
    ...parts.estimator(),
    async prepare() {
      now += 1;
      await regressor.run(new Float32Array(1));
    },
  };
  await createFrameLoop({ ...parts, estimator: () => estimator }, timing)(0);
  const { features, inference } = timing.summary().stages;
  expect([features.p50Ms, inference.p50Ms]).toEqual([1, 5]);
});
