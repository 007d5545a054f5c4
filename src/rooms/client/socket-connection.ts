import { io, type Socket } from 'socket.io-client';
import { type ClientMessage, protocolVersion } from '../protocol/messages';
import { frameEvent, messageEvent, pageParser, poseEvent } from '../protocol/socket-parsers';
import type { HostedGame } from '../room/match-policy';
import { type BackOff, createBackOff } from './back-off';
import type { ClientPolicy } from './client-policy';
import type { Connection, ConnectionStatus, ConnectionUpdate, LocalClock, Visitor } from './connection';
import type { RoomPass } from './room-pass';
import { RoomSession } from './room-session';

export interface SocketConnectionOptions {
  /** Where the relay is, no slash at its end: mostly the folder of the page. */
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
/** A server that does not end a connection which was left is not waited for any longer [ms]. */
const farewellMs = 1000;
/** So many refusals of fresh passes are an answer. */
const mostRefusals = 3;

/** A place in a room on a relay. Connects at once, and again whenever the connection is lost, until it has ended. */
export const createSocketConnection = <Game extends HostedGame>(
  policy: ClientPolicy<Game>,
  options: SocketConnectionOptions,
): Connection<Game> => new SocketConnection(policy, options);

class SocketConnection<Game extends HostedGame> extends RoomSession<Game> {
  readonly #policy: ClientPolicy<Game>;
  readonly #pass: RoomPass;
  readonly #clock: LocalClock;
  readonly #backOff: BackOff;
  readonly #socket: Socket;
  #phase: ConnectionStatus['phase'] = 'connecting';
  #reason: ConnectionStatus['reason'] = null;
  /** When the next attempt will be made, by the page's clock [s]; null: one is under way, or none will be made. */
  #retryAt: number | null = null;
  #refusals = 0;
  #waiting: ReturnType<typeof setTimeout> | null = null;
  #joinedOnce = false;
  #leftOut: number;

  constructor(
    policy: ClientPolicy<Game>,
    { url, room, visitor, pass, clock = runningTime, chance }: SocketConnectionOptions,
  ) {
    super(policy, visitor, false);
    this.#policy = policy;
    this.#pass = pass;
    this.#clock = clock;
    this.#leftOut = clock.leftOut;
    this.#backOff = createBackOff(chance);
    const { origin, pathname } = new URL(url);
    this.#socket = io(origin, {
      path: `${pathname.replace(/\/$/, '')}/relay`,
      transports: ['websocket'],
      parser: pageParser,
      query: { room },
      reconnection: false,
      autoConnect: false,
      forceNew: true,
      timeout: patienceMs,
    });
    this.#listen();
    this.#attempt();
  }

  get status(): ConnectionStatus {
    return {
      phase: this.#phase,
      attempt: this.#backOff.attempts,
      retryIn: this.#retryAt === null ? null : Math.max(0, this.#retryAt - this.#clock.now()),
      reason: this.#reason,
    };
  }

  update(time: number): ConnectionUpdate<Game> {
    const { leftOut } = this.#clock;
    if (leftOut > this.#leftOut) this.leaveOut(leftOut - this.#leftOut, time);
    this.#leftOut = leftOut;
    return this.takeUpdate(time, this.#isJoined);
  }

  leave(): void {
    const said = this.#isJoined;
    this.transmit({ type: 'leave' });
    // socket.io forgets what came with the very bytes that ended the connection: the server ends it, when it has heard.
    this.#end('left', said ? farewellMs : 0);
  }

  protected transmit(message: ClientMessage): void {
    if (this.#isJoined) this.#socket.emit(messageEvent, message);
  }

  protected transmitPose(bytes: Uint8Array): void {
    if (this.#isJoined) this.#socket.volatile.emit(poseEvent, bytes);
  }

  get #isJoined(): boolean {
    return this.#phase === 'joined';
  }

  /** An attempt that waits for its next try, or a connection that has ended, takes no answers. */
  get #takesAnswers(): boolean {
    return this.#phase !== 'ended' && this.#retryAt === null;
  }

  #listen(): void {
    const socket = this.#socket;
    socket.on('connect', () => {
      socket.emit(messageEvent, { type: 'join', version: protocolVersion, ...this.joinRequest() });
    });
    socket.on('connect_error', (error) => this.#onRefusal(error.message));
    socket.on('disconnect', () => this.#retryLater(this.#reason));
    socket.on(frameEvent, (bytes: unknown) => {
      if (this.#isJoined && bytes instanceof Uint8Array) this.onFrame(bytes, this.#clock.now());
    });
    socket.on(messageEvent, (value: unknown) => this.#onValue(value));
  }

  #onRefusal(text: string): void {
    if (text !== 'refused') {
      this.#retryLater('unreachable');
      return;
    }
    this.#refusals += 1;
    if (this.#refusals >= mostRefusals) this.#end('refused');
    else this.#retryLater('refused');
  }

  #onValue(value: unknown): void {
    const message = this.#policy.readMessage(value);
    if (!message || (this.#phase === 'ended' && message.type !== 'farewell')) return;
    if (message.type === 'farewell') {
      if (message.reason !== 'stopping') this.#end(message.reason);
      else this.#reason = 'stopping';
      return;
    }
    if (message.type === 'welcome') this.#onJoined();
    this.onMessage(message, this.#clock.now());
  }

  #onJoined(): void {
    this.#stopWaiting();
    this.#phase = 'joined';
    this.#reason = null;
    this.#joinedOnce = true;
    this.#refusals = 0;
    this.#backOff.succeeded();
  }

  #attempt(): void {
    this.#retryAt = null;
    this.#wait(patienceMs, () => this.#retryLater('unreachable'));
    this.#pass.token(this.#refusals > 0).then(
      (token) => {
        if (!this.#takesAnswers) return;
        this.#socket.auth = { token };
        this.#socket.connect();
      },
      () => this.#retryLater('unreachable'),
    );
  }

  /** After a failure of any kind: once more, later. */
  #retryLater(because: ConnectionStatus['reason']): void {
    if (!this.#takesAnswers) return;
    this.#phase = this.#joinedOnce ? 'reconnecting' : 'connecting';
    this.#reason = because;
    const seconds = this.#backOff.next();
    this.#retryAt = this.#clock.now() + seconds;
    // What is half open would answer into the next attempt.
    this.#socket.disconnect();
    this.#wait(seconds * 1000, () => this.#attempt());
  }

  /** `afterMs`: how long the other side has to end the connection. */
  #end(because: ConnectionStatus['reason'], afterMs = 0): void {
    this.#stopWaiting();
    this.#phase = 'ended';
    this.#reason = because;
    this.#retryAt = null;
    if (afterMs > 0) this.#wait(afterMs, () => this.#socket.disconnect());
    else this.#socket.disconnect();
  }

  #wait(milliseconds: number, then: () => void): void {
    this.#stopWaiting();
    this.#waiting = setTimeout(then, milliseconds);
  }

  #stopWaiting(): void {
    if (this.#waiting !== null) clearTimeout(this.#waiting);
    this.#waiting = null;
  }
}
