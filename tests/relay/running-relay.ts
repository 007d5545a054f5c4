import { io, type Socket } from 'socket.io-client';
import { vec3 } from 'threepoint/math';
import { games } from 'threepoint-games/all';
import { type BallGame, ballClientPolicy, ballKind } from 'threepoint-games/ball';
import { ConnectionLimiter, createRouter, noPage } from 'threepoint-http';
import { maxSeats, messageEvent, pageParser, poseEvent } from 'threepoint-rooms/host';
import { createRoomPass, type RoomPass, SocketConnection } from 'threepoint-rooms/internal';
import type { RoomKind, RoomMessage, Visitor } from 'threepoint-rooms/room';
import { createRelay } from '../../src/relay/relay';
import { relayConfigurationFrom } from '../../src/relay/settings/relay-configuration';
import { serve } from '../http/serve';
import { createPerson, visitor } from '../rooms/client/people';
import { countingKind, countingRoomKind } from '../rooms/room/counting-game';
import { poseOf } from '../rooms/room/posed-head';
import { joinMessage } from '../rooms/room/test-room';
import { testSecret } from '../server/started-server';

/** Rooms whose names begin so are of the tests' own game, with as many seats as there may be. */
const kindOf = (room: string): string => (room.startsWith(countingKind) ? countingKind : ballKind);

/** A relay of this process on a free port of loopback. */
export async function startRelay(environment: Record<string, string> = {}, port = 0) {
  const configuration = relayConfigurationFrom({ THREEPOINT_LOG_LEVEL: 'silent', ...environment });
  const connectionLimiter = new ConnectionLimiter({
    perAddress: configuration.connectionsPerAddress,
    behindProxy: configuration.trustProxy,
  });
  const kinds = new Map<string, RoomKind>([
    [ballKind, await games.ball.rooms.createKind(90)],
    [countingKind, countingRoomKind(maxSeats)],
  ]);
  const relay = createRelay(configuration, configuration.secret ?? testSecret, connectionLimiter, kinds);
  const server = await serve(createRouter([relay.service], noPage), {
    port,
    upgrade: relay.upgrade,
    connectionLimiter,
  });
  return {
    relay,
    url: `http://127.0.0.1:${server.port}`,
    port: server.port,
    async close() {
      await relay.close();
      await server.close();
    },
  };
}
export type RunningRelay = Awaited<ReturnType<typeof startRelay>>;

/** Waits until something is true; says what was awaited if it never is. */
export async function until(what: string, isTrue: () => boolean, seconds = 30): Promise<void> {
  const end = performance.now() + seconds * 1000;
  while (!isTrue()) {
    if (performance.now() > end) throw new Error(`waited ${seconds} s in vain: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
}

export const pause = (seconds: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, seconds * 1000));

export const seconds = (): number => performance.now() / 1000;

/** A person over a real socket, sixty frames a second. */
export function arrive(
  url: string,
  room: string,
  name: string,
  {
    terms,
    pass = createRoomPass(url, room, kindOf(room), undefined, terms),
    ...more
  }: Partial<Visitor> & { readonly terms?: object; readonly pass?: RoomPass } = {},
  now = seconds,
) {
  const connection = new SocketConnection(ballClientPolicy, {
    url,
    room,
    visitor: visitor(name, more),
    pass,
    clock: { now, skippedSeconds: 0 },
  });
  const person = createPerson(connection);
  let frames: ((time: number) => void) | null = null;
  const timer = setInterval(() => {
    const time = now();
    person.frame(time);
    frames?.(time);
  }, 1000 / 60);
  return Object.assign(person, {
    now,
    pass,
    everyFrame(then: (time: number) => void) {
      frames = then;
    },
    stop() {
      clearInterval(timer);
      connection.leave();
    },
    /** The page stops doing anything; the connection stays. */
    freeze: () => clearInterval(timer),
  });
}

/** A good pose packet at this time [ms], of a player who stands still, moved aside by so much [m]. */
export const poseBytes = (timeMs: number, aside = 0): Uint8Array => poseOf({ head: vec3(aside, 1.6, 0), timeMs });

export async function tokenFor(url: string, room: string): Promise<string> {
  return createRoomPass(url, room, kindOf(room)).token(false);
}

/** A socket without the project's client: for messages that no page sends. */
export function rawSocket(url: string, token: string, room: string, extraHeaders: Record<string, string> = {}): Socket {
  return io(url, {
    path: '/relay',
    transports: ['websocket'],
    parser: pageParser,
    query: { room },
    auth: { token },
    reconnection: false,
    forceNew: true,
    extraHeaders,
  });
}

/** A raw socket that watches the lobby. */
export const rawLobby = (url: string): Socket =>
  io(`${url}/lobby`, { path: '/relay', transports: ['websocket'], parser: pageParser, forceNew: true });

/** A raw socket that has joined, and what it received. */
export async function rawGuest(url: string, room: string, token?: string) {
  const socket = rawSocket(url, token ?? (await tokenFor(url, room)), room);
  const heard: RoomMessage<BallGame>[] = [];
  let closedAt: number | null = null;
  socket.on(messageEvent, (message: RoomMessage<BallGame>) => heard.push(message));
  socket.on('disconnect', () => {
    closedAt = performance.now();
  });
  const say = (message: unknown) => socket.emit(messageEvent, message);
  socket.on('connect', () => say(joinMessage({ name: 'raw' })));
  await until('the raw guest to be welcomed', () => heard.some(({ type }) => type === 'welcome'));
  return {
    socket,
    heard,
    say,
    pose: (bytes: Uint8Array) => socket.emit(poseEvent, bytes),
    get closedAt() {
      return closedAt;
    },
  };
}
