import { identity, vec3 } from 'threepoint/math';
import {
  type BallEvent,
  type BallLocation,
  type BallState,
  ballRules,
  catchesOf,
  displayedSeconds,
} from 'threepoint-games/ball';
import { describe, expect, it } from 'vitest';
import { ballGame } from '../../../src/page/ball/ball-game';
import { cueCaption, eventCaption } from '../../../src/page/ball/sound/ball-captions';
import { eventHaptics } from '../../../src/page/ball/sound/ball-haptics';
import { eventLine, waitingLine } from '../../../src/page/ball/view/match-texts';
import type { DisplayedMatch, DisplayedPlayer } from '../../../src/page/people/view/displayed-match';
import { displayName, markedName } from '../../../src/page/people/view/displayed-match';
import { lobbyButtons, seatOfButton } from '../../../src/page/people/view/lobby-sheet';
import { labelScale } from '../../../src/page/people/view/name-labels';
import { waitingSentence } from '../../../src/page/people/view/waiting-sentence';
import { createSettling, settlingSeconds } from '../../../src/page/scene/boards/sheet';

const person = (name: string, more: Partial<DisplayedPlayer> = {}): DisplayedPlayer => ({
  name,
  bot: false,
  presence: 'here',
  me: false,
  station: 0,
  ...more,
});
const fresh = ballRules.start(['a', 'b', 'c'], 1);
const launch = { time: 1, position: vec3(0, 1.5, 0), velocity: vec3(0, 4, -5) };

const standing = (
  players: DisplayedMatch['players'],
  state: BallState = fresh,
  me: number | null = 0,
): DisplayedMatch<BallState> => ({
  state,
  seconds: 90,
  players,
  me,
  readyByItself: false,
});

const withReady = (...ready: boolean[]): BallState => ({
  ...fresh,
  players: fresh.players.map((player, i) => ({ ...player, present: true, ready: ready[i] ?? false })),
});

