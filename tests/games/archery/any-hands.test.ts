import fc from 'fast-check';
import { length, type Side } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { maximumDraw } from '../../../src/games/archery/bow';
import { ArcheryGestures, defaultArcheryGestureSettings } from '../../../src/games/archery/gestures';
import { evenly, rotation, seed } from '../../threepoint/core/arbitraries';
import { posed } from './bowman';

const sides: readonly Side[] = ['left', 'right'];

describe('any hands at all', () => {
  const anyHand = fc.option(
    fc.record({
      position: fc.record({ x: evenly(-0.6, 0.6), y: evenly(0.9, 1.7), z: evenly(-0.9, 0.3) }),
      orientation: rotation,
      tracking: fc.constantFrom('tracked' as const, 'tracked' as const, 'emulated' as const),
    }),
    { nil: null },
  );
  const pressure = fc.oneof(fc.constantFrom(0, 1), evenly(0, 1));
  const pressures = fc.record({ trigger: pressure, grip: fc.constant<number>(0), pinch: fc.constant<number>(0) });
  /** Mostly an archer who nocks, draws and lets go in some order, with everything that can go wrong in between. */
  const moment = fc.record({
    seconds: fc.oneof({ weight: 8, arbitrary: evenly(0.005, 0.03) }, { weight: 1, arbitrary: evenly(-0.1, 1) }),
    frames: fc.integer({ min: 1, max: 8 }),
    draw: fc.oneof(fc.constantFrom(0, 0.02, 0.5), evenly(-0.3, 0.9)),
    wild: fc.oneof(
      { weight: 12, arbitrary: fc.constant(null) },
      { weight: 1, arbitrary: fc.record({ leftHand: anyHand, rightHand: anyHand }) },
    ),
    left: pressures,
    right: pressures,
    settings: fc.oneof(
      { weight: 12, arbitrary: fc.constant(null) },
      {
        weight: 1,
        arbitrary: fc.record({
          bowSide: fc.constantFrom<Side>('left', 'right'),
          oneHanded: fc.boolean(),
          armed: fc.constantFrom(true, true, false),
        }),
      },
    ),
  });
  type Moment = typeof moment extends fc.Arbitrary<infer T> ? T : never;
  /** A whole shot as it should be; the moments of chance come between its parts. */
  const attempt = fc
    .record({
      side: fc.constantFrom<Side>('left', 'right'),
      oneHanded: fc.constantFrom(false, false, true),
      draw: evenly(0.1, 0.8),
      chance: fc.array(fc.tuple(fc.integer({ min: 0, max: 3 }), moment), { maxLength: 3 }),
    })
    .map(({ side, oneHanded, draw, chance }): Moment[] => {
      const settings = { bowSide: side, oneHanded, armed: true };
      const held = (trigger: number) => ({ trigger, grip: 0, pinch: 0 });
      const part = (at: number, pressed: number, frames: number): Moment => ({
        ...{ seconds: 1 / 90, wild: null, settings, draw: at, frames },
        ...{ left: held(pressed), right: held(pressed) },
      });
      const parts = [part(0, 0, 2), part(0, 1, 2), part(draw, 1, 40), part(draw, 0, 3)];
      return parts.flatMap((whole, i) => [whole, ...chance.flatMap(([after, what]) => (after === i ? [what] : []))]);
    });

  test('make finite views and actions, and shots only of nocked arrows by hands that are seen', {
    tags: ['full'],
  }, () => {
    let shots = 0;
    let cancelled = 0;
    fc.assert(
      fc.property(fc.array(attempt, { minLength: 1, maxLength: 6 }), (attempts) => {
        let settings = defaultArcheryGestureSettings;
        const gestures = new ArcheryGestures(() => settings);
        let time = 100;
        let onString = false;
        for (const { seconds, frames, draw, wild, left, right, settings: change } of attempts.flat()) {
          settings = { ...settings, ...change };
          for (let i = 0; i < frames; i++) {
            time += seconds;
            const frame = { ...posed(time, { draw, bowSide: settings.bowSide }), ...wild };
            const { bow, actions, cues, haptics } = gestures.follow(frame, { left, right });
            for (const action of actions) {
              if (action.type !== 'release') continue;
              shots += 1;
              expect(onString).toBe(true);
              expect(length(action.direction)).toBeCloseTo(1, 9);
              expect(Number.isFinite(length(action.position) + action.draw)).toBe(true);
              const needed = settings.oneHanded ? [bow!.bowSide] : sides;
              for (const side of needed) expect(frame[`${side}Hand`]?.tracking).toBe('tracked');
            }
            for (const { type } of cues) {
              if (type === 'nocked') onString = true;
              if (type === 'released' || type === 'cancelled') onString = false;
              if (type === 'cancelled') cancelled += 1;
            }
            if (bow) {
              const { x, y, z, w } = bow.bow.orientation;
              expect(Math.hypot(x, y, z, w)).toBeCloseTo(1, 9);
              expect(Number.isFinite(length(bow.bow.position) + length(bow.nockPoint))).toBe(true);
              expect(bow.draw).toBeGreaterThanOrEqual(0);
              expect(bow.draw).toBeLessThanOrEqual(maximumDraw);
              expect(bow.arrow === null).toBe(bow.stage === 'empty');
            }
            expect(onString).toBe(bow !== null && bow.stage !== 'empty');
            for (const { strength } of haptics) {
              expect(strength).toBeGreaterThanOrEqual(0);
              expect(strength).toBeLessThanOrEqual(1);
            }
          }
        }
      }),
      { seed, numRuns: 60 },
    );
    expect(shots).toBeGreaterThan(30);
    expect(cancelled).toBeGreaterThan(30);
  });
});
