import { expect, test } from 'vitest';
import type { RoomMessage } from '../../../src/rooms/protocol/messages';
import { Room } from '../../../src/rooms/room/room';
import type { FreshPose, RoomRejection } from '../../../src/rooms/room/room-host';
import { fists, opening } from '../client/people';
import { type CountingGame, countingPolicy } from './counting-game';
import { joinRequest, packetAt } from './test-room';

/** Two players who count to three in a room that may be paused. */
function countingRoom() {
  const sent: { readonly to: string; readonly message: RoomMessage<CountingGame> }[] = [];
  const refusals: RoomRejection[] = [];
  const frames: (readonly FreshPose[])[] = [];
  const room = new Room(
    countingPolicy(2),
    { id: 'room', epoch: 'one', pausable: true },
    {
      send: (to, message) => sent.push({ to, message }),
      broadcast: (message) => sent.push({ to: 'all', message }),
      sendPoses: (poses) => frames.push(poses),
      disconnect: () => undefined,
      rejected: (refusal) => refusals.push(refusal),
    },
  );
  let time = 50;
  const testRoom = {
    room,
    sent,
    refusals,
    frames,
    get time() {
      return time;
    },
    /** In steps of two of the game's ticks. */
    pass(seconds: number) {
      for (const end = time + seconds - 1e-9; time < end; room.tick(time)) time += 0.2;
      room.sendPoses();
    },
    say: (client: string, message: Parameters<typeof room.onMessage>[1]) => room.onMessage(client, message, time),
    count: (client: string, to: number) => testRoom.say(client, { type: 'action', action: { type: 'count', to } }),
    events: () => sent.flatMap(({ message }) => (message.type === 'events' ? message.events : [])),
  };
  for (const client of ['ann', 'ben']) room.join(client, client, joinRequest({ name: client }), time);
  for (const client of ['ann', 'ben']) testRoom.say(client, { type: 'ready', ready: true });
  testRoom.pass(0.2);
  return testRoom;
}

test('a Room hosts a game unknown to it: its actions, events, refusals and states', () => {
  const testRoom = countingRoom();
  expect(testRoom.room.match.phase).toBe('running');
  expect(testRoom.count('ann', 1)).toBe('taken');
  testRoom.pass(0.2);
  testRoom.count('ben', 5);
  testRoom.pass(0.2);
  expect(testRoom.events()).toEqual([
    { type: 'counted', player: 0, total: 1 },
    { type: 'refused', player: 1, reason: 'not-next' },
  ]);
  expect(testRoom.sent.filter(({ message }) => message.type === 'events').map(({ to }) => to)).toEqual(['all', 'ben']);
  expect(testRoom.refusals).toEqual([{ client: 'ben', seat: 1, what: 'action', reason: 'not-next' }]);
  expect(testRoom.say('ben', { type: 'action', action: { type: 'grab', ball: 1 } })).toBe('bad');
  testRoom.room.join('dot', 'dot', joinRequest(), testRoom.time);
  const welcome = testRoom.sent.findLast(({ to }) => to === 'dot')?.message;
  expect(welcome).toMatchObject({ type: 'welcome', kind: 'counting', seat: null, match: { total: 1 } });
});

test('an unknown game has its pauses, rematches and poses', () => {
  const testRoom = countingRoom();
  testRoom.say('ben', { type: 'pause', pause: true });
  testRoom.pass(0.2);
  expect(testRoom.room.paused).toBe(true);
  const { tick } = testRoom.room.match;
  testRoom.count('ann', 1);
  testRoom.pass(20);
  expect(testRoom.room.match.tick).toBe(tick);
  expect(testRoom.events()).toEqual([{ type: 'refused', player: 0, reason: 'paused' }]);
  testRoom.say('ben', { type: 'pause', pause: false });
  testRoom.pass(0.2);

  expect(testRoom.room.onPose('ben', packetAt(null, 0, fists(opening), testRoom.time), testRoom.time)).toBe('taken');
  testRoom.pass(0.2);
  // The floor of seat 1 lies a metre up in this game's arena.
  expect(testRoom.room.match.players[1]?.headHeight).toBeCloseTo(2.6, 2);
  expect(testRoom.frames).toHaveLength(1);
  testRoom.pass(2.2);
  expect(testRoom.room.match.players[1]?.headHeight).toBeNull();

  for (const to of [1, 2, 3]) {
    testRoom.count('ann', to);
    testRoom.pass(0.2);
  }
  expect(testRoom.room.match).toMatchObject({ phase: 'over', total: 3 });
  for (const client of ['ann', 'ben']) testRoom.say(client, { type: 'ready', ready: true });
  testRoom.pass(0.2);
  testRoom.pass(0.2);
  expect(testRoom.room.match).toMatchObject({ phase: 'running', total: 0 });
  expect(testRoom.sent.filter(({ message }) => message.type === 'match')).toHaveLength(1);
});
