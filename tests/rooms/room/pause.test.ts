import { ballMatchTime, ballSecondsLeft } from 'threepoint-games/ball/state-readings';
import { poseMemory } from 'threepoint-rooms/room/pose-claims';
import { describe, expect, test } from 'vitest';
import { atRack, fists, holding, opening, releaseOf, velocityTo } from '../client/people';
import { toldRoom } from './told-room';

/** A room that may be paused, its match under way. */
function playing() {
  const told = toldRoom({ pausable: true });
  told.begin();
  const pause = (client: string, on: boolean) => told.room.onMessage(client, { type: 'pause', pause: on }, told.time);
  const match = () => told.room.match;
  return { told, pause, match };
}

describe('a pause', () => {
  test('stops the clock of the match for as long as one player wants, and no other clock', () => {
    const { told, pause, match } = playing();
    told.pass(5, told.stand);
    pause('ann', true);
    told.tick();
    const left = ballSecondsLeft(match());
    expect(told.room.paused).toBe(true);
    told.pass(300, told.stand);
    pause('ben', true);
    pause('ann', false);
    told.pass(60, told.stand);
    expect(ballSecondsLeft(match())).toBe(left);
    pause('ben', false);
    told.pass(10, told.stand);
    expect(told.room.paused).toBe(false);
    expect(ballSecondsLeft(match())).toBeCloseTo(left - 10, 1);
  });

  test('is told with the second at which the clock stands, also to a page that comes meanwhile', () => {
    const { told, pause, match } = playing();
    told.pass(5, told.stand);
    pause('ann', true);
    told.tick();
    const message = told.said.findLast((line) => line.message.type === 'paused')?.message;
    const at = message?.type === 'paused' ? message.at : null;
    expect(at).toBeCloseTo(ballMatchTime(match()), 1);
    told.pass(40, told.stand);
    expect(told.join('dot', { spectate: true }).paused).toBe(at);
    pause('ann', false);
    told.tick();
    const after = told.said.findLast((line) => line.message.type === 'paused')?.message;
    expect(after).toMatchObject({ type: 'paused', at: null });
    expect(told.time - (after?.type === 'paused' ? after.matchStart : 0)).toBeCloseTo(at ?? -1, 1);
    expect(told.join('eve', { spectate: true }).paused).toBeNull();
  });

  test('leaves a ball in the air where it is and lets it be caught later', () => {
    const { told, pause, match } = playing();
    told.pose('ann', 0, atRack(0), told.time + 0.01);
    told.tick();
    told.act('ann', { type: 'grab', sequence: 1, side: 'right', ball: 0 });
    told.tick();
    told.pose('ann', 0, fists(releaseOf(0)), told.time);
    told.tick();
    const throwing = { position: releaseOf(0), velocity: velocityTo(releaseOf(0), opening, 1) };
    told.act('ann', { type: 'throw', sequence: 2, side: 'right', ball: 0, at: ballMatchTime(match()), ...throwing });
    told.pass(0.4, told.stand);
    pause('cal', true);
    told.pass(60, told.stand);
    expect(match().balls[0]).toMatchObject({ on: 'air', missed: false });
    pause('cal', false);
    told.pass(1.2, told.stand);
    expect(match().balls[0]).toEqual({ on: 'basket', thrower: 0 });
  });

  test('puts what is held back to its rack, and refuses deeds until it is over', () => {
    const { told, pause, match } = playing();
    told.pose('ann', 0, atRack(0), told.time + 0.01);
    told.tick();
    told.act('ann', { type: 'grab', sequence: 1, side: 'right', ball: 0 });
    told.tick();
    expect(match().balls[0]?.on).toBe('hand');
    pause('ben', true);
    told.pass(0.1);
    expect(match().balls[0]).toEqual({ on: 'rack' });
    told.pose('ann', 0, atRack(0), told.time + 0.01);
    told.act('ann', { type: 'grab', sequence: 2, side: 'right', ball: 0 });
    told.tick();
    expect(told.happened('refused')).toEqual([{ type: 'refused', player: 0, sequence: 2, reason: 'phase' }]);
    pause('ben', false);
    told.pass(0.1, () => told.pose('ann', 0, atRack(0), told.time + 0.01));
    told.act('ann', { type: 'grab', sequence: 3, side: 'right', ball: 0 });
    told.pass(0.1);
    expect(match().balls[0]).toEqual({ on: 'hand', player: 0, side: 'right' });
  });

  test('goes on passing the bodies of the others, and keeps none of them in the match', () => {
    const { told, pause, match } = playing();
    pause('ann', true);
    told.tick();
    const before = told.frames.length;
    told.pass(1, told.stand);
    expect(told.frames.length - before).toBe(60);
    expect(match().players.map(({ head, left, right }) => [head, left, right])).toEqual(
      Array(3).fill([null, null, null]),
    );
  });

  test('ends when the player who wanted it gives the seat up or has lost it, not with a hiccup of the connection', () => {
    const { told, pause } = playing();
    pause('ann', true);
    told.tick();
    told.room.disconnect('ann', told.time);
    told.pass(20, told.stand);
    expect(told.room.paused).toBe(true);
    told.pass(11, told.stand);
    expect(told.room.paused).toBe(false);
    pause('ben', true);
    told.tick();
    told.room.onMessage('ben', { type: 'leave' }, told.time);
    told.tick();
    expect(told.room.paused).toBe(false);
  });

  test('that is asked for before the start stops the match as soon as it has begun', () => {
    const told = toldRoom({ pausable: true });
    for (const client of ['ann', 'ben', 'cal']) told.join(client, { name: client });
    told.room.onMessage('ann', { type: 'pause', pause: true }, told.time);
    told.pass(1, told.stand);
    expect(told.room.paused).toBe(false);
    for (const client of ['ann', 'ben', 'cal']) told.room.onMessage(client, { type: 'ready', ready: true }, told.time);
    told.pass(30, told.stand);
    expect(told.room.match.phase).toBe('running');
    expect(ballSecondsLeft(told.room.match)).toBeGreaterThan(89.9);
  });

  test('that is asked for in the very tick of the bell stops nothing: the match is over for all', () => {
    const told = toldRoom({ pausable: true, ball: { seconds: 5 } });
    told.begin();
    told.pass(4.5, told.stand);
    while (ballSecondsLeft(told.room.match) > 1.5 / 60) told.tick();
    told.room.onMessage('ann', { type: 'pause', pause: true }, told.time);
    told.tick(2 / 60);
    expect(told.happened('ended')).toHaveLength(1);
    expect(told.room.paused).toBe(false);
    expect(told.said.filter(({ message }) => message.type === 'paused')).toEqual([]);
    told.room.onMessage('ann', { type: 'pause', pause: false }, told.time);
    for (const client of ['ann', 'ben', 'cal']) told.room.onMessage(client, { type: 'ready', ready: true }, told.time);
    told.pass(0.1);
    expect(told.room.match.phase).toBe('running');
  });

  test('is refused where the terms of the room do not allow it, and to who only watches', () => {
    const told = toldRoom();
    told.begin();
    told.room.onMessage('ann', { type: 'pause', pause: true }, told.time);
    told.pass(1, told.stand);
    expect(told.room.paused).toBe(false);
    const { told: other } = playing();
    other.join('dot', { spectate: true });
    other.room.onMessage('dot', { type: 'pause', pause: true }, other.time);
    other.pass(1, other.stand);
    expect(other.room.paused).toBe(false);
    expect([...told.refusals, ...other.refusals].map(({ reason }) => reason)).toEqual(['not-pausable', 'no-seat']);
  });

  test('costs nothing to keep up: what is said meanwhile does not pile up', () => {
    const { told, pause } = playing();
    pause('ann', true);
    told.tick();
    const longest = () => Math.max(0, ...told.log.map((actions) => actions.length));
    const before = longest();
    told.pass(60, () => {
      told.stand();
      told.room.onMessage('ben', { type: 'ready', ready: true }, told.time);
      told.act('ben', { type: 'drop', sequence: 1, side: 'left' });
    });
    pause('ann', false);
    told.pass(0.1);
    expect(longest()).toBe(before);
  });
});

describe('where a player was', () => {
  test('is forgotten within 2 s of silence, in the room and in the match; the seat is not', () => {
    const { told, match } = playing();
    told.pass(1, told.stand);
    const silent = told.time;
    while (match().players[0]?.head) {
      told.tick();
      told.pose('cal', 2, holding(opening));
    }
    expect(told.time - silent).toBeLessThanOrEqual(2);
    expect(told.time - silent).toBeGreaterThan(poseMemory - 0.1);
    expect(match().players[0]).toMatchObject({ present: true, left: null, right: null });
    expect(match().players[2]?.head).not.toBeNull();
    // Not even the fault that compares with it: a player who comes back may stand anywhere.
    expect(told.pose('ann', 0, fists(releaseOf(0)))).toBe('taken');
    told.tick();
    expect(match().players[0]?.head).not.toBeNull();
  });

  test('is forgotten of a lost connection as well', () => {
    const { told, match } = playing();
    told.room.disconnect('ann', told.time);
    told.pass(2);
    expect(match().players[0]?.head).toBeNull();
    expect(told.join('ann again', {}, 'ann').seat).toBe(0);
  });
});
