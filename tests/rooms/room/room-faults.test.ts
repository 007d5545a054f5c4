import fc from 'fast-check';
import { addScaled, createRandom, isFiniteVec3, vec3 } from 'threepoint/math';
import { BallPolicy, type BallState, ballClientPolicy } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { clientMessageFrom, maxSeats } from '../../../src/rooms/protocol/messages';
import { decodeFrame } from '../../../src/rooms/protocol/pose-frame';
import { relayParser } from '../../../src/rooms/protocol/socket-parsers';
import { Room } from '../../../src/rooms/room/room';
import { isNightly } from '../../nightly';
import { printFigures } from '../../print-figures';
import { fists, holding, opening, releaseOf, velocityTo } from '../client/people';
import { countingPolicy } from './counting-game';
import { createTestRoom, joinRequest } from './test-room';

const allFinite = (value: unknown): boolean => {
  if (typeof value === 'number') return Number.isFinite(value);
  return typeof value !== 'object' || value === null || Object.values(value).every(allFinite);
};

test('fuzzed packets of every kind throw nothing and leave no NaN in any state', { tags: ['full'] }, () => {
  const packets = isNightly ? 1_000_000 : 100_000;
  const chance = createRandom(20261121);
  const pick = (count: number) => Math.floor(chance() * count);
  const testRoom = createTestRoom();
  testRoom.begin();
  const good = () => testRoom.packet(0, fists(vec3(chance() - 0.5, 0.5 + chance(), -chance())), testRoom.time);
  const words = 'type action grab throw ready at sequence __proto__ constructor seat 1e999'.split(' ');
  const jsonLike = (depth: number): unknown => {
    const kind = pick(depth > 3 ? 6 : 8);
    if (kind === 0) return null;
    if (kind === 1) return (chance() - 0.5) * 10 ** (chance() * 40);
    if (kind === 2) return words[pick(words.length)];
    if (kind === 3) return chance() < 0.5;
    if (kind === 4) return pick(50);
    if (kind === 5) return '\u202e\u0000'.repeat(pick(5));
    if (kind === 6) return Array.from({ length: pick(4) }, () => jsonLike(depth + 1));
    return Object.fromEntries(Array.from({ length: pick(5) }, () => [words[pick(words.length)], jsonLike(depth + 1)]));
  };
  const decoder = new relayParser.Decoder();
  let [taken, understood, refusedFrames] = [0, 0, 0];
  for (let i = 0; i < packets; i++) {
    const bytes = i % 50 === 0 ? good() : Uint8Array.from({ length: pick(70) }, () => pick(256));
    const kind = i % 5;
    if (kind <= 1) {
      const mutated = good();
      for (let flips = pick(3); flips >= 0; flips--) mutated[pick(mutated.length)]! ^= 1 << pick(8);
      if (testRoom.send('ann', chance() < 0.5 ? mutated : bytes) === 'taken') taken += 1;
    } else if (kind === 2) {
      const value = { type: words[pick(words.length)], ...(jsonLike(0) as object | null) };
      const near: Record<string, unknown> = {
        type: pick(2) ? 'throw' : 'grab',
        sequence: pick(60),
        side: pick(2) ? 'left' : 'right',
        ball: pick(21),
      };
      if (near.type === 'throw') {
        Object.assign(near, {
          at: testRoom.time - 1000,
          position: releaseOf(0),
          velocity: vec3(0, 0, -4 - 40 * chance()),
        });
      }
      if (chance() < 0.3) near[Object.keys(near)[pick(4)]!] = jsonLike(2);
      const message = clientMessageFrom(chance() < 0.5 ? value : { type: 'action', action: near });
      const isHeard = message && message.type !== 'join' && message.type !== 'leave';
      const isBad = isHeard && testRoom.say('ann', message) === 'bad';
      if (message && !isBad) understood += 1;
      ballClientPolicy.readMessage(value);
    } else if (kind === 3) {
      if (!decodeFrame(bytes)) refusedFrames += 1;
    } else {
      const text = chance() < 0.5 ? `2${JSON.stringify(jsonLike(0))}` : String.fromCharCode(...bytes);
      try {
        decoder.add(text);
      } catch (error) {
        // What is no packet ends the connection: that is what throwing means to socket.io, and all that it may throw.
        expect(error).toBeInstanceOf(Error);
      }
    }
    if (i % 20 === 0) testRoom.tick();
  }
  expect(allFinite(testRoom.room.match)).toBe(true);
  for (const { head, left, right } of testRoom.room.match.players) {
    for (const place of [head, left, right]) expect(place === null || isFiniteVec3(place)).toBe(true);
  }
  printFigures('fuzz', {
    packets,
    crashes: 0,
    'poses believed': taken,
    'messages understood': understood,
    'frames refused': refusedFrames,
  });
  expect(taken).toBeGreaterThan(0);
  expect(understood).toBeGreaterThan(packets / 50);
});

