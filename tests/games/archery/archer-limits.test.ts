import fc from 'fast-check';
import { addScaled, length, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import type { ArcheryAction, ArcheryState } from '../../../src/games/archery/archery-state';
import { arrowLength, maximumDraw, minimumDraw } from '../../../src/games/archery/bow';
import { archeryRules, releaseInterval } from '../../../src/games/archery/rules';
import { seed } from '../../threepoint/core/arbitraries';
import { numbersIn } from '../../threepoint/core/numbers-in';
import { highShot, shotAt, start, tickSeconds, told } from './shots';

describe('the limits of an archer', () => {
  const shot = (state: ArcheryState) => shotAt(state, 1) as Extract<ArcheryAction, { type: 'release' }>;
  const far = addScaled(vec3(0, 1.6, 0), vec3(0, 0, -1), 3);

  test.each<[string, (state: ArcheryState) => ArcheryAction]>([
    ['a position that is no number', (s) => ({ ...shot(s), position: vec3(Number.NaN, 1, 0) })],
    ['an endless direction', (s) => ({ ...shot(s), direction: vec3(0, 0, Number.NEGATIVE_INFINITY) })],
    ['a direction that makes arrows faster', (s) => ({ ...shot(s), direction: vec3(0, 0, -3) })],
    ['no direction', (s) => ({ ...shot(s), direction: vec3(0, 0, 0) })],
    ['a draw that is no number', (s) => ({ ...shot(s), draw: Number.NaN })],
    ['an endless draw', (s) => ({ ...shot(s), draw: Number.POSITIVE_INFINITY })],
    ['a draw too short to shoot', (s) => ({ ...shot(s), draw: minimumDraw - 0.01 })],
    ['a push', (s) => ({ ...shot(s), draw: -0.5 })],
    ['a delay before the tick', (s) => ({ ...shot(s), delay: -0.001 })],
    ['a delay beyond the tick', (s) => ({ ...shot(s), delay: tickSeconds })],
    ['a delay that is no number', (s) => ({ ...shot(s), delay: Number.NaN })],
    ['a release far from the head', (s) => ({ ...shot(s), position: far })],
  ])('%s shoots nothing', (_, action) => {
    const match = told(start());
    match.step({ type: 'start' }, action(match.state));
    expect(match.state).toMatchObject({ arrowsLeft: 5, arrows: [] });
    expect(match.happened('released')).toEqual([]);
  });

  test('a draw beyond the bow shoots as fast as the bow can', () => {
    const match = told(start());
    match.step({ ...shot(match.state), draw: 3 });
    expect(length(match.state.arrows[0]!.release.velocity)).toBeCloseTo(75.894 * maximumDraw, 2);
  });

  test('arrows follow each other at half a second at the earliest', () => {
    const match = told(start());
    match.step(shot(match.state), shot(match.state));
    match.pass(releaseInterval - 3 * tickSeconds);
    match.step(shot(match.state));
    expect(match.state.arrowsLeft).toBe(4);
    match.pass(3 * tickSeconds);
    match.step(shot(match.state));
    expect(match.state.arrowsLeft).toBe(3);
  });

  test('a sixth arrow is refused', () => {
    const match = told(start());
    for (let i = 0; i < 4; i++) match.shoot(0);
    // The fifth is shot so high that it still flies.
    match.step(highShot(match.state));
    match.pass(1);
    match.step(shotAt(match.state, 1));
    expect(match.state.arrows).toHaveLength(5);
    expect(match.state.phase).toBe('running');
  });

  test('a hand is in reach when the head is there', () => {
    const match = told(start());
    const there: ArcheryAction = { ...shot(match.state), position: addScaled(far, vec3(0, 0, -1), arrowLength) };
    match.step({ type: 'stand', head: far }, { ...there, direction: vec3(0, 0, -1) });
    expect(match.state.arrowsLeft).toBe(4);
  });

  test('nothing that is sent breaks the state', () => {
    const wild = fc.oneof(fc.double(), fc.constantFrom(Number.NaN, Number.POSITIVE_INFINITY, -1e308, 0, 1));
    const anywhere = fc.record({ x: wild, y: wild, z: wild });
    const action: fc.Arbitrary<ArcheryAction> = fc.oneof(
      fc.constant({ type: 'start' } as const),
      fc.record({ type: fc.constant('stand' as const), head: anywhere }),
      fc.record({
        type: fc.constant('release' as const),
        position: anywhere,
        direction: anywhere,
        draw: wild,
        delay: wild,
      }),
    );
    fc.assert(
      fc.property(fc.array(fc.array(action, { maxLength: 4 }), { maxLength: 60 }), (ticks) => {
        let state = start();
        for (const actions of ticks) {
          state = archeryRules.step(state, actions).state;
          for (const value of numbersIn(state)) expect(Number.isFinite(value)).toBe(true);
          expect(state.arrowsLeft).toBe(5 - state.arrows.length);
        }
      }),
      { seed, numRuns: 200 },
    );
  });
});

describe('the zone', () => {
  const at = (x: number, z: number): ArcheryAction => ({ type: 'stand', head: vec3(x, 1.6, z) });

  test('is 1.10 m wide and 1.00 m deep, and says when it is left and entered', () => {
    const match = told(start());
    match.step(at(0.549, 0.499));
    expect(match.state.inZone).toBe(true);
    match.step(at(0.551, 0));
    expect(match.state.inZone).toBe(false);
    match.step(at(0, 0));
    match.step(at(0, -0.501));
    expect(match.events.map(({ type }) => type)).toEqual(['left-zone', 'entered-zone', 'left-zone']);
  });

  test('does not flicker at its edge', () => {
    const match = told(start());
    for (let i = 0; i < 50; i++) match.step(at(0.55 + (i % 2 ? 0.005 : -0.005), 0));
    expect(match.events.map(({ type }) => type)).toEqual(['left-zone']);
  });

  test('warns before and after the round too, and ignores heads that are nowhere', () => {
    const match = told(start());
    match.step({ type: 'stand', head: vec3(Number.NaN, 0, 0) }, at(60, 0));
    expect(match.state).toMatchObject({ inZone: true, head: vec3(0, 1.6, 0) });
    match.step(at(2, 0));
    expect(match.happened('left-zone')).toHaveLength(1);
    expect(match.state.phase).toBe('ready');
  });
});
