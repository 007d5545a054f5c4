import { describe, expect, it } from 'vitest';
import type { BallEvent, BallPlace, BallState } from '../../../src/core/games/ball/ball-state';
import { ballRules } from '../../../src/core/games/ball/rules';
import { identity } from '../../../src/core/math/quat';
import { vec3 } from '../../../src/core/math/vec3';
import {
  catchesOf,
  lineOfEvent,
  lobbyButtons,
  nameOf,
  type Person,
  type Standing,
  seatOfButton,
  waitingLine,
} from '../../../src/games/ball/board-drawing';
import { cueCaption, eventCaption } from '../../../src/games/ball/captions';
import { eventHaptics } from '../../../src/games/ball/haptics';
import { labelScale } from '../../../src/games/ball/name-labels';

const person = (name: string, more: Partial<Person> = {}): Person => ({
  name,
  bot: false,
  presence: 'here',
  me: false,
  ...more,
});
const fresh = ballRules.start(['a', 'b', 'c'], 1);
const launch = { time: 1, position: vec3(0, 1.5, 0), velocity: vec3(0, 4, -5) };

const standing = (people: Standing['people'], state: BallState = fresh, me: number | null = 0): Standing => ({
  state,
  seconds: 90,
  people,
  me,
  rotate: false,
});

const withReady = (...ready: boolean[]): BallState => ({
  ...fresh,
  players: fresh.players.map((player, i) => ({ ...player, present: true, ready: ready[i] ?? false })),
});

describe('the board', () => {
  it('says who is missing, then who is waited for', () => {
    expect(waitingLine(standing([null, null, person('cal')]))).toBe('Waiting for a thrower');
    expect(waitingLine(standing([person('ann'), null, null]))).toBe('Waiting for a basket holder');
    const all = [person('ann'), person('ben'), person('cal')];
    expect(waitingLine(standing(all, withReady(true, false, false)))).toBe('Waiting for 2 players');
    expect(waitingLine(standing(all, withReady(true, true, false)))).toBe('Waiting for one player');
  });

  it('names whoever threw a ball that was caught, and counts by thrower', () => {
    const event: BallEvent = { type: 'caught', ball: 3, player: 1, at: 2, score: 1 };
    expect(lineOfEvent(event, [null, person('ben'), null])).toBe('In! Thrown by ben');
    const balls: BallPlace[] = [
      { on: 'basket', thrower: 0 },
      { on: 'basket', thrower: 1 },
      { on: 'basket', thrower: 1 },
      { on: 'rack' },
    ];
    const state = { ...fresh, balls };
    expect([0, 1, 2].map((player) => catchesOf(state, player))).toEqual([1, 2, 0]);
  });

  it('a bot is marked, once', () => {
    expect(nameOf(person('Ada', { bot: true }))).toBe('Ada (bot)');
    expect(nameOf(person('Bot 7', { bot: true }))).toBe('Bot 7');
    expect(nameOf(person('Ada'))).toBe('Ada');
  });
});

describe('the sheet before and after a match', () => {
  it('offers the places that are free or a bot’s, and ready to whoever has one', () => {
    const people = [person('ann', { me: true }), person('Max', { bot: true }), null];
    expect(lobbyButtons(standing(people)).map(({ id }) => id)).toEqual(['seat1', 'seat2', 'rotate', 'ready']);
    const watcher = lobbyButtons(standing([person('ann'), null, person('cal')], fresh, null));
    expect(watcher.map(({ id }) => id)).toEqual(['seat1']);
    expect(watcher.map(({ id }) => seatOfButton(id))).toEqual([1]);
    expect(seatOfButton('ready')).toBe(null);
  });
});

describe('captions', () => {
  const head = { position: vec3(-0.8, 1.6, 0), orientation: identity };
  const hearing = { head, me: 0, people: [person('ann'), person('Max', { bot: true }), person('cal')], seconds: 90 };

  it('say who throws and from where, but not to the thrower', () => {
    const thrown = (player: number): BallEvent => ({ type: 'thrown', ball: 2, player, launch });
    expect(eventCaption(thrown(1), vec3(0.8, 1.5, 0), hearing)).toBe('Max (bot) throws, to the right');
    expect(eventCaption(thrown(0), vec3(-0.8, 1.5, 0), hearing)).toBe(null);
    expect(cueCaption({ type: 'thrown', side: 'right', ball: 2 })).toBe('You throw');
  });

  it('say why a deed was refused, only to whoever did it', () => {
    const refused = (player: number): BallEvent => ({ type: 'refused', player, sequence: 1, reason: 'taken' });
    expect(eventCaption(refused(0), null, hearing)).toBe('Somebody else has that ball');
    expect(eventCaption(refused(1), null, hearing)).toBe(null);
  });

  it('count one point as one', () => {
    const caught = (score: number): BallEvent => ({ type: 'caught', ball: 1, player: 1, at: 2, score });
    expect(eventCaption(caught(1), null, hearing)).toBe('Caught: 1 point');
    expect(eventCaption(caught(2), null, hearing)).toBe('Caught: 2 points');
  });
});

describe('pulses', () => {
  it('a catch is strongest in the holder’s hands, light in the thrower’s, nothing to the other thrower', () => {
    const caught: BallEvent = { type: 'caught', ball: 1, player: 0, at: 2, score: 1 };
    const strongest = (me: number, role: 'thrower' | 'holder') =>
      Math.max(0, ...eventHaptics([caught], me, role).map(({ strength }) => strength));
    expect(strongest(2, 'holder')).toBeGreaterThan(strongest(0, 'thrower'));
    expect(strongest(0, 'thrower')).toBeGreaterThan(0);
    expect(strongest(1, 'thrower')).toBe(0);
  });
});

describe('names over heads', () => {
  it('are as large to the eye from across the court as from 2.8 m, and no larger than themselves from near', () => {
    for (const far of [0.5, 1, 2.8]) expect(labelScale(far)).toBe(1);
    const angle = (far: number) => labelScale(far) / far;
    for (const far of [3, 5, 8]) expect(angle(far)).toBeCloseTo(angle(2.8), 9);
    expect(labelScale(40)).toBe(3);
  });
});
