import { io, type Socket } from 'socket.io-client';
import { type ClientMessage, protocolVersion } from '../protocol/messages';
import { frameEvent, messageEvent, pageParser, poseEvent } from '../protocol/socket-parsers';
import type { HostedGame } from '../room/match-policy';
import { BackOff } from './back-off';
import type { ClientPolicy } from './client-policy';
import type { ConnectionStatus, ConnectionUpdate, LocalClock, Visitor } from './connection';
import type { RoomPass } from './room-pass';
import { RoomSession } from './room-session';

export interface SocketConnectionOptions {
  /** The address of the relay, without a trailing slash: usually the folder of the page. */
  readonly url: string;
  /** The name of the room, by which a proxy finds its process. */
  readonly room: string;
  readonly visitor: Visitor;
  readonly pass: RoomPass;
  /** Default: `performance.now`, which skips no pauses. */
  readonly clock?: LocalClock;
  /** Called when the connection has joined, has lost or failed an attempt, or has ended. */
  readonly onStatus?: () => void;
}

const runningTime: LocalClock = { now: () => performance.now() / 1000, skippedSeconds: 0 };

/** Timeout of an attempt [ms]. */
const timeoutMs = 4000;
/** After `leave` the page closes the connection itself after this time [ms], if the server has not. */
const closingMs = 1000;
/** After this many refusals of renewed passes the connection ends. */
const maxRejections = 3;

/** A connection to a room on a relay, which is opened again whenever it is lost, until it has ended. */
export class SocketConnection<Game extends HostedGame> extends RoomSession<Game> {
  readonly #policy: ClientPolicy<Game>;
  readonly #pass: RoomPass;
  readonly #clock: LocalClock;
  readonly #backOff = new BackOff();
  readonly #socket: Socket;
  readonly #onStatus: () => void;
  #phase: ConnectionStatus['phase'] = 'connecting';
  #reason: ConnectionStatus['reason'] = null;
  /** Time of the next attempt by the page's clock [s]; null: one is under way, or none will be made. */
  #retryAt: number | null = null;
  #rejections = 0;
  #waiting: ReturnType<typeof setTimeout> | null = null;
  #joinedOnce = false;
  #leftOut: number;

  constructor(
    policy: ClientPolicy<Game>,
    { url, room, visitor, pass, clock = runningTime, onStatus = () => undefined }: SocketConnectionOptions,
  ) {
    super(policy, visitor, false);
    this.#policy = policy;
    this.#pass = pass;
    this.#clock = clock;
    this.#leftOut = clock.skippedSeconds;
    this.#onStatus = onStatus;
    const { origin, pathname } = new URL(url);
    this.#socket = io(origin, {
      path: `${pathname.replace(/\/$/, '')}/relay`,
      transports: ['websocket'],
      parser: pageParser,
      query: { room },
      reconnection: false,
      autoConnect: false,
      forceNew: true,
      timeout: timeoutMs,
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
    const { skippedSeconds } = this.#clock;
    if (skippedSeconds > this.#leftOut) this.leaveOut(skippedSeconds - this.#leftOut, time);
    this.#leftOut = skippedSeconds;
    return this.takeUpdate(time, this.#isJoined);
  }

  leave(): void {
    const isJoined = this.#isJoined;
    this.transmit({ type: 'leave' });
    // socket.io drops a message that arrives with the end of the connection: the server closes it after the message.
    this.#end('left', isJoined ? closingMs : 0);
  }

  protected transmit(message: ClientMessage): void {
    if (this.#isJoined) this.#socket.emit(messageEvent, message);
  }

  protected transmitPose(bytes: Uint8Array): void {
    // Not volatile: of the poses of one slow frame, socket.io would drop all but the first.
    if (this.#isJoined) this.#socket.emit(poseEvent, bytes);
  }

  get #isJoined(): boolean {
    return this.#phase === 'joined';
  }

  /** Whether answers count: not between two attempts, nor after the end. */
  get #takesAnswers(): boolean {
    return this.#phase !== 'ended' && this.#retryAt === null;
  }

  #listen(): void {
    const socket = this.#socket;
    socket.on('connect', () => {
      socket.emit(messageEvent, { type: 'join', version: protocolVersion, ...this.joinRequest() });
    });
    socket.on('connect_error', (error) => this.#onRejection(error.message));
    socket.on('disconnect', () => this.#retryLater(this.#reason));
    socket.on(frameEvent, (bytes: unknown) => {
      if (this.#isJoined && bytes instanceof Uint8Array) this.onFrame(bytes, this.#clock.now());
    });
    socket.on(messageEvent, (value: unknown) => this.#onValue(value));
  }

  #onRejection(text: string): void {
    if (text !== 'refused') {
      this.#retryLater('unreachable');
      return;
    }
    this.#rejections += 1;
    if (this.#rejections >= maxRejections) this.#end('refused');
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
    if (message.type === 'welcome') this.#onStatus();
  }

  #onJoined(): void {
    this.#stopWaiting();
    this.#phase = 'joined';
    this.#reason = null;
    this.#joinedOnce = true;
    this.#rejections = 0;
    this.#backOff.reset();
  }

  #attempt(): void {
    this.#retryAt = null;
    this.#wait(timeoutMs, () => this.#retryLater('unreachable'));
    this.#pass.token(this.#rejections > 0).then(
      (token) => {
        if (!this.#takesAnswers) return;
        this.#socket.auth = { token };
        this.#socket.connect();
      },
      (error: Error) => this.#retryLater(error.cause === 403 ? 'forbidden' : 'unreachable'),
    );
  }

  /** Schedules the next attempt after a failure. */
  #retryLater(because: ConnectionStatus['reason']): void {
    if (!this.#takesAnswers) return;
    this.#phase = this.#joinedOnce ? 'reconnecting' : 'connecting';
    this.#reason = because;
    const seconds = this.#backOff.next();
    this.#retryAt = this.#clock.now() + seconds;
    // A half-open connection could answer during the next attempt.
    this.#socket.disconnect();
    this.#wait(seconds * 1000, () => this.#attempt());
    this.#onStatus();
  }

  /** Ends the connection. `afterMs`: how long the server has to close it. */
  #end(because: ConnectionStatus['reason'], afterMs = 0): void {
    this.#stopWaiting();
    const isNew = this.#phase !== 'ended';
    this.#phase = 'ended';
    this.#reason = because;
    this.#retryAt = null;
    if (afterMs > 0) this.#wait(afterMs, () => this.#socket.disconnect());
    else this.#socket.disconnect();
    if (isNew) this.#onStatus();
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
