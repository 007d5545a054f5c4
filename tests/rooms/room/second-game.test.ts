import type { RoomMessage } from 'threepoint-rooms/protocol/messages';
import { Room } from 'threepoint-rooms/room/room';
import type { FreshPose, RoomRefusal } from 'threepoint-rooms/room/room-outlet';
import { expect, test } from 'vitest';
import { fists, opening } from '../client/people';
import { type CountingGame, countingPolicy } from './counting-game';
import { joining, packetAt } from './told-room';

/** Two players who count to three in a room that may be paused. */
function countingRoom() {
  const said: { readonly to: string; readonly message: RoomMessage<CountingGame> }[] = [];
  const refusals: RoomRefusal[] = [];
  const frames: (readonly FreshPose[])[] = [];
  const room = new Room(
    countingPolicy(2),
    { id: 'room', epoch: 'one', pausable: true },
    {
      send: (to, message) => said.push({ to, message }),
      broadcast: (message) => said.push({ to: 'all', message }),
      poses: (poses) => frames.push(poses),
      drop: () => undefined,
      refused: (refusal) => refusals.push(refusal),
    },
  );
  let time = 50;
  const told = {
    room,
    said,
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
    count: (client: string, to: number) => told.say(client, { type: 'action', action: { type: 'count', to } }),
    events: () => said.flatMap(({ message }) => (message.type === 'events' ? message.events : [])),
  };
  for (const client of ['ann', 'ben']) room.join(client, client, joining({ name: client }), time);
  for (const client of ['ann', 'ben']) told.say(client, { type: 'ready', ready: true });
  told.pass(0.2);
  return told;
}

test('a Room hosts a game that it has never heard of: its actions, events, refusals and states', () => {
  const told = countingRoom();
  expect(told.room.match.phase).toBe('running');
  expect(told.count('ann', 1)).toBe('taken');
  told.pass(0.2);
  told.count('ben', 5);
  told.pass(0.2);
  expect(told.events()).toEqual([
    { type: 'counted', player: 0, total: 1 },
    { type: 'refused', player: 1, reason: 'not-next' },
  ]);
  expect(told.said.filter(({ message }) => message.type === 'events').map(({ to }) => to)).toEqual(['all', 'ben']);
  expect(told.refusals).toEqual([{ client: 'ben', seat: 1, what: 'action', reason: 'not-next' }]);
  expect(told.say('ben', { type: 'action', action: { type: 'grab', ball: 1 } })).toBe('bad');
  told.room.join('dot', 'dot', joining(), told.time);
  const welcome = told.said.findLast(({ to }) => to === 'dot')?.message;
  expect(welcome).toMatchObject({ type: 'welcome', kind: 'counting', seat: null, match: { total: 1 } });
});

test('which has its pauses, rematches and poses', () => {
  const told = countingRoom();
  told.say('ben', { type: 'pause', pause: true });
  told.pass(0.2);
  expect(told.room.paused).toBe(true);
  const { tick } = told.room.match;
  told.count('ann', 1);
  told.pass(20);
  expect(told.room.match.tick).toBe(tick);
  expect(told.events()).toEqual([{ type: 'refused', player: 0, reason: 'paused' }]);
  told.say('ben', { type: 'pause', pause: false });
  told.pass(0.2);

  expect(told.room.onPose('ben', packetAt(null, 0, fists(opening), told.time), told.time)).toBe('taken');
  told.pass(0.2);
  // The floor of seat 1 lies a metre up in this game's arena.
  expect(told.room.match.players[1]?.headHeight).toBeCloseTo(2.6, 2);
  expect(told.frames).toHaveLength(1);
  told.pass(2.2);
  expect(told.room.match.players[1]?.headHeight).toBeNull();

  for (const to of [1, 2, 3]) {
    told.count('ann', to);
    told.pass(0.2);
  }
  expect(told.room.match).toMatchObject({ phase: 'over', total: 3 });
  for (const client of ['ann', 'ben']) told.say(client, { type: 'ready', ready: true });
  told.pass(0.2);
  told.pass(0.2);
  expect(told.room.match).toMatchObject({ phase: 'running', total: 0 });
  expect(told.said.filter(({ message }) => message.type === 'match')).toHaveLength(1);
});
