import { Body } from 'threepoint';
import type { AvatarPose, TrackingFrame } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { createFrameLoop, type FrameParts } from '../../../src/page/shell/frame-loop';
import { FrameTiming } from '../../../src/page/shell/session/frame-timing';
import { headFrame } from '../frames';

/** A frame whose head is as high [m] as its time [s] is long. */
const trackedAt = (time: number) => headFrame(time, time);
const poseOf = ({ head }: TrackingFrame): AvatarPose => ({ head, leftHand: null, rightHand: null, body: null });

/** A loop and what its parts received: times and heights of heads. */
function running(change: Partial<FrameParts<undefined>> = {}) {
  const seen = {
    observed: [] as number[],
    skinned: [] as number[],
    rendered: [] as (number | undefined)[],
    failures: [] as unknown[],
    jumps: 0,
    jumpsBeforeTracking: 0,
  };
  const parts: FrameParts<undefined> = {
    track: (time) => {
      seen.jumpsBeforeTracking = seen.jumps;
      return trackedAt(time);
    },
    observe: ({ time }) => void seen.observed.push(time),
    estimate: (frame) => frame && poseOf(frame),
    skin: ({ head }) => void seen.skinned.push(head.position.y),
    render: (_, frame) => void seen.rendered.push(frame?.time),
    fail: (error) => void seen.failures.push(error),
    ...change,
  };
  const discontinuity = () => {
    seen.jumps += 1;
  };
  const body = new Body({ estimator: 'ik' });
  body.addEventListener('discontinuity', discontinuity);
  const timing = new FrameTiming(() => 0);
  return { seen, loop: createFrameLoop(parts, body, timing) };
}

describe('one frame', () => {
  test('shows the body that it tracked itself', () => {
    const { loop, seen } = running();
    for (const milliseconds of [0, 16, 32]) loop(milliseconds);
    expect(seen.rendered).toHaveLength(3);
    expect(new Set(seen.rendered).size).toBe(3);
    expect(seen.observed).toEqual(seen.rendered);
    expect(seen.skinned).toEqual(seen.rendered);
    expect(seen.failures).toEqual([]);
  });

  test('without a tracked head leaves the last body and draws the world', () => {
    const { loop, seen } = running({ track: () => null, estimate: () => poseOf(trackedAt(1)) });
    loop(0);
    expect(seen).toMatchObject({ observed: [], skinned: [], rendered: [undefined] });
  });

  test('after a pause resets what follows motion before it tracks', () => {
    const { loop, seen } = running();
    loop(0);
    loop(400);
    expect(seen.jumps).toBe(0);
    loop(20_000);
    expect(seen.jumpsBeforeTracking).toBe(1);
  });

  test('reports a part that throws, and the next frame runs', () => {
    const failure = new Error('no bones');
    let broken = true;
    const { loop, seen } = running({
      skin: () => {
        if (broken) throw failure;
      },
    });
    loop(0);
    expect(seen).toMatchObject({ failures: [failure], rendered: [] });
    broken = false;
    loop(1);
    expect(seen.failures).toHaveLength(1);
    expect(seen.rendered).toHaveLength(1);
  });
});
