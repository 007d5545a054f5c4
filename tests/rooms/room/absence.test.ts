import { describe, expect, test } from 'vitest';
import type { Absence } from '../../../src/rooms/protocol/messages';
import { createTestRoom, trio } from './test-room';

const waitSeconds = 20;

/** A match of three assigned players that runs; each is seen in every tick unless `away` names them. */
function match(ball: { readonly seconds?: number } = {}) {
  const room = createTestRoom({
    assigned: true,
    pausable: true,
    ball: { everySeat: true, waitSeconds, ...ball },
  });
  const away = new Set<string>();
  for (const [seat, client] of trio.entries()) room.join(client, { name: client, seat });
  room.ready();
  const self = {
    ...room,
    away,
    now: () => room.time,
    pass(seconds: number) {
      room.pass(seconds, () => {
        for (const client of trio) if (!away.has(client)) room.poseOf(client);
      });
    },
    /** The second of the match, which stands while the clock is stopped. */
    get second() {
      return room.room.match.tick / 60;
    },
    get absences(): readonly Absence[] {
      const all = new Map<number, Absence>();
      for (const { message } of room.sent) {
        if (message.type === 'absence') all.set(message.absence.number, message.absence);
      }
      return [...all.values()];
    },
  };
  self.pass(1);
  expect(room.room.match.phase).toBe('running');
  return self;
}

describe('a match that waits for its players', () => {
  test('stands when a connection is lost, and goes on when its player is ready again', () => {
    const one = match();
    one.pass(4);
    one.room.disconnect('cal', one.now());
    one.away.add('cal');
    one.pass(0.1);
    const stood = one.second;
    one.pass(12);
    expect(one.second).toBe(stood);
    expect(one.absences).toMatchObject([{ number: 1, seats: [2], seconds: null, givenUp: false }]);
    one.away.delete('cal');
    one.join('cal', { name: 'cal', seat: 2 });
    one.pass(3);
    // The player is back but not ready: the page was loaded again.
    expect(one.second).toBe(stood);
    one.ready(['cal']);
    one.pass(2);
    expect(one.second).toBeCloseTo(stood + 2, 1);
    expect(one.absences).toHaveLength(1);
    const [absence] = one.absences;
    expect(absence?.seconds).toBeCloseTo(15.1, 1);
    expect(absence?.at).toBeCloseTo(stood, 1);
    expect(one.room.match.phase).toBe('running');
  });

  test('stands while a player is silent, and goes on with the first pose after that', () => {
    const one = match();
    one.away.add('ann');
    one.pass(2.4);
    expect(one.absences).toEqual([]);
    one.pass(0.2);
    const stood = one.second;
    one.pass(8);
    expect(one.second).toBe(stood);
    one.away.delete('ann');
    one.pass(1);
    expect(one.second).toBeGreaterThan(stood + 0.9);
    expect(one.absences).toMatchObject([{ seats: [0], givenUp: false }]);
    expect(one.absences[0]?.seconds).toBeCloseTo(8, 0);
  });

  test('is given up after its limit, and another one waits for all at its start', () => {
    const one = match();
    one.pass(5);
    one.say('ben', { type: 'leave' });
    one.away.add('ben');
    one.pass(waitSeconds - 0.5);
    expect(one.absences).toMatchObject([{ seats: [1], seconds: null }]);
    one.pass(1);
    expect(one.absences).toMatchObject([{ seats: [1], givenUp: true }]);
    expect(one.absences[0]?.seconds).toBeCloseTo(waitSeconds, 1);
    expect(one.room.match.phase).toBe('ready');
    expect(one.room.match.players.map(({ present, ready }) => [present, ready])).toEqual([
      [true, false],
      [false, false],
      [true, false],
    ]);
    one.join('ben', { name: 'ben', seat: 1 });
    one.away.delete('ben');
    one.ready();
    one.pass(1);
    expect(one.room.match).toMatchObject({ phase: 'running', score: 0 });
    expect(one.absences).toHaveLength(1);
  });

  test('is not given up during a requested pause, and waits its whole limit after it', () => {
    const one = match();
    one.say('ann', { type: 'pause', pause: true });
    one.pass(1);
    one.away.add('cal');
    one.pass(3 * waitSeconds);
    expect(one.absences).toMatchObject([{ seats: [2], until: null, seconds: null }]);
    one.say('ann', { type: 'pause', pause: false });
    one.pass(waitSeconds - 1);
    expect(one.absences).toMatchObject([{ seconds: null }]);
    one.pass(2);
    expect(one.absences).toMatchObject([{ givenUp: true }]);
  });

  test('names everyone who was away in one wait, and reports it to a player who joins', () => {
    const one = match();
    one.away.add('ann');
    one.pass(4);
    one.away.add('ben');
    one.pass(4);
    one.away.delete('ann');
    one.pass(4);
    expect(one.absences).toMatchObject([{ seats: [0, 1], seconds: null }]);
    one.join('watcher', { spectate: true });
    const told = one.sent.filter(({ to, message }) => to === 'watcher' && message.type === 'absence');
    expect(told).toHaveLength(1);
    one.away.delete('ben');
    one.pass(1);
    expect(one.absences).toHaveLength(1);
    expect(one.room.paused).toBe(false);
  });

  test('keeps ticking for its limit when no player is left', () => {
    const one = match();
    for (const client of trio) one.say(client, { type: 'leave' });
    for (const client of trio) one.away.add(client);
    one.pass(1);
    expect(one.room.isIdle).toBe(false);
    one.pass(waitSeconds);
    expect(one.absences).toMatchObject([{ seats: [0, 1, 2], givenUp: true }]);
    expect(one.room.isIdle).toBe(true);
  });
});

test('a room with free seats plays on without a player who is away', () => {
  const room = createTestRoom({ pausable: true });
  room.begin();
  room.pass(6, () => room.poseOf('cal'));
  expect(room.room.paused).toBe(false);
  expect(room.sent.some(({ message }) => message.type === 'absence')).toBe(false);
});

test('a ball that meets the basket of a silent holder is missed', () => {
  const room = createTestRoom();
  room.begin();
  room.grab(0);
  room.pass(1.5, () => room.poseOf('ann'));
  room.act('ann', room.throwOf(0, 2));
  room.pass(3, () => room.poseOf('ann'));
  expect(room.happened('caught')).toEqual([]);
  expect(room.happened('missed')).toHaveLength(1);
  expect(room.room.match.score).toBe(0);
});
