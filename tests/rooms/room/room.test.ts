import fc from 'fast-check';
import { BallPolicy, type BallState, ballClientPolicy, ballRules } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { clientMessageFrom, protocolVersion, unpackSeatInfo } from '../../../src/rooms/protocol/messages';
import { Room } from '../../../src/rooms/room/room';
import { seatHoldSeconds } from '../../../src/rooms/room/seats';
import { atRack, fists, holding, opening, releaseOf, velocityTo } from '../client/people';
import { createTestRoom, joinRequest, trio } from './test-room';

const presence = (testRoom: ReturnType<typeof createTestRoom>, seat: number) => {
  const seen = testRoom.sent.findLast(({ message }) => message.type === 'seat' && message.seat === seat)?.message;
  return seen?.type === 'seat' ? (unpackSeatInfo(seen.info)?.presence ?? 'free') : undefined;
};

describe('seats', () => {
  test('a name stays free of what could trick a reader, and no player is nameless', () => {
    const testRoom = createTestRoom();
    const rude = clientMessageFrom({
      type: 'join',
      version: protocolVersion,
      ...joinRequest({ name: ' a\u202eb\u0007\n  c\u200b \u{1f600}'.repeat(4) }),
    });
    expect(rude).toMatchObject({ name: 'ab c \u{1f600} ab c \u{1f600} ab c \u{1f600}' });
    testRoom.join('x', { name: '' });
    expect(unpackSeatInfo(testRoom.welcomeOf('x').seats[0]!)?.name).toBe('Player 1');
  });

  test('a connection lost under 30 s gets its seat and score back, with 16 others waiting', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.room.disconnect('ann', testRoom.time);
    expect(presence(testRoom, 0)).toBe('gone');
    for (let i = 0; i < 16; i++) expect(testRoom.join(`w${i}`).seat).toBeNull();
    testRoom.pass(seatHoldSeconds - 1, testRoom.stand);
    const back = testRoom.join('ann again', {}, 'ann');
    expect(back.seat).toBe(0);
    expect(back.match?.phase).toBe('running');
    expect(presence(testRoom, 0)).toBe('here');
  });

  test('after 30 s the seat is free', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.room.disconnect('ann', testRoom.time);
    testRoom.pass(seatHoldSeconds + 1, testRoom.stand);
    expect(presence(testRoom, 0)).toBe('free');
    expect(testRoom.join('dot').seat).toBe(0);
    expect(testRoom.join('ann again', {}, 'ann').seat).toBeNull();
  });

  const anHour = (testRoom: ReturnType<typeof createTestRoom>) => {
    for (let second = 0; second < 3600; second++) testRoom.tick(1);
  };

  test('a connected tab hidden for an hour finds its seat, and the round over', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.say('ann', { type: 'away', away: true });
    expect(presence(testRoom, 0)).toBe('away');
    anHour(testRoom);
    expect(testRoom.room.census).toMatchObject({ players: 3, spectators: 0 });
    expect(testRoom.room.match.phase).toBe('over');
    testRoom.say('ann', { type: 'away', away: false });
    expect(presence(testRoom, 0)).toBe('here');
    testRoom.ready();
    testRoom.tick();
    testRoom.tick();
    expect(testRoom.room.match.phase).toBe('running');
  });

  test('a match starts without a player who is away for 30 s, until they return', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.say('ben', { type: 'away', away: true });
    const seen = () => {
      testRoom.pose('ann', 0, fists(releaseOf(0)));
      testRoom.pose('cal', 2, holding(opening));
    };
    const phase = () => testRoom.room.match.phase;
    const play = (clients: readonly string[]) => {
      testRoom.ready(clients);
      testRoom.tick();
      testRoom.tick();
      return phase();
    };
    testRoom.pass(seatHoldSeconds + 1, seen);
    expect(testRoom.room.match.players.map(({ present }) => present)).toEqual([true, true, true]);
    while (phase() === 'running') testRoom.pass(1, seen);
    testRoom.pass(1, seen);
    expect(play(['ann', 'cal'])).toBe('running');
    expect(presence(testRoom, 1)).toBe('away');
    testRoom.say('ben', { type: 'away', away: false });
    testRoom.tick();
    expect(testRoom.room.match.players[1]?.present).toBe(true);
    while (phase() === 'running') testRoom.pass(1, testRoom.stand);
    expect(play(['ann', 'cal'])).toBe('over');
    expect(play(['ben'])).toBe('running');
  });

  test('a group of a study waits for each of its players, however long one is away', () => {
    const testRoom = createTestRoom({ assigned: true });
    for (const [seat, client] of trio.entries()) testRoom.join(client, { seat });
    testRoom.say('ben', { type: 'away', away: true });
    for (let second = 0; second < 600; second++) testRoom.tick(1);
    testRoom.ready(['ann', 'cal']);
    testRoom.tick();
    testRoom.tick();
    expect(testRoom.room.match.phase).toBe('ready');
    expect(testRoom.room.match.players[1]?.present).toBe(true);
  });

  test('a tab disconnected for an hour finds a free seat, or watches where none is', () => {
    for (const taken of [false, true]) {
      const testRoom = createTestRoom();
      testRoom.begin();
      testRoom.room.disconnect('ann', testRoom.time);
      anHour(testRoom);
      if (taken) testRoom.join('dee', { name: 'dee' });
      const { seat, epoch, match } = testRoom.join('ann again', { seat: 0 }, 'ann');
      expect(seat).toBe(taken ? null : 0);
      expect(epoch).toBe('one');
      expect(match.phase).toBe('over');
    }
  });

  test('a ball in hand survives a short disconnection and returns to the rack after longer ones', () => {
    const hold = () => {
      const testRoom = createTestRoom();
      testRoom.begin();
      testRoom.grab();
      testRoom.tick();
      expect(testRoom.room.match.balls[0]?.on).toBe('hand');
      testRoom.room.disconnect('ann', testRoom.time);
      return testRoom;
    };
    const hiccup = hold();
    hiccup.pass(2, hiccup.stand);
    hiccup.join('ann again', {}, 'ann');
    expect(hiccup.room.match.balls[0]?.on).toBe('hand');
    const longer = hold();
    longer.pass(4, longer.stand);
    expect(longer.room.match.balls[0]?.on).toBe('rack');
    longer.join('ann again', {}, 'ann');
    longer.tick();
    expect(longer.room.match.players[0]?.present).toBe(true);
  });

  test('a page reloaded at once numbers its actions from 1: none counts as seen before', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.grab();
    testRoom.tick();
    testRoom.room.disconnect('ann', testRoom.time);
    testRoom.pass(1);
    testRoom.join('ann again', {}, 'ann');
    testRoom.act('ann again', { type: 'drop', sequence: 1, side: 'right' });
    testRoom.tick();
    expect(testRoom.happened('refused')).toEqual([]);
    expect(testRoom.room.match.balls[0]?.on).toBe('rack');
  });

  test('a second connection of the same person replaces the first', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    expect(testRoom.join('ann on her telephone', {}, 'ann').seat).toBe(0);
    expect(testRoom.dropped).toEqual([{ client: 'ann', reason: 'replaced' }]);
  });

  test('a taken seat is taken by no other, and each attempt is noted', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.join('dot', { spectate: true });
    testRoom.say('dot', { type: 'sit', seat: 1 });
    expect(testRoom.refusals).toMatchObject([{ client: 'dot', what: 'sit', reason: 'occupied' }]);
    expect(testRoom.join('eve', { seat: 1 }).seat).toBeNull();
  });

  test('others learn of an absence at once when declared, within 3 s of silence otherwise', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.say('ann', { type: 'away', away: true });
    expect(presence(testRoom, 0)).toBe('away');
    testRoom.say('ann', { type: 'away', away: false });
    expect(presence(testRoom, 0)).toBe('here');
    const quiet = () => {
      testRoom.pose('ann', 0, fists(releaseOf(0)));
      testRoom.pose('cal', 2, fists(opening));
    };
    testRoom.pass(3, quiet);
    expect(presence(testRoom, 1)).toBe('away');
    expect(presence(testRoom, 0)).toBe('here');
    testRoom.pose('ben', 1, fists(releaseOf(1)));
    testRoom.tick();
    expect(presence(testRoom, 1)).toBe('here');
  });

  test('a seat belongs to one client at most in any order, and the welcomed know theirs', () => {
    const step = fc.record({
      who: fc.integer({ min: 0, max: 5 }),
      what: fc.constantFrom('join', 'watch', 'bot', 'disconnect', 'leave', 'sit', 'ready', 'wait'),
      seat: fc.option(fc.integer({ min: 0, max: 3 }), { nil: null }),
      seconds: fc.double({ min: 0, max: 20, noNaN: true }),
    });
    fc.assert(
      fc.property(fc.array(step, { minLength: 1, maxLength: 60 }), (steps) => {
        const testRoom = createTestRoom();
        const live = new Map<number, string>();
        let made = 0;
        for (const { who, what, seat, seconds } of steps) {
          const client = live.get(who);
          const arrive = what === 'join' || what === 'watch' || what === 'bot';
          if (arrive) {
            made += 1;
            live.set(who, `c${made}`);
            testRoom.join(`c${made}`, { seat, spectate: what === 'watch', bot: what === 'bot' }, `person ${who}`);
          } else if (client && what === 'disconnect') testRoom.room.disconnect(client, testRoom.time);
          else if (client && what === 'leave') testRoom.say(client, { type: 'leave' });
          else if (client && what === 'sit') testRoom.say(client, { type: 'sit', seat });
          else if (client && what === 'ready') testRoom.say(client, { type: 'ready', ready: true });
          else testRoom.tick(seconds);
          if (what === 'disconnect' || what === 'leave') live.delete(who);
          for (const { client: gone } of testRoom.dropped) {
            for (const [person, current] of live) if (current === gone) live.delete(person);
          }
          testRoom.tick();
          const { players, bots, free, spectators } = testRoom.room.census;
          expect(players + free).toBe(3);
          expect(players + bots).toBeLessThanOrEqual(3);
          expect(spectators).toBeLessThanOrEqual(live.size);
          const present = testRoom.room.match.players.filter((player) => player.present).length;
          expect(present).toBeLessThanOrEqual(players + bots);
        }
      }),
    );
  });
});

