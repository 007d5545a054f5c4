import { defaultAvatar } from 'threepoint/core';
import { ballClientPolicy } from 'threepoint-games/ball';
import { expect, onTestFinished, test, vi } from 'vitest';
import { assignedSeat } from '../../../src/page/people/match/play-room';
import { until } from '../../relay/running-relay';
import { visitor } from '../../rooms/client/people';
import { invitedGroup } from '../../study/participant/invited-group';

const clock = { now: () => performance.now() / 1000, skippedSeconds: 0 };

/** The server, and what brings each of the first group to the court. */
async function invited() {
  const { origin, group, seatOf } = await invitedGroup();
  vi.stubGlobal('location', { href: `${origin}/?play=ball` });
  const come = async (participant: string) => {
    const { connect, avatars } = await assignedSeat(ballClientPolicy, await seatOf(participant), clock);
    expect(avatars).toBeNull();
    const connection = connect(visitor('what the page says', { avatar: 'a'.repeat(43) }), clock.now());
    onTestFinished(() => connection.leave());
    return connection;
  };
  return { origin, group, come };
}

test('invited participants meet in their trial’s room, each on their seat, through the started server', async () => {
  const { origin, group, come } = await invited();
  const connections = await Promise.all(group.map(come));
  await until('all three seated', () =>
    connections.every(({ room }) => room?.seats.filter((seat) => seat !== null).length === group.length),
  );
  expect(connections.map(({ room }) => room?.mySeat)).toEqual([0, 1, 2]);
  for (const { room } of connections) expect(room?.seats.map((seat) => seat?.name)).toEqual(group);
  // Settings that people bring along would identify them.
  for (const { room } of connections)
    expect(room?.seats.map((seat) => seat?.avatar)).toEqual(group.map(() => defaultAvatar));
  expect(await (await fetch(`${origin}/api/rooms`)).json()).toMatchObject({ rooms: [] });
});

test('a match of a group waits for all of it, even for a lost connection', async () => {
  const { group, come } = await invited();
  const [thrower, late, holder] = group as [string, string, string];
  const there = [await come(thrower), await come(holder)];
  const matches = () =>
    there.map((connection) => {
      connection.update(clock.now());
      return connection.room?.match;
    });
  await until('two seated', () => there.every(({ room }) => room !== null));
  for (const connection of there) connection.setReady(true);
  await until('two ready', () => matches().every((match) => match?.players.filter(({ ready }) => ready).length === 2));
  expect(matches().map((match) => match?.phase)).toEqual(['ready', 'ready']);
  const third = await come(late);
  await until('the third seated', () => third.room !== null);
  third.setReady(true);
  await until('begun', () => matches().every((match) => match?.phase === 'running'));
});
