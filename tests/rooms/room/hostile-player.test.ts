import { distance, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import type { ClientMessage } from '../../../src/rooms/protocol/messages';
import { packetMs } from '../../../src/rooms/protocol/packet-time';
import { decodePoints } from '../../../src/rooms/protocol/pose-codec';
import { decodeFrame } from '../../../src/rooms/protocol/pose-frame';
import { maxHeadSpeed } from '../../../src/rooms/room/pose-validator';
import { reportFigures } from '../../reliability/report-figures';
import { poseOf } from './posed-head';
import { createTestRoom } from './test-room';

type SeatMessage = Exclude<ClientMessage, { type: 'join' }>;

/** What the packet with this number, sent at this time [s], says of itself; null: none is sent. */
type Claim = (i: number, time: number) => { readonly timeMs: number; readonly jump: boolean } | null;

/**
 * Speed [m/s] of a head as others see it, whose player sends forty packets a second from alternating ends of the room.
 */
function seenSpeed(claim: Claim): number {
  const testRoom = createTestRoom();
  testRoom.join('ann');
  const seconds = 60;
  for (let i = 0; i < 40 * seconds; i++) {
    testRoom.tick(1 / 40);
    const claimed = claim(i, testRoom.time);
    if (!claimed) continue;
    const { timeMs, jump } = claimed;
    testRoom.send('ann', poseOf({ head: vec3(i % 2 ? 7 : -7, 1.6, 0), timeMs: packetMs(timeMs), jump }));
    testRoom.room.sendPoses();
  }
  let way = 0;
  let last: Vec3 | null = null;
  for (const frame of testRoom.frames) {
    for (const { bytes } of decodeFrame(frame) ?? []) {
      const { x, y, z } = decodePoints(bytes)!.pose.head.position;
      const at = vec3(x, y, z);
      if (last) way += distance(last, at);
      last = at;
    }
  }
  return way / seconds;
}

describe('a seated player who is everywhere at once', () => {
  test.each<[string, Claim]>([
    ['true times', (_, time) => ({ timeMs: time * 1000, jump: false })],
    ['times far ahead', (_, time) => ({ timeMs: time * 1000 + 8000, jump: false })],
    [
      'times that run ahead, and a second of silence',
      (i, time) => (i % 52 < 11 ? { timeMs: time * 1000 + (i % 52) * 735, jump: false } : null),
    ],
    ['a new anchor in every packet', (_, time) => ({ timeMs: time * 1000, jump: true })],
  ])('is seen to go no faster than a head does, with %s', (what, claim) => {
    const speed = seenSpeed(claim);
    reportFigures('hostile-player', { [`head, ${what} [m/s]`]: speed });
    // A leap between the ends of the room is let through about once a second.
    expect(speed).toBeLessThan(maxHeadSpeed + 14 * 1.2);
  });
});

/** What others are sent of a seat. */
const seatMessages = (testRoom: ReturnType<typeof createTestRoom>, seat: number) =>
  testRoom.sent.flatMap(({ message }) => (message.type === 'seat' && message.seat === seat ? [message] : []));

describe('a seated player who changes with every message', () => {
  const hash = (i: number) => String(i).padStart(43, '0');
  const session = (i: number) => `session-${i}`;
  const changes: readonly [string, (i: number) => SeatMessage][] = [
    ['bodies', (i) => ({ type: 'wear', avatar: hash(i) })],
    ['voices', (i) => ({ type: 'voice', voice: { session: session(i), muted: i % 2 === 0 } })],
    ['measures', (i) => ({ type: 'calibration', calibration: { eyeHeight: 1 + (i % 1000) / 1000, armSpan: 1.5 } })],
    ['presences', (i) => ({ type: 'away', away: i % 2 === 0 })],
  ];
  const attackSeconds = 10;
  const perSecond = 1000;

  test.each(changes)('is seen in a few of a thousand %s a second, and finally as they are', (what, change) => {
    const testRoom = createTestRoom({ voices: true });
    testRoom.join('ann');
    testRoom.join('ben');
    testRoom.sent.length = 0;
    for (let i = 0; i < attackSeconds * perSecond; i++) {
      testRoom.say('ann', change(i));
      testRoom.tick(1 / perSecond);
    }
    const sent = seatMessages(testRoom, 0).length;
    reportFigures('hostile-player', {
      [`${what} sent on, of ${attackSeconds * perSecond} in ${attackSeconds} s`]: sent,
    });
    expect(sent).toBeLessThanOrEqual(8 + attackSeconds / 2 + 1);
    expect(testRoom.room.isIdle).toBe(false);
    testRoom.pass(2.1);
    const { seats } = testRoom.join('cal');
    expect(seatMessages(testRoom, 0).at(-1)?.info).toEqual(seats[0]);
  });

  test('is seated elsewhere a few times, and each attempt beyond is refused', () => {
    const testRoom = createTestRoom();
    testRoom.join('ann');
    testRoom.join('ben', { seat: 2 });
    testRoom.sent.length = 0;
    const attempts = attackSeconds * perSecond;
    for (let i = 0; i < attempts; i++) {
      testRoom.say('ann', { type: 'sit', seat: i % 2 === 0 ? 1 : 0 });
      testRoom.tick(1 / perSecond);
    }
    const moves = testRoom.sent.filter(({ message }) => message.type === 'seated').length;
    reportFigures('hostile-player', { [`moves of ${attempts} in ${attackSeconds} s`]: moves });
    expect(moves).toBeLessThanOrEqual(4 + attackSeconds / 2 + 1);
    expect(testRoom.refusals.filter(({ reason }) => reason === 'too-often').length).toBeGreaterThan(attempts / 3);
    expect(testRoom.room.census).toMatchObject({ players: 2, free: 1 });
    expect(testRoom.sent.length).toBeLessThan(150);
  });

  test('takes nothing from the changes of another seat', () => {
    const testRoom = createTestRoom();
    testRoom.join('ann');
    testRoom.join('ben');
    for (let i = 0; i < 100; i++) testRoom.say('ann', { type: 'wear', avatar: hash(i) });
    testRoom.sent.length = 0;
    testRoom.say('ben', { type: 'wear', avatar: 'woman' });
    expect(seatMessages(testRoom, 1)).toHaveLength(1);
    expect(seatMessages(testRoom, 0)).toHaveLength(0);
  });
});
