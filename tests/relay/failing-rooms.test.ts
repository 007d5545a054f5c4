import { expect, test } from 'vitest';
import { countingKind, countingPolicy, countingRoomKind } from '../rooms/room/counting-game';
import { until } from './running-relay';
import { servedRooms } from './served-rooms';
import { guestOfTest } from './until-finished';

/** Rooms of a game that throws when a player counts to 13, and in every tick after `failing.ticks` is set. */
async function failingRooms() {
  const failing = { ticks: false };
  const fail = (): never => {
    throw new Error('a fault of this test');
  };
  const policy = countingPolicy(4);
  const games = new Map([
    [
      countingKind,
      {
        ...countingRoomKind(4),
        createPolicy: () => ({
          ...policy,
          start: (onTick: Parameters<typeof policy.start>[0]) =>
            policy.start((...tick) => (failing.ticks ? fail() : onTick(...tick))),
          readAction: (value: unknown) => ((value as { to?: unknown }).to === 13 ? fail() : policy.readAction(value)),
        }),
      },
    ],
  ]);
  return { ...(await servedRooms({ games })), failing };
}

test('a game that fails at a message costs its sender the connection; the room goes on', async () => {
  const { url, rooms } = await failingRooms();
  const room = `${countingKind}-room`;
  const other = await guestOfTest(url, room);
  const guest = await guestOfTest(url, room);
  guest.say({ type: 'action', action: { type: 'count', to: 13 } });
  await until('the end of the connection', () => guest.socket.disconnected);
  expect(other.socket.connected).toBe(true);
  expect(rooms.census.rooms).toBe(1);
});

test('a room whose game fails at a tick is closed, and other rooms go on', async () => {
  const { url, rooms, failing } = await failingRooms();
  const guest = await guestOfTest(url, `${countingKind}-room`);
  failing.ticks = true;
  await until('the end of the room', () => guest.socket.disconnected);
  expect(guest.heard.at(-1)).toEqual({ type: 'farewell', reason: 'closed' });
  failing.ticks = false;
  await guestOfTest(url, `${countingKind}-other`);
  expect(rooms.census.rooms).toBe(1);
});
