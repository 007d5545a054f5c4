import { Body } from 'threepoint/api/body';
import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { createFrameLoop, type FrameParts } from 'threepoint-page/shell/frame-loop';
import { createFrameTiming } from 'threepoint-page/shell/frame-timing';
import { describe, expect, test } from 'vitest';

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
  const parts: FrameParts<string> = {
    track: (_, deviceFrame) => {
      calls.push(`track ${deviceFrame ?? 'desktop'}`);
      return tracked;
    },
    observe: () => void calls.push('observe'),
    estimate(frame) {
      calls.push(frame ? 'estimate' : 'estimate without tracking');
      return pose;
    },
    skin: () => void calls.push('skin'),
    render: (_, frame) => void calls.push(frame ? 'render' : 'render without tracking'),
    fail: (error) => void calls.push(`fail ${String(error)}`),
    ...change,
  };
  const body = new Body({ estimator: 'ik', events: { discontinuity: () => void calls.push('jumped') } });
  return {
    calls,
    loop: createFrameLoop(
      parts,
      body,
      createFrameTiming(() => 0),
    ),
  };
}

describe('one frame', () => {
  test('is drawn at once, of what this frame tracked', () => {
    const { loop, calls } = observedParts();
    loop(0, 'xr');
    expect(calls).toEqual(['track xr', 'observe', 'estimate', 'skin', 'render']);
  });

  test('without a tracked head the last body stays and the world is drawn', () => {
    const { loop, calls } = observedParts({ track: () => null });
    loop(0);
    expect(calls).toEqual(['estimate without tracking', 'render without tracking']);
  });

  test('after a pause what follows motion begins again, before anything of the frame is read', () => {
    const { loop, calls } = observedParts();
    loop(0);
    loop(400);
    expect(calls).not.toContain('jumped');
    calls.length = 0;
    loop(20_000);
    expect(calls.slice(0, 2)).toEqual(['jumped', 'track desktop']);
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
