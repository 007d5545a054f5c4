import fc from 'fast-check';
import { distance, vec3 } from 'threepoint/math';
import { createMatch } from 'threepoint-games';
import { type ArcheryAction, type ArcheryState, archeryRules, delayed, maximumDraw } from 'threepoint-games/archery';
import { describe, expect, test } from 'vitest';
import { evenly, seed } from '../../threepoint/core/arbitraries';
import { shotAt, start, tickSeconds } from './shots';

/** Ticks of an archer who moves about and shoots now and then, mostly well. */
const playing = fc.array(
  fc.record({
    idle: fc.integer({ min: 20, max: 200 }),
    target: fc.integer({ min: 0, max: 3 }),
    miss: fc.record({ x: evenly(-0.7, 0.7), y: evenly(-0.7, 0.7), z: fc.constant(0) }),
    draw: evenly(0.3, maximumDraw),
    delay: evenly(0, tickSeconds * 0.999),
    head: fc.record({ x: evenly(-0.7, 0.7), y: evenly(1.2, 1.8), z: evenly(-0.6, 0.6) }),
  }),
  { minLength: 1, maxLength: 8 },
);

describe('a recorded match', () => {
  test('replays to the same state, by way of JSON and from any tick on', () => {
    fc.assert(
      fc.property(fc.integer(), playing, evenly(0, 1), (matchSeed, moves, cut) => {
        const first = start({ seconds: 12 }, matchSeed);
        const ticks: ArcheryAction[][] = [];
        const states: ArcheryState[] = [first];
        const step = (...actions: ArcheryAction[]) => {
          ticks.push(actions);
          states.push(archeryRules.step(states.at(-1)!, actions).state);
        };
        step({ type: 'start' });
        for (const { idle, target, miss, draw, delay, head } of moves) {
          step({ type: 'stand', head });
          step(delayed(shotAt(states.at(-1)!, target, miss, draw), delay));
          for (let i = 0; i < idle; i++) step();
        }
        const middle = Math.floor(cut * ticks.length);
        let replayed = JSON.parse(JSON.stringify(states[middle])) as ArcheryState;
        for (const actions of JSON.parse(JSON.stringify(ticks.slice(middle))) as ArcheryAction[][]) {
          replayed = archeryRules.step(replayed, actions).state;
        }
        expect(JSON.stringify(replayed)).toBe(JSON.stringify(states.at(-1)));
      }),
      { seed, numRuns: 40 },
    );
  });

  test('never changes a state once it is made', () => {
    const freeze = <T>(value: T): T => {
      if (typeof value === 'object' && value !== null)
        for (const part of Object.values(freezeShallow(value))) freeze(part);
      return value;
    };
    const freezeShallow = <T extends object>(value: T): T => Object.freeze(value);
    let state = freeze(start());
    for (let i = 0; i < 300; i++) {
      const actions = i % 60 === 0 ? [shotAt(state, (i / 60) % 4)] : [];
      state = freeze(archeryRules.step(state, freeze(actions)).state);
    }
    expect(state.score).toBe(50);
  });

  test('has the same landings at 72, 80, 90 and 120 Hz, dropped frames or not', () => {
    const play = (rate: number, dropped: (frame: number) => boolean) => {
      const match = createMatch(archeryRules, start({}, 11), { delayed });
      const wanted = [0.4, 1.4, 2.5, 3.7].map((time, target) => ({ time, target }));
      for (let i = 0; i < 6 * rate; i++) {
        if (dropped(i)) continue;
        const due = wanted.filter(({ time }) => time <= i / rate);
        wanted.splice(0, due.length);
        match.advance(100 + i / rate, [
          { type: 'stand', head: vec3(0, 1.6, 0) },
          ...due.map(({ target }) => shotAt(match.state, target, vec3(0.1, -0.2, 0))),
        ]);
      }
      expect(match.state.score).toBe(50);
      return match.state.arrows;
    };
    const at90 = play(90, () => false);
    for (const rate of [72, 80, 90, 120]) {
      for (const arrows of [play(rate, () => false), play(rate, (i) => (i * 7) % 10 < 3)]) {
        arrows.forEach((arrow, i) => {
          expect(distance(arrow.landing!.position, at90[i]!.landing!.position)).toBeLessThan(1e-3);
          expect(arrow.landing!.time - arrow.release.time).toBeCloseTo(
            at90[i]!.landing!.time - at90[i]!.release.time,
            9,
          );
        });
      }
    }
  });
});
