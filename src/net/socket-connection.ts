import { io } from 'socket.io-client';
import { ballRoomMessageFrom } from '../core/protocol/ball-messages';
import { protocolVersion } from '../core/protocol/messages';
import { frameEvent, messageEvent, pageParser, poseEvent } from '../core/protocol/small-frames';
import { createBackOff } from './back-off';
import type { Connection, ConnectionStatus, LocalClock, Visitor } from './connection';
import type { RoomPass } from './room-pass';
import { createRoomSession } from './room-session';

export interface SocketConnectionOptions {
  /** Origin of the relay: mostly the page's own. */
  readonly url: string;
  /** Proxies find the process that has the room by this name. */
  readonly room: string;
  readonly visitor: Visitor;
  readonly pass: RoomPass;
  /** Absent: the browser's own, which leaves nothing out. */
  readonly clock?: LocalClock;
  /** Numbers in [0, 1) for the waits between attempts. */
  readonly chance?: () => number;
}

const runningTime: LocalClock = { now: () => performance.now() / 1000, leftOut: 0 };

/** Without an answer in this time [ms] an attempt has failed. */
const patienceMs = 4000;
/** So many refusals of fresh passes are an answer. */
const mostRefusals = 3;

/** A place in a room on a relay. Connects at once, and again whenever the connection is lost, until it has ended. */
export function createSocketConnection(options: SocketConnectionOptions): Connection {
  const { url, room, visitor, pass, clock = runningTime } = options;
  const now = () => clock.now();
  const backOff = createBackOff(options.chance);
  let phase: ConnectionStatus['phase'] = 'connecting';
  let reason: ConnectionStatus['reason'] = null;
  let retryAt: number | null = null;
  let refusals = 0;
  let waiting: ReturnType<typeof setTimeout> | null = null;
  let joinedOnce = false;
  let leftOut = clock.leftOut;

  const socket = io(url, {
    path: '/relay',
    transports: ['websocket'],
    parser: pageParser,
    query: { room },
    reconnection: false,
    autoConnect: false,
    forceNew: true,
    timeout: patienceMs,
  });

  const joined = (): boolean => phase === 'joined';
  const session = createRoomSession(visitor, {
    message(message) {
      if (joined()) socket.emit(messageEvent, message);
    },
    pose(bytes) {
      if (joined()) socket.volatile.emit(poseEvent, bytes);
    },
  });

  function wait(milliseconds: number, then: () => void): void {
    if (waiting !== null) clearTimeout(waiting);
    waiting = setTimeout(then, milliseconds);
  }

  function end(because: ConnectionStatus['reason']): void {
    if (waiting !== null) clearTimeout(waiting);
    waiting = null;
    phase = 'ended';
    reason = because;
    retryAt = null;
    socket.disconnect();
  }

  /** After a failure of any kind: once more, later. */
  function failed(because: ConnectionStatus['reason']): void {
    if (phase === 'ended' || retryAt !== null) return;
    phase = joinedOnce ? 'reconnecting' : 'connecting';
    reason = because;
    const seconds = backOff.next();
    retryAt = now() + seconds;
    // What is half open would answer into the next attempt.
    socket.disconnect();
    wait(seconds * 1000, attempt);
  }

  function attempt(): void {
    retryAt = null;
    wait(patienceMs, () => failed('unreachable'));
    pass.token(refusals > 0).then(
      (token) => {
        if (phase === 'ended' || retryAt !== null) return;
        socket.auth = { token };
        socket.connect();
      },
      () => failed('unreachable'),
    );
  }

  socket.on('connect', () => {
    socket.emit(messageEvent, { type: 'join', version: protocolVersion, ...session.joining() });
  });
  socket.on('connect_error', (error) => {
    if (error.message !== 'refused') {
      failed('unreachable');
      return;
    }
    refusals += 1;
    if (refusals >= mostRefusals) end('refused');
    else failed('refused');
  });
  socket.on('disconnect', () => failed(reason));
  socket.on(frameEvent, (bytes: unknown) => {
    if (joined() && bytes instanceof Uint8Array) session.onFrame(bytes, now());
  });
  socket.on(messageEvent, (value: unknown) => {
    const message = ballRoomMessageFrom(value);
    if (!message) return;
    if (message.type === 'farewell') {
      if (message.reason !== 'stopping') end(message.reason);
      else reason = 'stopping';
      return;
    }
    if (message.type === 'welcome') {
      if (waiting !== null) clearTimeout(waiting);
      waiting = null;
      phase = 'joined';
      reason = null;
      joinedOnce = true;
      refusals = 0;
      backOff.succeeded();
    }
    session.onMessage(message, now());
  });
  attempt();

  return {
    ...session,
    get room() {
      return session.room;
    },
    get status() {
      return {
        phase,
        attempt: backOff.attempts,
        retryIn: retryAt === null ? null : Math.max(0, retryAt - now()),
        reason,
      };
    },
    update(time) {
      if (clock.leftOut > leftOut) session.paused(clock.leftOut - leftOut, time);
      leftOut = clock.leftOut;
      return session.update(time, joined());
    },
    leave() {
      if (joined()) socket.emit(messageEvent, { type: 'leave' });
      end('left');
    },
  };
}