describe('the board', () => {
  it('says who is missing, then who is waited for', () => {
    expect(waitingLine(standing([null, null, person('cal')], withReady()))).toBe('Waiting for a thrower');
    expect(waitingLine(standing([person('ann'), null, null], withReady()))).toBe('Waiting for a basket holder');
    const all = [person('ann'), person('ben'), person('cal')];
    expect(waitingLine(standing(all, withReady(true, false, false)))).toBe('Waiting for 2 players');
    expect(waitingLine(standing(all, withReady(true, true, false)))).toBe('Waiting for one player');
  });

  it('beside the player: says who is waited for, by name, and what to press', () => {
    const all = [person('ann', { me: true }), person('Max', { bot: true, station: 1 }), person('cal', { station: 2 })];
    const told = (...ready: boolean[]) => waitingSentence(ballGame, standing(all, withReady(...ready)));
    expect(waitingSentence(ballGame, standing([person('ann', { me: true }), null, null], withReady()))).toBe(
      'Waiting for a basket holder.',
    );
    expect(told(false, true, true)).toBe('Waiting for you: press Ready.');
    expect(told(false, false, false)).toBe('Waiting for you, 2 · Max (bot) and 3 · cal: press Ready.');
    expect(told(true, false, false)).toBe('Waiting for 2 · Max (bot) and 3 · cal.');
    expect(told(true, true, true)).toBe('The match starts in a moment.');
    const over = { ...withReady(false, true, true), phase: 'over' as const, end: 'balls' as const };
    expect(waitingSentence(ballGame, standing(all, over))).toBe('Waiting for you: press Play again.');
    expect(waitingSentence(ballGame, { ...standing(all, over), readyByItself: true })).toBe(
      'The match starts in a moment.',
    );
    expect(waitingSentence(ballGame, standing(all, { ...over, phase: 'running' }))).toBeNull();
    const throwers = [all[0]!, all[1]!, null];
    expect(waitingSentence(ballGame, standing(throwers, over))).toBe('Waiting for a basket holder.');
    expect(waitingSentence(ballGame, standing(throwers, { ...over, rotate: true }))).toBe(
      'Waiting for you: press Play again.',
    );
  });

  it('waits for nobody who has left, although the seat is held for them', () => {
    const gone = person('Ben', { station: 1, presence: 'gone' });
    const people = [person('ann', { me: true }), gone, person('cal', { station: 2 })];
    const without = (seat: number, state: BallState): BallState => ({
      ...state,
      players: state.players.map((player, i) => (i === seat ? { ...player, present: false } : player)),
    });
    const state = without(1, withReady(true, false, false));
    expect(waitingSentence(ballGame, standing(people, state))).toBe('Waiting for 3 · cal.');
    expect(waitingLine(standing(people, state))).toBe('Waiting for one player');
    const noHolder = standing(people, without(2, withReady(true, true, false)));
    expect(waitingSentence(ballGame, noHolder)).toBe('Waiting for a basket holder.');
    expect(waitingLine(noHolder)).toBe('Waiting for a basket holder');
    const allSeats = { ...state, options: { ...state.options, everySeat: true } };
    expect(waitingSentence(ballGame, standing(people, allSeats))).toBe('Waiting for all players.');
  });

  it('speaks to the player of their own throws', () => {
    const people = [person('ann', { me: true }), null, null];
    expect(eventLine({ type: 'caught', ball: 3, player: 0, at: 2, score: 1 }, people)).toBe('In! Thrown by you');
    expect(eventLine({ type: 'missed', ball: 3, player: 0 } as BallEvent, people)).toBe('Your ball is on the floor');
  });

  it('names the thrower of a ball that was caught, and counts by thrower', () => {
    const event: BallEvent = { type: 'caught', ball: 3, player: 1, at: 2, score: 1 };
    expect(eventLine(event, [null, person('ben', { station: 1 }), null])).toBe('In! Thrown by 2 · ben');
    const balls: BallLocation[] = [
      { on: 'basket', thrower: 0 },
      { on: 'basket', thrower: 1 },
      { on: 'basket', thrower: 1 },
      { on: 'rack' },
    ];
    const state = { ...fresh, balls };
    expect([0, 1, 2].map((player) => catchesOf(state, player))).toEqual([1, 2, 0]);
  });

  it('tells players with equal names, default names and look-alikes apart by what they cannot choose', () => {
    for (const names of [
      ['Ann', 'Ann'],
      ['Player 2', 'Player 2'],
      ['2 · Ann', 'Ann'],
      ['Ann', 'Αnn'],
    ]) {
      const players = names.map((name, station) => person(name, { station }));
      expect(players.map((player) => markedName(player))).toEqual([`1 · ${names[0]}`, `2 · ${names[1]}`]);
      const lines = [0, 1].map((player) => eventLine({ type: 'left', player }, players));
      expect(lines).toEqual([`1 · ${names[0]} has left`, `2 · ${names[1]} has left`]);
    }
  });

  it('a bot is marked, once', () => {
    expect(displayName(person('Ada', { bot: true }))).toBe('Ada (bot)');
    expect(displayName(person('Bot 7', { bot: true }))).toBe('Bot 7');
    expect(displayName(person('Ada'))).toBe('Ada');
  });
});

describe('the sheet before and after a match', () => {
  it('offers the free seats and those of bots, and ready to a seated player', () => {
    const people = [person('ann', { me: true }), person('Max', { bot: true }), null];
    expect(lobbyButtons(ballGame, standing(people)).map(({ id }) => id)).toEqual(['seat1', 'seat2', 'option', 'ready']);
    const watcher = lobbyButtons(ballGame, standing([person('ann'), null, person('cal')], fresh, null));
    expect(watcher.map(({ id }) => id)).toEqual(['seat1']);
    expect(watcher.map(({ id }) => seatOfButton(id))).toEqual([1]);
    expect(seatOfButton('ready')).toBe(null);
  });
});

