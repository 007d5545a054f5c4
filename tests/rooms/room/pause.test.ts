import { ballRules, ballSecondsLeft } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { poseRetentionSeconds } from '../../../src/rooms/room/pose-validator';
import { atRack, fists, holding, opening, releaseOf } from '../client/people';
import { createTestRoom } from './test-room';

/** A room that may be paused, its match under way. */
function playing() {
  const testRoom = createTestRoom({ pausable: true });
  testRoom.begin();
  const pause = (client: string, on: boolean) => testRoom.say(client, { type: 'pause', pause: on });
  const match = () => testRoom.room.match;
  return { testRoom, pause, match };
}

describe('a pause', () => {
  test('stops the clock of the match while one player wants, and no other clock', () => {
    const { testRoom, pause, match } = playing();
    testRoom.pass(5, testRoom.stand);
    pause('ann', true);
    testRoom.tick();
    const left = ballSecondsLeft(match());
    expect(testRoom.room.paused).toBe(true);
    testRoom.pass(300, testRoom.stand);
    pause('ben', true);
    pause('ann', false);
    testRoom.pass(60, testRoom.stand);
    expect(ballSecondsLeft(match())).toBe(left);
    pause('ben', false);
    testRoom.pass(10, testRoom.stand);
    expect(testRoom.room.paused).toBe(false);
    expect(ballSecondsLeft(match())).toBeCloseTo(left - 10, 1);
  });

  test('sends the second at which the clock stands, also to a page that joins meanwhile', () => {
    const { testRoom, pause, match } = playing();
    testRoom.pass(5, testRoom.stand);
    pause('ann', true);
    testRoom.tick();
    const message = testRoom.sent.findLast((line) => line.message.type === 'paused')?.message;
    const at = message?.type === 'paused' ? message.at : null;
    expect(at).toBeCloseTo(match().tick * ballRules.tickSeconds, 1);
    testRoom.pass(40, testRoom.stand);
    expect(testRoom.join('dot', { spectate: true }).paused).toBe(at);
    pause('ann', false);
    testRoom.tick();
    const after = testRoom.sent.findLast((line) => line.message.type === 'paused')?.message;
    expect(after).toMatchObject({ type: 'paused', at: null });
    expect(testRoom.time - (after?.type === 'paused' ? after.matchStart : 0)).toBeCloseTo(at ?? -1, 1);
    expect(testRoom.join('eve', { spectate: true }).paused).toBeNull();
  });

  test('leaves a ball in the air where it is and lets it be caught later', () => {
    const { testRoom, pause, match } = playing();
    testRoom.grab();
    testRoom.tick();
    testRoom.pose('ann', 0, fists(releaseOf(0)), testRoom.time);
    testRoom.tick();
    testRoom.act('ann', testRoom.throwOf(0, 2));
    testRoom.pass(0.4, testRoom.stand);
    pause('cal', true);
    testRoom.pass(60, testRoom.stand);
    expect(match().balls[0]).toMatchObject({ on: 'air', missed: false });
    pause('cal', false);
    testRoom.pass(1.2, testRoom.stand);
    expect(match().balls[0]).toEqual({ on: 'basket', thrower: 0 });
  });

  test('puts what is held back to its rack, and refuses actions until it is over', () => {
    const { testRoom, pause, match } = playing();
    testRoom.grab();
    testRoom.tick();
    expect(match().balls[0]?.on).toBe('hand');
    pause('ben', true);
    testRoom.pass(0.1);
    expect(match().balls[0]).toEqual({ on: 'rack' });
    testRoom.pose('ann', 0, atRack(0), testRoom.time + 0.01);
    testRoom.act('ann', { type: 'grab', sequence: 2, side: 'right', ball: 0 });
    testRoom.tick();
    expect(testRoom.happened('refused')).toEqual([{ type: 'refused', player: 0, sequence: 2, reason: 'phase' }]);
    pause('ben', false);
    testRoom.pass(0.1, () => testRoom.pose('ann', 0, atRack(0), testRoom.time + 0.01));
    testRoom.act('ann', { type: 'grab', sequence: 3, side: 'right', ball: 0 });
    testRoom.pass(0.1);
    expect(match().balls[0]).toEqual({ on: 'hand', player: 0, side: 'right' });
  });

  test('goes on passing the bodies of the others, and keeps none of them in the match', () => {
    const { testRoom, pause, match } = playing();
    pause('ann', true);
    testRoom.tick();
    const before = testRoom.frames.length;
    testRoom.pass(1, testRoom.stand);
    expect(testRoom.frames.length - before).toBe(60);
    expect(match().players.map(({ head, left, right }) => [head, left, right])).toEqual(
      Array(3).fill([null, null, null]),
    );
  });

  test('ends when its player gives up or loses the seat, not with a short disconnection', () => {
    const { testRoom, pause } = playing();
    pause('ann', true);
    testRoom.tick();
    testRoom.room.disconnect('ann', testRoom.time);
    testRoom.pass(20, testRoom.stand);
    expect(testRoom.room.paused).toBe(true);
    testRoom.pass(11, testRoom.stand);
    expect(testRoom.room.paused).toBe(false);
    pause('ben', true);
    testRoom.tick();
    testRoom.say('ben', { type: 'leave' });
    testRoom.tick();
    expect(testRoom.room.paused).toBe(false);
  });

  test('stops the match as soon as it has begun when requested before the start', () => {
    const testRoom = createTestRoom({ pausable: true });
    for (const client of ['ann', 'ben', 'cal']) testRoom.join(client, { name: client });
    testRoom.say('ann', { type: 'pause', pause: true });
    testRoom.pass(1, testRoom.stand);
    expect(testRoom.room.paused).toBe(false);
    testRoom.ready();
    testRoom.pass(30, testRoom.stand);
    expect(testRoom.room.match.phase).toBe('running');
    expect(ballSecondsLeft(testRoom.room.match)).toBeGreaterThan(89.9);
  });

  test('stops nothing when requested in the very tick of the bell: the match is over', () => {
    const testRoom = createTestRoom({ pausable: true, ball: { seconds: 5 } });
    testRoom.begin();
    testRoom.pass(4.5, testRoom.stand);
    while (ballSecondsLeft(testRoom.room.match) > 1.5 / 60) testRoom.tick();
    testRoom.say('ann', { type: 'pause', pause: true });
    testRoom.tick(2 / 60);
    expect(testRoom.happened('ended')).toHaveLength(1);
    expect(testRoom.room.paused).toBe(false);
    expect(testRoom.sent.filter(({ message }) => message.type === 'paused')).toEqual([]);
    testRoom.say('ann', { type: 'pause', pause: false });
    testRoom.ready();
    testRoom.pass(0.1);
    expect(testRoom.room.match.phase).toBe('running');
  });

  test('is refused where the room’s terms forbid it, and to mere watchers', () => {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.say('ann', { type: 'pause', pause: true });
    testRoom.pass(1, testRoom.stand);
    expect(testRoom.room.paused).toBe(false);
    const { testRoom: other } = playing();
    other.join('dot', { spectate: true });
    other.say('dot', { type: 'pause', pause: true });
    other.pass(1, other.stand);
    expect(other.room.paused).toBe(false);
    expect([...testRoom.refusals, ...other.refusals].map(({ reason }) => reason)).toEqual(['not-pausable', 'no-seat']);
  });

  test('costs nothing to keep up: what is sent meanwhile does not pile up', () => {
    const { testRoom, pause } = playing();
    pause('ann', true);
    testRoom.tick();
    const longest = () => Math.max(0, ...testRoom.log.map((actions) => actions.length));
    const before = longest();
    testRoom.pass(60, () => {
      testRoom.stand();
      testRoom.say('ben', { type: 'ready', ready: true });
      testRoom.act('ben', { type: 'drop', sequence: 1, side: 'left' });
    });
    pause('ann', false);
    testRoom.pass(0.1);
    expect(longest()).toBe(before);
  });
});

describe('the last place of a player', () => {
  test('is forgotten within 2 s of silence, in room and match; the seat is not', () => {
    const { testRoom, match } = playing();
    testRoom.pass(1, testRoom.stand);
    const silent = testRoom.time;
    while (match().players[0]?.head) {
      testRoom.tick();
      testRoom.pose('cal', 2, holding(opening));
    }
    expect(testRoom.time - silent).toBeLessThanOrEqual(2);
    expect(testRoom.time - silent).toBeGreaterThan(poseRetentionSeconds - 0.1);
    expect(match().players[0]).toMatchObject({ present: true, left: null, right: null });
    expect(match().players[2]?.head).not.toBeNull();
    // Not even the fault that compares with it: a player who comes back may stand anywhere.
    expect(testRoom.pose('ann', 0, fists(releaseOf(0)))).toBe('taken');
    testRoom.tick();
    expect(match().players[0]?.head).not.toBeNull();
  });

  test('is forgotten after a lost connection as well', () => {
    const { testRoom, match } = playing();
    testRoom.room.disconnect('ann', testRoom.time);
    testRoom.pass(2);
    expect(match().players[0]?.head).toBeNull();
    expect(testRoom.join('ann again', {}, 'ann').seat).toBe(0);
  });
});