describe('a match in a room', () => {
  test('two grabs of a ball in one tick have one winner, for any players and order', () => {
    fc.assert(
      fc.property(fc.constantFrom(1, 3), fc.boolean(), (ball, benFirst) => {
        const testRoom = createTestRoom({ ball: { balls: 4 } });
        testRoom.begin();
        testRoom.pose('ann', 0, atRack(ball, 4), testRoom.time + 0.01);
        testRoom.pose('ben', 1, atRack(ball, 4), testRoom.time + 0.01);
        testRoom.tick();
        const order = benFirst ? ['ben', 'ann'] : ['ann', 'ben'];
        for (const client of order) testRoom.act(client, { type: 'grab', sequence: 1, side: 'right', ball });
        testRoom.tick();
        const grabbed = testRoom.happened('grabbed');
        const refused = testRoom.sent.filter(
          ({ to, message }) => to !== 'all' && message.type === 'events' && message.events[0]?.type === 'refused',
        );
        expect(grabbed).toHaveLength(1);
        expect(grabbed[0]?.player).toBe(benFirst ? 1 : 0);
        expect(refused.map(({ to }) => to)).toEqual([order[1]]);
        expect(testRoom.room.match.balls[ball]).toMatchObject({ on: 'hand', player: grabbed[0]?.player });
      }),
    );
  });

  test.each([[[0, 2]], [[1, 2]], [[0, 1, 2]]])(
    'moves roles on so that those on seats %j can play each next one',
    (seats) => {
      const testRoom = createTestRoom({ ball: { balls: 2, seconds: 0.5 } });
      const clients = seats.map((seat) => `player ${seat}`);
      clients.forEach((client, index) => void testRoom.join(client, { seat: seats[index]! }));
      testRoom.act(clients[0]!, { type: 'rotate', sequence: 1, rotate: true });
      const held: (string | undefined)[] = [];
      for (let match = 0; match < 6; match++) {
        testRoom.ready(clients);
        testRoom.pass(0.2);
        expect(testRoom.room.match.phase).toBe('running');
        held.push(clients[seats.findIndex((seat) => testRoom.room.match.players[seat]?.role === 'holder')]);
        testRoom.pass(1);
        expect(testRoom.room.match.phase).toBe('over');
      }
      expect(held.slice(0, clients.length).sort()).toEqual(clients);
      expect(held.slice(clients.length, 2 * clients.length)).toEqual(held.slice(0, clients.length));
    },
  );

  test('the next one knows newcomers if it begins between two ticks of the last', () => {
    const testRoom = createTestRoom({ ball: { balls: 2, seconds: 0.5 } });
    testRoom.begin();
    testRoom.pass(1);
    testRoom.say('cal', { type: 'leave' });
    testRoom.ready(['ann', 'ben']);
    testRoom.tick();
    testRoom.tick(1 / 120);
    expect(testRoom.room.match.phase).toBe('over');
    testRoom.act('ann', { type: 'rotate', sequence: 1, rotate: true });
    testRoom.join('dot', { seat: 2 });
    testRoom.tick(1 / 600);
    testRoom.ready(['ann', 'ben', 'dot']);
    testRoom.pass(0.1);
    expect(testRoom.room.match.players.map(({ present }) => present)).toEqual([true, true, true]);
  });

  test('a match clock that stood still says so, and its numbers go on', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    const { matchStart } = testRoom.welcomeOf('ann');
    const before = testRoom.room.match.tick;
    testRoom.tick(20);
    expect(testRoom.room.match.tick - before).toBeLessThan(5);
    const moved = testRoom.sent.findLast(({ message }) => message.type === 'match-start')?.message;
    expect(moved?.type === 'match-start' && moved.matchStart - matchStart).toBeCloseTo(20, 1);
  });

  /** Any actions at all, by anybody, with poses between them. */
  const somethingHappens = fc.record({
    who: fc.constantFrom('ann', 'ben', 'cal'),
    what: fc.constantFrom('grab', 'throw', 'drop', 'stand', 'reach', 'pass', 'again'),
    ball: fc.integer({ min: 0, max: 3 }),
    sequence: fc.integer({ min: 1, max: 40 }),
    side: fc.constantFrom('left' as const, 'right' as const),
    seconds: fc.double({ min: 0.3, max: 1.4, noNaN: true }),
  });
  type Happening = typeof somethingHappens extends fc.Arbitrary<infer T> ? T : never;

  function play(
    testRoom: ReturnType<typeof createTestRoom>,
    happenings: readonly Happening[],
    each: () => void = () => undefined,
  ) {
    const seats = { ann: 0, ben: 1, cal: 2 };
    for (const { who, what, ball, sequence, side, seconds } of happenings) {
      const seat = seats[who];
      const release = releaseOf(Math.min(seat, 1));
      if (what === 'reach') testRoom.pose(who, seat, atRack(ball, 4), testRoom.time + 0.005);
      else if (what === 'stand') testRoom.pose(who, seat, fists(release), testRoom.time + 0.005);
      else if (what === 'grab') testRoom.act(who, { type: 'grab', sequence, side, ball });
      else if (what === 'drop') testRoom.act(who, { type: 'drop', sequence, side });
      else if (what === 'throw') {
        const at = testRoom.time - testRoom.welcomeOf('ann').matchStart;
        const velocity = velocityTo(release, opening, seconds);
        testRoom.act(who, { type: 'throw', sequence, side, ball, at, position: release, velocity });
      } else if (what === 'again') {
        testRoom.ready();
      } else testRoom.pass(seconds, () => testRoom.pose('cal', 2, fists(opening)));
      testRoom.tick();
      each();
    }
  }

  test('a client that follows events from a snapshot, taken any time, knows the Room’s state', () => {
    fc.assert(
      fc.property(fc.array(somethingHappens, { minLength: 5, maxLength: 60 }), (happenings) => {
        const testRoom = createTestRoom({ ball: { balls: 4, seconds: 20 } });
        testRoom.begin();
        const followers: { state: BallState; heard: number }[] = [];
        play(testRoom, happenings, () => {
          const snapshot = ballClientPolicy.unpack(
            JSON.parse(JSON.stringify(new BallPolicy().snapshot(testRoom.room.match))),
          );
          followers.push({ state: snapshot!, heard: testRoom.sent.length });
        });
        for (const { state, heard } of followers) {
          let known = state;
          for (const { message } of testRoom.sent.slice(heard)) {
            if (message.type === 'match') known = ballClientPolicy.unpack(message.match)!;
            if (message.type === 'events') known = message.events.reduce(ballClientPolicy.follow, known);
          }
          const truth = testRoom.room.match;
          expect(known.balls).toEqual(truth.balls);
          for (const key of ['score', 'phase', 'end', 'startedAt', 'options'] as const) {
            expect(known[key]).toEqual(truth[key]);
          }
          const people = ({ players }: BallState) =>
            players.map(({ present, ready, role, station }) => ({ present, ready, role, station }));
          expect(people(known)).toEqual(people(truth));
        }
      }),
      { numRuns: 30 },
    );
  });

  test('equal messages give equal matches, to the last digit', () => {
    fc.assert(
      fc.property(fc.array(somethingHappens, { minLength: 5, maxLength: 40 }), (happenings) => {
        const [one, two] = [createTestRoom({ ball: { balls: 4 } }), createTestRoom({ ball: { balls: 4 } })];
        for (const testRoom of [one, two]) {
          testRoom.begin();
          play(testRoom, happenings);
        }
        expect(two.room.match).toEqual(one.room.match);
        expect(two.sent).toEqual(one.sent);
        let state = ballRules.start(['seat 0', 'seat 1', 'seat 2'], 0, { balls: 4 });
        const first = one.sent.findIndex(({ message }) => message.type === 'match');
        if (first >= 0) return;
        for (const actions of one.log) state = ballRules.step(state, actions).state;
        expect(state).toEqual(one.room.match);
      }),
      { numRuns: 30 },
    );
  });
});

test('an empty room that ticks stays as it is', () => {
  const sent: unknown[] = [];
  const room = new Room(
    new BallPolicy(),
    { id: 'r', epoch: 'e' },
    {
      send: (_, message) => sent.push(message),
      broadcast: (message) => sent.push(message),
      sendPoses: (poses) => sent.push(poses),
      disconnect: (client) => sent.push(client),
      rejected: (refusal) => sent.push(refusal),
    },
  );
  for (let i = 0; i < 600; i++) {
    room.tick(i / 60);
    room.sendPoses();
  }
  expect(sent).toEqual([]);
  expect(room.census).toEqual({ players: 0, bots: 0, spectators: 0, free: 3, empty: true });
});
