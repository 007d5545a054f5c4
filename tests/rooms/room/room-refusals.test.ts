import { vec3 } from 'threepoint/math';
import type { BallGame } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { clientMessageFrom } from '../../../src/rooms/protocol/messages';
import { fists, opening, releaseOf, velocityTo } from '../client/people';
import { createTestRoom } from './test-room';

describe('what the Room refuses', () => {
  /** Ann has ball 0 in her right hand, held up where she throws. */
  function holdingBall() {
    const testRoom = createTestRoom();
    testRoom.begin();
    testRoom.grab();
    testRoom.pass(0.1, testRoom.stand);
    expect(testRoom.room.match.balls[0]?.on).toBe('hand');
    return testRoom;
  }
  const release = releaseOf(0);
  const thrown = { type: 'throw', side: 'right', ball: 0, position: release } as const;

  test.each([
    ['a throw at 100 m/s', { velocity: vec3(0, 0, -100) }, 'speed'],
    ['a release 10 m from the hand', { position: vec3(release.x, release.y, release.z - 10) }, 'reach'],
    ['a release at the far end of no arm', { position: vec3(release.x, release.y + 1, release.z) }, 'reach'],
    ['a ball that is in no hand', { ball: 5 }, 'not-held'],
  ])('%s', (_what, change, reason) => {
    const testRoom = holdingBall();
    const velocity = velocityTo(release, opening, 1);
    testRoom.act('ann', { ...thrown, sequence: 2, at: 0, velocity, ...change });
    testRoom.tick();
    expect(testRoom.refusals).toMatchObject([{ client: 'ann', seat: 0, what: 'action', reason }]);
    expect(testRoom.room.match.balls[0]?.on).toBe('hand');
    expect(testRoom.happened('thrown')).toEqual([]);
  });

  test("another player's ball, and a message that names another seat", () => {
    const testRoom = holdingBall();
    testRoom.act('ben', { ...thrown, sequence: 1, at: 0, velocity: velocityTo(release, opening, 1) });
    testRoom.tick();
    expect(testRoom.refusals).toMatchObject([{ client: 'ben', seat: 1, reason: 'not-held' }]);
    const drop: BallGame['action'] = { type: 'drop', sequence: 2, side: 'right' };
    const named: BallGame['action'] & { player: number } = { ...drop, player: 0 };
    expect(testRoom.act('ben', named)).toBe('bad');
    expect(clientMessageFrom({ type: 'action', action: drop, seat: 0 })).toBeNull();
    testRoom.tick();
    expect(testRoom.room.match.balls[0]).toEqual({ on: 'hand', player: 0, side: 'right' });
  });

  test('spectators who play, and clients that never joined', () => {
    const testRoom = holdingBall();
    testRoom.join('dot', { spectate: true });
    testRoom.act('dot', { type: 'drop', sequence: 1, side: 'right' });
    testRoom.act('stranger', { type: 'drop', sequence: 1, side: 'right' });
    testRoom.say('dot', { type: 'ready', ready: true });
    expect(testRoom.refusals.map(({ reason }) => reason)).toEqual(['no-seat', 'not-joined', 'no-seat']);
    expect(testRoom.pose('dot', 0, fists(release))).toBe('ignored');
  });
});