describe('latency', () => {
  /**
   * A throw at a moving basket, all clients this long from the Room [s one way, and by how much that varies]; what
   * became of it.
   */
  function verdict(seed: number, delay: number, jitter: number): string {
    const chance = createRandom(seed);
    const [dx, dy, dz] = [0, 0, 0].map(() => (chance() - 0.5) * 0.8) as [number, number, number];
    const aim = vec3(opening.x + dx * 0.6, opening.y + dy * 0.3, opening.z + dz * 0.6);
    const flight = 0.8 + 0.5 * chance();
    const sway = { x: chance() * 0.3, speed: 1 + 2 * chance(), phase: chance() * 6 };
    const basketAt = (time: number) =>
      addScaled(opening, vec3(1, 0, 0), sway.x * Math.sin(sway.speed * time + sway.phase));
    // How late each message is must not change what the throw was.
    const late = createRandom(seed + 1_000_003);
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.grab();
    testRoom.tick();
    testRoom.pose('ann', 0, fists(releaseOf(0)), testRoom.time);
    const start = testRoom.time;
    const { matchStart } = testRoom.welcomeOf('ann');
    const underway: { readonly at: number; readonly send: () => void }[] = [];
    let lastCal = 0;
    const throwAt = start + 0.25;
    for (let i = 0; i < 150; i++) {
      const time = start + i / 60;
      if (i % 2 === 0) {
        // TCP: nothing overtakes.
        lastCal = Math.max(lastCal, time + delay + jitter * late());
        const bytes = testRoom.packet(2, holding(basketAt(time - start)), time);
        underway.push({ at: lastCal, send: () => void testRoom.send('cal', bytes) });
        const anns = testRoom.packet(0, fists(releaseOf(0)), time);
        underway.push({ at: time + delay, send: () => void testRoom.send('ann', anns) });
      }
      if (time <= throwAt && time + 1 / 60 > throwAt) {
        const velocity = velocityTo(releaseOf(0), aim, flight);
        const action = { ...testRoom.throwOf(0, 2, velocity), at: throwAt - matchStart };
        underway.push({ at: throwAt + delay + jitter * late(), send: () => testRoom.act('ann', action) });
      }
      for (const message of underway.filter(({ at }) => at <= time && at > time - 1 / 60)) message.send();
      testRoom.tick();
    }
    const place = testRoom.room.match.balls[0]!.on;
    return place === 'basket'
      ? 'caught'
      : testRoom.happened('bounced').some(({ off }) => off === 'basket')
        ? 'rim'
        : 'missed';
  }

  test('a throw is judged as it would be without any', { tags: ['full'] }, () => {
    const throws = isNightly ? 1000 : 200;
    let same = 0;
    const counts = { caught: 0, rim: 0, missed: 0 };
    for (let seed = 1; seed <= throws; seed++) {
      const truth = verdict(seed, 0, 0);
      counts[truth as keyof typeof counts] += 1;
      const oneWay = 0.1 * ((seed * 0.618) % 1);
      if (verdict(seed, oneWay, 0.02) === truth) same += 1;
    }
    printFigures('throws at round trips of 0 to 200 ms', {
      throws,
      ...counts,
      'same verdict [%]': (100 * same) / throws,
    });
    expect(same / throws).toBeGreaterThanOrEqual(0.99);
    expect(Math.min(counts.caught, counts.missed)).toBeGreaterThan(throws / 20);
  });
});