describe('captions', () => {
  const head = { position: vec3(-0.8, 1.6, 0), orientation: identity };
  const people = ['ann', 'Max', 'cal'].map((name, station) => person(name, { station, bot: station === 1 }));
  const hearing = { head, me: 0, people, seconds: 90 };

  it('say who throws and from where, but not to the thrower', () => {
    const thrown = (player: number): BallEvent => ({ type: 'thrown', ball: 2, player, launch });
    expect(eventCaption(thrown(1), vec3(0.8, 1.5, 0), hearing)).toBe('2 · Max (bot) throws, to the right');
    expect(eventCaption(thrown(0), vec3(-0.8, 1.5, 0), hearing)).toBe(null);
    expect(cueCaption({ type: 'thrown', side: 'right', ball: 2 })).toBe('You throw');
  });

  it('say why an action was refused, only to the player who did it', () => {
    const refused = (player: number): BallEvent => ({ type: 'refused', player, sequence: 1, reason: 'taken' });
    expect(eventCaption(refused(0), null, hearing)).toBe('Another player holds that ball');
    expect(eventCaption(refused(1), null, hearing)).toBe(null);
  });

  it('count one point as one', () => {
    const caught = (score: number): BallEvent => ({ type: 'caught', ball: 1, player: 1, at: 2, score });
    expect(eventCaption(caught(1), null, hearing)).toBe('Caught: 1 point');
    expect(eventCaption(caught(2), null, hearing)).toBe('Caught: 2 points');
  });
});

describe('pulses', () => {
  it('a catch is strongest for the holder, light for the thrower, absent for the other thrower', () => {
    const caught: BallEvent = { type: 'caught', ball: 1, player: 0, at: 2, score: 1 };
    const strongest = (me: number, role: 'thrower' | 'holder') =>
      Math.max(0, ...eventHaptics([caught], me, role).map(({ strength }) => strength));
    expect(strongest(2, 'holder')).toBeGreaterThan(strongest(0, 'thrower'));
    expect(strongest(0, 'thrower')).toBeGreaterThan(0);
    expect(strongest(1, 'thrower')).toBe(0);
  });
});

describe('names over heads', () => {
  it('look as large across the court as from 2.8 m, and no larger than themselves nearby', () => {
    for (const far of [0.5, 1, 2.8]) expect(labelScale(far)).toBe(1);
    const angle = (far: number) => labelScale(far) / far;
    for (const far of [3, 5, 8]) expect(angle(far)).toBeCloseTo(angle(2.8), 9);
    expect(labelScale(40)).toBe(3);
  });
});

describe('the clock of a match', () => {
  it('stands after its end while the result is read, and is whole before the next match', () => {
    const at = (tick: number, more: Partial<BallState>) => ({ ...fresh, tick, startedAt: 0, ...more });
    const running = displayedSeconds(at(60 * 30, { phase: 'running' }), 0);
    expect(running).toBeCloseTo(60, 6);
    expect(displayedSeconds(at(60 * 50, { phase: 'over', end: 'balls' }), running)).toBe(running);
    expect(displayedSeconds(at(60 * 90, { phase: 'over', end: 'time' }), running)).toBe(0);
    expect(displayedSeconds({ ...fresh, startedAt: null }, 0)).toBe(90);
  });
});

describe('a sheet that comes under a hand or a mouse', () => {
  it('takes no press for half a second, each time it comes', () => {
    const settling = createSettling();
    const settledAfter = (from: number): number => {
      for (let time = from; ; time += 1 / 72) {
        settling.show(true, time);
        if (settling.settled) return time - from;
      }
    };
    settling.show(false, 9);
    expect(settling.settled).toBe(false);
    for (const from of [10, 40]) {
      const waited = settledAfter(from);
      expect(waited).toBeGreaterThanOrEqual(settlingSeconds - 1e-9);
      expect(waited).toBeLessThan(settlingSeconds + 1 / 36);
      settling.show(false, from + 20);
      expect(settling.settled).toBe(false);
    }
  });
});
