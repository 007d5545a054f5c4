import fc from 'fast-check';
import { BallPolicy } from 'threepoint-games/ball/ball-policy';
import { packBall, unpackBall } from 'threepoint-games/ball/ball-snapshot';
import type { BallState } from 'threepoint-games/ball/ball-state';
import { followBallEvent } from 'threepoint-games/ball/replica';
import { ballRules } from 'threepoint-games/ball/rules';
import { clientMessageFrom, protocolVersion, unpackSeatInfo } from 'threepoint-rooms/protocol/messages';
import { Room } from 'threepoint-rooms/room/room';
import { seatHoldSeconds } from 'threepoint-rooms/room/seats';
import { describe, expect, test } from 'vitest';
import { atRack, fists, opening, releaseOf, velocityTo } from '../client/people';
import { joining, toldRoom } from './told-room';

const presence = (told: ReturnType<typeof toldRoom>, seat: number) => {
  const seen = told.said.findLast(({ message }) => message.type === 'seat' && message.seat === seat)?.message;
  return seen?.type === 'seat' ? (unpackSeatInfo(seen.info)?.presence ?? 'free') : undefined;
};

describe('seats', () => {
  test('a name stays free of what could trick a reader, and no player is nameless', () => {
    const told = toldRoom();
    const rude = clientMessageFrom({
      type: 'join',
      version: protocolVersion,
      ...joining({ name: ' a\u202eb\u0007\n  c\u200b \u{1f600}'.repeat(4) }),
    });
    expect(rude).toMatchObject({ name: 'ab c \u{1f600} ab c \u{1f600} ab c \u{1f600}' });
    told.join('x', { name: '' });
    expect(unpackSeatInfo(told.welcomeOf('x').seats[0]!)?.name).toBe('Player 1');
  });

  test('a connection lost for less than 30 s gets its seat and score back, even with 16 others waiting', () => {
    const told = toldRoom();
    told.begin();
    told.room.disconnect('ann', told.time);
    expect(presence(told, 0)).toBe('gone');
    for (let i = 0; i < 16; i++) expect(told.join(`w${i}`).seat).toBeNull();
    told.pass(seatHoldSeconds - 1, told.stand);
    const back = told.join('ann again', {}, 'ann');
    expect(back.seat).toBe(0);
    expect(back.match?.phase).toBe('running');
    expect(presence(told, 0)).toBe('here');
  });

  test('after 30 s the seat is free', () => {
    const told = toldRoom();
    told.begin();
    told.room.disconnect('ann', told.time);
    told.pass(seatHoldSeconds + 1, told.stand);
    expect(presence(told, 0)).toBe('free');
    expect(told.join('dot').seat).toBe(0);
    expect(told.join('ann again', {}, 'ann').seat).toBeNull();
  });

  test('a ball in hand survives a hiccup of the connection and goes back to the rack after a longer one', () => {
    const hold = () => {
      const told = toldRoom();
      told.begin();
      told.pose('ann', 0, atRack(0), told.time + 0.01);
      told.tick();
      told.act('ann', { type: 'grab', sequence: 1, side: 'right', ball: 0 });
      told.tick();
      expect(told.room.match.balls[0]?.on).toBe('hand');
      told.room.disconnect('ann', told.time);
      return told;
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

  test('a page that is loaded again at once counts its deeds anew: none is taken for one seen before', () => {
    const told = toldRoom();
    told.begin();
    told.pose('ann', 0, atRack(0), told.time + 0.01);
    told.tick();
    told.act('ann', { type: 'grab', sequence: 1, side: 'right', ball: 0 });
    told.tick();
    told.room.disconnect('ann', told.time);
    told.pass(1);
    told.join('ann again', {}, 'ann');
    told.act('ann again', { type: 'drop', sequence: 1, side: 'right' });
    told.tick();
    expect(told.happened('refused')).toEqual([]);
    expect(told.room.match.balls[0]?.on).toBe('rack');
  });

  test('a second connection of the same person replaces the first', () => {
    const told = toldRoom();
    told.begin();
    expect(told.join('ann on her telephone', {}, 'ann').seat).toBe(0);
    expect(told.dropped).toEqual([{ client: 'ann', reason: 'replaced' }]);
  });

  test('a taken seat is taken by no other, and each attempt is noted', () => {
    const told = toldRoom();
    told.begin();
    told.join('dot', { spectate: true });
    told.room.onMessage('dot', { type: 'sit', seat: 1 }, told.time);
    expect(told.refusals).toMatchObject([{ client: 'dot', what: 'sit', reason: 'occupied' }]);
    expect(told.join('eve', { seat: 1 }).seat).toBeNull();
  });

  test('others learn that a player is away: at once when told, within 3 s of silence, and at once of the return', () => {
    const told = toldRoom();
    told.begin();
    told.room.onMessage('ann', { type: 'away', away: true }, told.time);
    expect(presence(told, 0)).toBe('away');
    told.room.onMessage('ann', { type: 'away', away: false }, told.time);
    expect(presence(told, 0)).toBe('here');
    const quiet = () => {
      told.pose('ann', 0, fists(releaseOf(0)));
      told.pose('cal', 2, fists(opening));
    };
    told.pass(3, quiet);
    expect(presence(told, 1)).toBe('away');
    expect(presence(told, 0)).toBe('here');
    told.pose('ben', 1, fists(releaseOf(1)));
    told.tick();
    expect(presence(told, 1)).toBe('here');
  });

  test('clients may do anything in any order: a seat belongs to at most one, and each who is welcomed knows theirs', () => {
    const step = fc.record({
      who: fc.integer({ min: 0, max: 5 }),
      what: fc.constantFrom('join', 'watch', 'bot', 'disconnect', 'leave', 'sit', 'ready', 'wait'),
      seat: fc.option(fc.integer({ min: 0, max: 3 }), { nil: null }),
      seconds: fc.double({ min: 0, max: 20, noNaN: true }),
    });
    fc.assert(
      fc.property(fc.array(step, { minLength: 1, maxLength: 60 }), (steps) => {
        const told = toldRoom();
        const live = new Map<number, string>();
        let made = 0;
        for (const { who, what, seat, seconds } of steps) {
          const client = live.get(who);
          const arrive = what === 'join' || what === 'watch' || what === 'bot';
          if (arrive) {
            made += 1;
            live.set(who, `c${made}`);
            told.join(`c${made}`, { seat, spectate: what === 'watch', bot: what === 'bot' }, `person ${who}`);
          } else if (client && what === 'disconnect') told.room.disconnect(client, told.time);
          else if (client && what === 'leave') told.room.onMessage(client, { type: 'leave' }, told.time);
          else if (client && what === 'sit') told.room.onMessage(client, { type: 'sit', seat }, told.time);
          else if (client && what === 'ready') told.room.onMessage(client, { type: 'ready', ready: true }, told.time);
          else told.tick(seconds);
          if (what === 'disconnect' || what === 'leave') live.delete(who);
          for (const { client: gone } of told.dropped) {
            for (const [person, current] of live) if (current === gone) live.delete(person);
          }
          told.tick();
          const { players, bots, free, spectators } = told.room.census;
          expect(players + free).toBe(3);
          expect(players + bots).toBeLessThanOrEqual(3);
          expect(spectators).toBeLessThanOrEqual(live.size);
          const present = told.room.match.players.filter((player) => player.present).length;
          expect(present).toBeLessThanOrEqual(players + bots);
        }
      }),
    );
  });
});

describe('a match in a room', () => {
  test('two grabs of one ball in one tick have one winner, for any two players in any order', () => {
    fc.assert(
      fc.property(fc.constantFrom(1, 3), fc.boolean(), (ball, benFirst) => {
        const told = toldRoom({ ball: { balls: 4 } });
        told.begin();
        told.pose('ann', 0, atRack(ball, 4), told.time + 0.01);
        told.pose('ben', 1, atRack(ball, 4), told.time + 0.01);
        told.tick();
        const order = benFirst ? ['ben', 'ann'] : ['ann', 'ben'];
        for (const client of order) told.act(client, { type: 'grab', sequence: 1, side: 'right', ball });
        told.tick();
        const grabbed = told.happened('grabbed');
        const refused = told.said.filter(
          ({ to, message }) => to !== 'all' && message.type === 'events' && message.events[0]?.type === 'refused',
        );
        expect(grabbed).toHaveLength(1);
        expect(grabbed[0]?.player).toBe(benFirst ? 1 : 0);
        expect(refused.map(({ to }) => to)).toEqual([order[1]]);
        expect(told.room.match.balls[ball]).toMatchObject({ on: 'hand', player: grabbed[0]?.player });
      }),
    );
  });

  const readies = (told: ReturnType<typeof toldRoom>, clients: readonly string[]) => {
    for (const client of clients) told.room.onMessage(client, { type: 'ready', ready: true }, told.time);
  };

  test.each([[[0, 2]], [[1, 2]], [[0, 1, 2]]])(
    'moves roles on so that those on seats %j can play each next one',
    (seats) => {
      const told = toldRoom({ ball: { balls: 2, seconds: 0.5 } });
      const clients = seats.map((seat) => `player ${seat}`);
      clients.forEach((client, index) => void told.join(client, { seat: seats[index]! }));
      told.room.onMessage(clients[0]!, { type: 'rotate', rotate: true }, told.time);
      const held: (string | undefined)[] = [];
      for (let match = 0; match < 6; match++) {
        readies(told, clients);
        told.pass(0.2);
        expect(told.room.match.phase).toBe('running');
        held.push(clients[seats.findIndex((seat) => told.room.match.players[seat]?.role === 'holder')]);
        told.pass(1);
        expect(told.room.match.phase).toBe('over');
      }
      expect(held.slice(0, clients.length).sort()).toEqual(clients);
      expect(held.slice(clients.length, 2 * clients.length)).toEqual(held.slice(0, clients.length));
    },
  );

  test('that begins between two ticks of the last one knows who has come since', () => {
    const told = toldRoom({ ball: { balls: 2, seconds: 0.5 } });
    told.begin();
    told.pass(1);
    told.room.onMessage('cal', { type: 'leave' }, told.time);
    readies(told, ['ann', 'ben']);
    told.tick();
    told.tick(1 / 120);
    expect(told.room.match.phase).toBe('over');
    told.room.onMessage('ann', { type: 'rotate', rotate: true }, told.time);
    told.join('dot', { seat: 2 });
    told.tick(1 / 600);
    readies(told, ['ann', 'ben', 'dot']);
    told.pass(0.1);
    expect(told.room.match.players.map(({ present }) => present)).toEqual([true, true, true]);
  });

  test('a match clock that stood still says so, and its numbers go on', () => {
    const told = toldRoom();
    told.begin();
    const { matchStart } = told.welcomeOf('ann');
    const before = told.room.match.tick;
    told.tick(20);
    expect(told.room.match.tick - before).toBeLessThan(5);
    const moved = told.said.findLast(({ message }) => message.type === 'match-start')?.message;
    expect(moved?.type === 'match-start' && moved.matchStart - matchStart).toBeCloseTo(20, 1);
  });

  /** Any deeds at all, by anybody, with poses between them. */
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
    told: ReturnType<typeof toldRoom>,
    happenings: readonly Happening[],
    each: () => void = () => undefined,
  ) {
    const seats = { ann: 0, ben: 1, cal: 2 };
    for (const { who, what, ball, sequence, side, seconds } of happenings) {
      const seat = seats[who];
      const release = releaseOf(Math.min(seat, 1));
      if (what === 'reach') told.pose(who, seat, atRack(ball, 4), told.time + 0.005);
      else if (what === 'stand') told.pose(who, seat, fists(release), told.time + 0.005);
      else if (what === 'grab') told.act(who, { type: 'grab', sequence, side, ball });
      else if (what === 'drop') told.act(who, { type: 'drop', sequence, side });
      else if (what === 'throw') {
        const at = told.time - told.welcomeOf('ann').matchStart;
        const velocity = velocityTo(release, opening, seconds);
        told.act(who, { type: 'throw', sequence, side, ball, at, position: release, velocity });
      } else if (what === 'again') {
        for (const client of ['ann', 'ben', 'cal']) {
          told.room.onMessage(client, { type: 'ready', ready: true }, told.time);
        }
      } else told.pass(seconds, () => told.pose('cal', 2, fists(opening)));
      told.tick();
      each();
    }
  }

  test('a client that follows the events from a snapshot, taken at any time, knows what the Room knows', () => {
    fc.assert(
      fc.property(fc.array(somethingHappens, { minLength: 5, maxLength: 60 }), (happenings) => {
        const told = toldRoom({ ball: { balls: 4, seconds: 20 } });
        told.begin();
        const followers: { state: BallState; heard: number }[] = [];
        play(told, happenings, () => {
          const snapshot = unpackBall(JSON.parse(JSON.stringify(packBall(told.room.match))));
          followers.push({ state: snapshot!, heard: told.said.length });
        });
        for (const { state, heard } of followers) {
          let known = state;
          for (const { message } of told.said.slice(heard)) {
            if (message.type === 'match') known = unpackBall(message.match)!;
            if (message.type === 'events') known = message.events.reduce(followBallEvent, known);
          }
          const truth = told.room.match;
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

  test('the same told again gives the same, to the last digit', () => {
    fc.assert(
      fc.property(fc.array(somethingHappens, { minLength: 5, maxLength: 40 }), (happenings) => {
        const [one, two] = [toldRoom({ ball: { balls: 4 } }), toldRoom({ ball: { balls: 4 } })];
        for (const told of [one, two]) {
          told.begin();
          play(told, happenings);
        }
        expect(two.room.match).toEqual(one.room.match);
        expect(two.said).toEqual(one.said);
        let state = ballRules.start(['seat 0', 'seat 1', 'seat 2'], 0, { balls: 4 });
        const first = one.said.findIndex(({ message }) => message.type === 'match');
        if (first >= 0) return;
        for (const actions of one.log) state = ballRules.step(state, actions).state;
        expect(state).toEqual(one.room.match);
      }),
      { numRuns: 30 },
    );
  });
});

test('an empty room that ticks stays as it is', () => {
  const said: unknown[] = [];
  const room = new Room(
    new BallPolicy(),
    { id: 'r', epoch: 'e' },
    {
      send: (_, message) => said.push(message),
      broadcast: (message) => said.push(message),
      poses: (poses) => said.push(poses),
      drop: (client) => said.push(client),
      refused: (refusal) => said.push(refusal),
    },
  );
  for (let i = 0; i < 600; i++) {
    room.tick(i / 60);
    room.sendPoses();
  }
  expect(said).toEqual([]);
  expect(room.census).toEqual({ players: 0, bots: 0, spectators: 0, free: 3, empty: true });
});
