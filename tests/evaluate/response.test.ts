import type { TrackingFrame } from 'threepoint/core';
import { dampVec3, type Vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import type { Driver } from '../../bench/evaluate/drive';
import { measureResponse, measureTremble } from '../../bench/evaluate/response';

/** A body whose one joint is the right hand, as a filter lets it be drawn. */
const drawing = (filter: (hand: Vec3, frame: TrackingFrame) => Vec3): Driver => ({
  draw: async (frame) => ({ joints: { hand: filter(frame.rightHand!.position, frame) }, raw: null }),
  reset: () => undefined,
});

test('a joint that is drawn three frames late is 50 ms late at any frequency', async () => {
  const late = () => {
    const past: Vec3[] = [];
    return drawing((hand) => {
      past.push(hand);
      return past.at(-4) ?? hand;
    });
  };
  for (const response of await measureResponse(late, 'rightHand', [1, 3], ['hand'])) {
    // The slow wave that all is measured against is late by as much of its ten seconds.
    expect(response.hand?.lagMs).toBeGreaterThan(43);
    expect(response.hand?.lagMs).toBeLessThan(50.1);
    expect(response.hand?.gain).toBeCloseTo(1, 3);
  }
});

test('a damped joint goes less far the quicker the wave is', async () => {
  const halfLife = 0.1;
  const damped = () => {
    let shown: Vec3 | null = null;
    return drawing((hand) => {
      shown = shown === null ? hand : dampVec3(shown, hand, halfLife, 1 / 60);
      return shown;
    });
  };
  const [slow, quick] = await measureResponse(damped, 'rightHand', [1, 3], ['hand']);
  const gain = (hz: number) => 1 / Math.hypot(1, (2 * Math.PI * hz * halfLife) / Math.LN2);
  expect(slow?.hand?.gain).toBeCloseTo(gain(1), 1);
  expect(quick?.hand?.gain).toBeCloseTo(gain(3), 1);
});

test('a joint that does not follow the point has no lag', async () => {
  const [response] = await measureResponse(() => drawing((hand) => hand), 'head', [1], ['hand']);
  expect(response?.hand).toBeNull();
});

test('a joint on a hand’s tracker trembles with its noise: 0.15 mm by axis between frames', async () => {
  const { hand } = await measureTremble(
    drawing((position) => position),
    ['hand'],
  );
  expect(hand).toBeCloseTo(0.15 * Math.sqrt(2 * 3), 2);
});
