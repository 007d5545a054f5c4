import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { GameRules } from '../../src/games/game-rules';
import { createMatch } from '../../src/games/match';
import { number, seed } from '../threepoint/core/arbitraries';

interface Tally {
  readonly ticks: number;
  readonly heard: readonly { readonly tick: number; readonly word: string; readonly delay: number }[];
}

interface Word {
  readonly word: string;
  readonly delay: number;
}

/** Records what it receives and when. */
const tally: GameRules<Tally, Word, string, object> = {
  tickSeconds: 1 / 90,
  start: () => ({ ticks: 0, heard: [] }),
  step: (state, actions) => ({
    state: {
      ticks: state.ticks + 1,
      heard: [...state.heard, ...actions.map(({ word, delay }) => ({ tick: state.ticks, word, delay }))],
    },
    events: actions.map(({ word }) => word),
  }),
};

const delayed = (action: Word, delay: number): Word => ({ ...action, delay });
const begin = () => createMatch(tally, tally.start([], 1), { delayed });
const say = (word: string): Word => ({ word, delay: 0 });

describe('a match', () => {
  test.each([30, 60, 72, 80, 90, 120, 144])('passes 90 ticks in a second of %d Hz', (rate) => {
    const match = begin();
    for (let i = 0; i <= 10 * rate; i++) {
      match.advance(1000 + i / rate, []);
      expect(match.lead).toBeGreaterThanOrEqual(-tally.tickSeconds - 1e-9);
      expect(match.lead).toBeLessThan(1e-9);
    }
    expect(Math.abs(match.state.ticks - 901)).toBeLessThanOrEqual(1);
  });

  test('puts every action into the tick of its frame, once, and says where in it', () => {
    fc.assert(
      fc.property(fc.array(number(0, 0.05), { minLength: 1, maxLength: 200 }), (pauses) => {
        const match = begin();
        let time = 50;
        const said: { word: string; at: number }[] = [];
        const answered: string[] = [];
        for (const [i, pause] of pauses.entries()) {
          time += i === 0 ? 0 : pause;
          said.push({ word: `${i}`, at: time - 50 });
          answered.push(...match.advance(time, [say(`${i}`)]));
        }
        answered.push(...match.advance(time + tally.tickSeconds, []));
        expect(match.state.heard.map(({ word }) => word)).toEqual(said.map(({ word }) => word));
        expect(answered).toEqual(said.map(({ word }) => word));
        for (const [i, { tick, delay }] of match.state.heard.entries()) {
          expect(delay).toBeGreaterThanOrEqual(0);
          expect(delay).toBeLessThan(tally.tickSeconds);
          const late = tick * tally.tickSeconds + delay - said[i]!.at;
          expect(late).toBeGreaterThan(-1e-9);
          expect(late).toBeLessThan(tally.tickSeconds + 1e-9);
        }
      }),
      { seed },
    );
  });

  test('stands still while it is not looked at, instead of catching up', () => {
    const match = begin();
    match.advance(0, []);
    match.advance(1, []);
    const before = match.state.ticks;
    match.advance(31, [say('back')]);
    match.advance(31.1, []);
    expect(match.state.ticks - before).toBeLessThanOrEqual(10);
    expect(match.state.heard).toHaveLength(1);
  });

  test('a clock that runs backward changes nothing', () => {
    const match = begin();
    match.advance(10, []);
    match.advance(10.5, []);
    const { ticks } = match.state;
    expect(match.advance(10.2, [])).toEqual([]);
    expect(match.state.ticks).toBe(ticks);
  });
});
