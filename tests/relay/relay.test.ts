import { defaultCalibration } from 'threepoint/core';
import { type BallState, ballKind } from 'threepoint-games/ball';
import { messageEvent, protocolVersion } from 'threepoint-rooms/host';
import { bannerText } from 'threepoint-rooms/internal';
import type { ConnectionStatus } from 'threepoint-rooms/room';
import { afterAll, beforeAll, describe, expect, onTestFinished, test, vi } from 'vitest';
import { RoomTokens } from '../../src/relay/access/room-tokens';
import { atRack, fists, holding, opening, releaseOf, shownAt } from '../rooms/client/people';
import { testSecret } from '../server/started-server';
import { arrive, pause, type RunningRelay, rawSocket, startRelay, tokenFor, until } from './running-relay';
import { personOfTest } from './until-finished';

let server: RunningRelay;
beforeAll(async () => {
  server = await startRelay();
});
afterAll(() => server.close());

describe('a relay', () => {
  // A page that stayed open or was kept offline over an update, and a page of a newer server that meets this one.
  test.each([
    // The join of version 3, when the pose packet had another layout: without an avatar.
    ['an older', { version: 3 }],
    ['a newer', { version: protocolVersion + 1, avatar: { name: 'of the future' }, posture: 'seated' }],
  ])('reports to the page of %s version that it is one, and to no one else', async (_, ofVersion) => {
    const ann = personOfTest(server.url, 'versions', 'Ann');
    await until('ann in', () => ann.connection.room !== null);
    const token = await tokenFor(server.url, 'versions');
    const stranger = rawSocket(server.url, token, 'versions');
    const heard: { type?: string; reason?: string }[] = [];
    stranger.on(messageEvent, (message) => heard.push(message));
    const join = {
      type: 'join',
      name: 'Old',
      calibration: defaultCalibration,
      spectate: false,
      bot: false,
      seat: null,
    };
    stranger.on('connect', () => stranger.emit(messageEvent, { ...join, ...ofVersion }));
    await until('the farewell', () => heard.length > 0 && stranger.disconnected);
    expect(heard).toEqual([{ type: 'farewell', reason: 'old-page' }]);
    const status: ConnectionStatus = { phase: 'ended', attempt: 0, retryIn: null, reason: 'old-page' };
    expect(bannerText(status)).toBe('This page and the server have different versions. Reload the page.');
    expect(ann.connection.status.phase).toBe('joined');
    expect(ann.connection.room?.seats.filter(Boolean)).toHaveLength(1);
  });

  test('reports to the page of another site that it may not use the server', async () => {
    const send = fetch;
    vi.stubGlobal('fetch', (url: string, request: RequestInit) =>
      send(url, { ...request, headers: { ...request.headers, origin: 'https://evil.example' } }),
    );
    const { connection, stop } = arrive(server.url, 'forbidden', 'Ann');
    onTestFinished(stop);
    await until('the refusal', () => connection.status.reason !== null);
    expect(bannerText(connection.status)).toMatch(/^The server does not accept requests from this page's address\./);
  });

  test('a seat that is left is free at once', async () => {
    const ann = personOfTest(server.url, 'left', 'Ann');
    const ben = personOfTest(server.url, 'left', 'Ben');
    await until('both in', () =>
      [ann, ben].every(({ connection }) => connection.room?.seats.filter(Boolean).length === 2),
    );
    const seat = ann.seat;
    ann.connection.leave();
    await until('the seat free', () => ben.connection.room?.seats[seat] === null, 2);
    expect(ann.connection.status).toMatchObject({ phase: 'ended', reason: 'left' });
  });

  test('receives every pose that a slow page sends at once', async () => {
    const ann = personOfTest(server.url, 'slow-page', 'Ann');
    const ben = personOfTest(server.url, 'slow-page', 'Ben');
    await until('a pose of ann', () => ben.poses.length > 0);
    ann.freeze();
    await pause(0.2);
    const before = ben.poses.length;
    const time = ann.now();
    for (let i = 5; i >= 0; i--)
      ann.connection.sendPose(time - i / 30, shownAt(ann.connection, ann.seat, fists(opening)));
    await until('six poses', () => ben.poses.length === before + 6, 2);
  });

  test('makes a room as the first to come asks for it, and as no one after', async () => {
    const ann = personOfTest(server.url, 'short', 'Ann', { terms: { seconds: 30, balls: 6 } });
    await until('ann in', () => ann.connection.room !== null);
    const ben = personOfTest(server.url, 'short', 'Ben', { terms: { seconds: 3600 } });
    await until('ben in', () => ben.connection.room !== null);
    for (const { match } of [ann, ben]) expect(match.options).toMatchObject({ seconds: 30, balls: 6 });
    expect(server.relay.rooms.get('short')?.room.options.pausable).toBe(false);
    const cal = personOfTest(server.url, 'usual', 'Cal');
    await until('cal in', () => cal.connection.room !== null);
    expect(cal.match.options).toMatchObject({ seconds: 90, balls: 20 });
  });

  test('stops the clock of a room with assigned seats, and all are told', async () => {
    const room = `study.${'0'.repeat(24)}`;
    const tokens = new RoomTokens(testSecret, () => Date.now() / 1000);
    const people = ['P01', 'P02', 'P03'].map((name, seat) => {
      const pass = { identity: name, room, kind: ballKind, terms: { seconds: 60 }, assigned: { seat, name } };
      return personOfTest(server.url, room, name, { pass: { token: () => tokens.sign(pass) } });
    });
    const [ann] = people as [(typeof people)[0]];
    const all = (isTrue: (person: (typeof people)[0]) => boolean) => () => people.every(isTrue);
    await until(
      'all seats taken',
      all(({ connection }) => connection.room?.seats.every(Boolean) ?? false),
    );
    for (const person of people) person.connection.setReady(true);
    await until(
      'the match running',
      all(({ match }) => match.phase === 'running'),
    );
    ann.connection.setPaused(true);
    await until(
      'the pause',
      all(({ connection }) => connection.room?.paused ?? false),
    );
    const stands = server.relay.rooms.get(room)?.room.match.tick ?? -1;
    const asSeen = people.map(({ match }) => match.tick);
    const heard = people.map(({ poses }) => poses.length);
    await until('each to have heard sixty more poses', () =>
      people.every(({ poses }, i) => poses.length > heard[i]! + 60),
    );
    expect(server.relay.rooms.get(room)?.room.match.tick).toBe(stands);
    expect(people.map(({ match }) => match.tick)).toEqual(asSeen);
    ann.connection.setPaused(false);
    await until(
      'the match going on',
      all(({ match, connection }) => !connection.room?.paused && match.tick > stands),
    );
    for (const { match } of people) expect(match.tick).toBeLessThan(stands + 60);
  });

  test('three people over sockets play a ball into the basket and agree', async () => {
    const people = ['Ann', 'Ben', 'Cal'].map((name) => personOfTest(server.url, 'game', name));
    const [ann, ben, cal] = people as [(typeof people)[0], (typeof people)[0], (typeof people)[0]];
    await until('all seats taken', () =>
      people.every(({ connection }) => connection.room?.seats.every((row) => row !== null)),
    );
    for (const person of people) {
      if (person.seat === 2) person.place(holding(opening));
      else person.place(fists(releaseOf(person.seat)));
      person.connection.setReady(true);
    }
    await until('the match running', () => people.every(({ match }) => match.phase === 'running'));
    const thrower = people.find(({ seat }) => seat === 0)!;
    const rightFist = () => (server.relay.rooms.get('game')?.room.match as BallState | undefined)?.players[0]?.right;
    thrower.place(atRack(0));
    await until('the fist at the rack', () => rightFist()?.y === 0.925);
    thrower.grab(0);
    await until('the ball in hand', () => people.every(({ match }) => match.balls[0]?.on === 'hand'));
    thrower.place(fists(releaseOf(0)));
    await until('the hand up', () => rightFist()?.y === 1.6);
    thrower.toss(0, thrower.now());
    await until('a point', () => people.every(({ match }) => match.score === 1), 5);
    for (const { match } of [ann, ben, cal]) expect(match.balls[0]).toEqual({ on: 'basket', thrower: 0 });
    expect(new Set(ann.poses.map(({ seat }) => seat)).size).toBe(2);
  });
});