describe('a page that comes at t = 60 s', () => {
  test('knows everything from one snapshot of at most 2 kB', () => {
    const testRoom = createTestRoom({ ball: { balls: 20 } });
    // The longest names there are.
    for (const client of ['ann', 'ben', 'cal']) testRoom.join(client, { name: '\u{1f600}'.repeat(10) });
    testRoom.ready();
    testRoom.stand();
    testRoom.tick();
    let sequence = 0;
    testRoom.pass(20, testRoom.stand);
    for (let ball = 0; ball < 10; ball++) {
      testRoom.grab(ball, ++sequence);
      testRoom.tick();
      testRoom.stand();
      testRoom.tick();
      testRoom.act('ann', testRoom.throwOf(ball, ++sequence, vec3(1.2345678 - ball, 4.1234567, -3.1234567)));
      testRoom.pass(4, testRoom.stand);
    }
    testRoom.join('dot', { spectate: true });
    const welcome = testRoom.welcomeOf('dot');
    const bytes = Buffer.byteLength(JSON.stringify(welcome));
    const known = ballClientPolicy.unpack(welcome.match!)!;
    const truth = testRoom.room.match;
    expect(known.balls).toEqual(truth.balls);
    // JSON knows no −0.
    expect(known.basket).toEqual(JSON.parse(JSON.stringify(truth.basket)));
    printFigures('join at 60 s', {
      'snapshot [B]': bytes,
      'balls on the floor': truth.balls.filter(({ on }) => on === 'floor').length,
    });
    expect(bytes).toBeLessThanOrEqual(2048);
  });

  test('no state of a match, and no room of sixteen, takes more than 2 kB', () => {
    const number = (limit: number) =>
      fc.double({ min: -limit, max: limit, noNaN: true }).map((x) => Math.round(x * 1e4) / 1e4 + 0);
    const vector = (limit: number) => fc.record({ x: number(limit), y: number(limit), z: number(limit) });
    const testRoom = createTestRoom();
    testRoom.begin();
    const launch = fc.record({ time: number(3600).map(Math.abs), position: vector(40), velocity: vector(20) });
    fc.assert(
      fc.property(fc.array(launch, { minLength: 20, maxLength: 20 }), (launches) => {
        const state: BallState = {
          ...testRoom.room.match,
          tick: 3600 * 60,
          balls: launches.map((flight) => ({ on: 'air', launch: flight, thrower: 1, missed: true })),
        };
        const packed = new BallPolicy().snapshot(state);
        expect(ballClientPolicy.unpack(JSON.parse(JSON.stringify(packed)))?.balls).toEqual(state.balls);
        const welcome = { ...testRoom.welcomeOf('ann'), match: packed };
        expect(Buffer.byteLength(JSON.stringify(welcome))).toBeLessThanOrEqual(2048);
      }),
    );
  });

  test('no welcome to a room with the most seats takes more than 2 kB', () => {
    const sent: number[] = [];
    const room = new Room(
      countingPolicy(maxSeats),
      { id: 'room', epoch: 'one' },
      {
        send: (_, message) => sent.push(Buffer.byteLength(JSON.stringify(message))),
        broadcast: () => undefined,
        sendPoses: () => undefined,
        disconnect: () => undefined,
        rejected: () => undefined,
      },
    );
    for (let i = 0; i < maxSeats; i++)
      room.join(`c${i}`, `c${i}`, joinRequest({ name: '\u{1f600}'.repeat(10), avatar: 'x'.repeat(43) }), 1000);
    expect(room.census.free).toBe(0);
    expect(sent).toHaveLength(maxSeats);
    expect(Math.max(...sent)).toBeLessThanOrEqual(2048);
  });
});

test('5 s and 29 s of silence cost nothing: same seat, same score, one snapshot', () => {
  const figures: Record<string, number> = {};
  for (const silence of [5, 29]) {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.grab();
    testRoom.pass(0.1, testRoom.stand);
    testRoom.act('ann', testRoom.throwOf(0, 2));
    testRoom.pass(1.5, testRoom.stand);
    expect(testRoom.room.match.score).toBe(1);
    testRoom.room.disconnect('ann', testRoom.time);
    testRoom.pass(silence, testRoom.stand);
    const before = testRoom.sent.length;
    const back = testRoom.join('ann again', {}, 'ann');
    const welcomes = testRoom.sent.slice(before).filter(({ message }) => message.type === 'welcome');
    expect(back.seat).toBe(0);
    expect(back.match?.score).toBe(1);
    expect(welcomes).toHaveLength(1);
    expect(back.match?.balls.map((place) => (place === 0 ? 'rack' : place[0]))).toEqual([4, ...Array(19).fill('rack')]);
    figures[`snapshots after ${silence} s`] = welcomes.length;
  }
  printFigures('silence', figures);
});

test('rooms that live for hours keep nothing: the same answer, no growth', { tags: ['full'] }, () => {
  const hours = isNightly ? 4 : 0.1;
  const testRoom = createTestRoom({ ball: { seconds: 5, balls: 2 } });
  testRoom.begin();
  const sizes: number[] = [];
  let rounds = 0;
  for (let second = 0; second < hours * 3600; second++) {
    testRoom.pass(1, testRoom.stand);
    testRoom.ready();
    if (second % 30 === 0) {
      testRoom.room.disconnect('ben', testRoom.time);
      testRoom.join('ben', {}, 'ben');
      sizes.push(JSON.stringify(testRoom.room.match).length);
    }
    rounds += testRoom.sent.filter(({ message }) => message.type === 'match').length;
    testRoom.sent.splice(3);
    testRoom.frames.length = 0;
    testRoom.log.length = 0;
  }
  printFigures('soak of a Room', { hours, rounds, 'state at most [B]': Math.max(...sizes) });
  expect(rounds).toBeGreaterThan(hours * 300);
  expect(Math.max(...sizes)).toBeLessThan(4000);
});
