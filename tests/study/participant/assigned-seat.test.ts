import { defaultAvatar } from 'threepoint/core';
import { assignedSeat } from '../../../src/page/ball/match/ball-connections';
import { relayConfigurationFrom } from 'threepoint-rooms/server';
import { createExperimenterClient, createParticipantClient } from '../../../src/study/client/study-client';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import type { ParticipantState } from '../../../src/study/model/progress/study-api';
import { expect, onTestFinished, test, vi } from 'vitest';
import { shippedRoomKinds } from '../../../server/room-kinds';
import { startServer } from '../../../server/start-server';
import { visitor } from '../../rooms/client/people';
import { testSecret, until } from '../../rooms/server/running-relay';
import { directoryWith } from '../../temporary-directory';
import { paperPlan } from '../model/studies';
import { experimenter as experimenterToken } from '../server/running-studies';

const trial = { step: 'ball/1/trial-1', run: 1 };
const clock = { now: () => performance.now() / 1000, skippedSeconds: 0 };

/** The server as it is started, and what brings each of the first group to the court. */
async function invited() {
  const server = await startServer({
    pageDirectory: directoryWith({ 'index.html': 'the page' }),
    studyDirectory: directoryWith(),
    experimenterToken,
    relay: relayConfigurationFrom({ THREEPOINT_LOG_LEVEL: 'silent' }),
    games: shippedRoomKinds({}),
    secret: testSecret,
    host: '127.0.0.1',
    port: 0,
    log: (line) => expect(line).toBeNull(),
  });
  onTestFinished(() => server.close());
  const origin = `http://127.0.0.1:${server.port}`;
  vi.stubGlobal('location', { href: `${origin}/?play=ball` });

  const experimenter = createExperimenterClient(experimenterToken, origin);
  await experimenter.addStudy(paperPlan(), false);
  const states = await experimenter.participants('paper');
  const invitationOf = (name: string) =>
    states.find(({ participant }: ParticipantState) => participant === name)?.invitation as string;
  const group = scheduleFor(paperPlan(), 'P01').groups.ball?.members as readonly string[];
  const client = createParticipantClient(origin);
  const come = async (participant: string) => {
    const { version } = paperPlan().consent;
    const { token } = await client.claim({ study: 'paper', participant }, invitationOf(participant), version);
    const { connect, avatars } = await assignedSeat(
      () => client.seat({ study: 'paper', participant, token }, trial),
      clock,
    );
    expect(avatars).toBeNull();
    const connection = connect(visitor('what the page says', { avatar: 'a'.repeat(43) }), clock.now());
    onTestFinished(() => connection.leave());
    return connection;
  };
  return { origin, group, come };
}

test('participants who were invited meet in the room of their trial, each on their own seat, through the server as it is started', async () => {
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

test('a match of a group waits for all of it: one whose connection is lost is not played without', async () => {
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
