import type { Calibration } from 'threepoint/core/body/calibration';
import { type Skeleton, skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import { plainAvatar, type WornAvatar } from 'threepoint/core/body/worn-avatar';
import type { Transform } from 'threepoint/core/math/pose';
import { type ClientMessage, type JoinRequest, type RoomMessage, toMillimetres } from '../protocol/messages';
import { packetMs } from '../protocol/packet-time';
import { decodePose, encodePose } from '../protocol/pose-codec';
import { decodeFrame } from '../protocol/pose-frame';
import type { SignalBody, Voice } from '../protocol/voice-messages';
import type { HostedGame } from '../room/match-policy';
import type { ClientPolicy } from './client-policy';
import { createClockSync } from './clock-sync';
import type {
  ArrivedPose,
  Connection,
  ConnectionStatus,
  ConnectionUpdate,
  RoomView,
  ShownPose,
  Visitor,
  VoiceChannel,
  VoiceListener,
} from './connection';
import { RoomReplica } from './room-replica';

const poseSeconds = 1 / 30;

/** The last frames while no one asks (a hidden page) are not kept longer than this [packets]. */
const mostWaiting = 256;

/** A client's half of the protocol. Each kind of connection carries it over a wire of its own, in `transmit` and `transmitPose`. */
export abstract class RoomSession<Game extends HostedGame> implements Connection<Game> {
  readonly voices: VoiceChannel = {
    setVoice: (voice) => this.#setVoice(voice),
    signal: (to: string, body: SignalBody) => this.transmit({ type: 'signal', to, body }),
    listen: (listener) => {
      this.#voiceListener = listener;
    },
  };
  readonly #visitor: Visitor;
  /** The Room's clock is this page's own. */
  readonly #knowsClock: boolean;
  readonly #clock = createClockSync();
  readonly #replica: RoomReplica<Game>;
  #calibration: Calibration;
  #avatar: WornAvatar;
  #voice: Voice | null = null;
  #voiceListener: VoiceListener | null = null;
  #skeleton: Skeleton;
  #seatRequest: { spectate: boolean; seat: number | null };
  /** What the room was told first on this connection. */
  #sentJoin: JoinRequest | null = null;
  /** By its type, what was last asked for without a connection, or with its welcome on the way. */
  readonly #queued = new Map<ClientMessage['type'], ClientMessage>();
  /** Whether the clock is to stand; null: never asked for. */
  #pauseRequest: boolean | null = null;
  #welcomes = 0;
  #now = 0;
  #nextPose = Number.NEGATIVE_INFINITY;
  #events: Game['event'][] = [];
  #poses: ArrivedPose[] = [];
  #news: ConnectionUpdate<Game>['news'][number][] = [];
  #view: RoomView<Game> | null = null;

  constructor(policy: ClientPolicy<Game>, visitor: Visitor, knowsClock: boolean) {
    this.#replica = new RoomReplica(policy);
    this.#visitor = visitor;
    this.#knowsClock = knowsClock;
    this.#calibration = toMillimetres(visitor.calibration);
    this.#skeleton = skeletonFromCalibration(this.#calibration);
    this.#avatar = visitor.avatar ?? plainAvatar;
    this.#seatRequest = { spectate: visitor.spectate ?? false, seat: visitor.seat ?? null };
  }

  abstract get status(): ConnectionStatus;
  abstract update(time: number): ConnectionUpdate<Game>;
  abstract leave(): void;
  /** To the Room, in order; nothing while there is no connection. */
  protected abstract transmit(message: ClientMessage): void;
  protected abstract transmitPose(bytes: Uint8Array): void;

  get room(): RoomView<Game> | null {
    const { known } = this.#replica;
    if (!known) return null;
    this.#view ??= {
      id: known.room,
      epoch: known.epoch,
      seats: known.seats,
      mySeat: known.seat,
      spectators: known.spectators,
      rotate: known.rotate,
      match: this.#replica.predicted(this.#now + this.#matchAhead),
      delay: this.#knowsClock ? null : this.#clock.delayAt(this.#now),
      matchAhead: this.#matchAhead,
      paused: known.paused !== null,
      welcomes: this.#welcomes,
      voided: this.#replica.voided,
    };
    return this.#view;
  }

  sendPose(time: number, shown: ShownPose): void {
    if (this.#replica.mySeat === null || (time < this.#nextPose && !shown.jump)) return;
    // Frames come at their own rate: on average thirty packets a second.
    this.#nextPose = Math.max(this.#nextPose + poseSeconds, time + poseSeconds / 2);
    const timeMs = packetMs((time + this.#ahead) * 1000);
    const bytes = encodePose({ ...shown, timeMs }, this.#skeleton);
    if (bytes) this.transmitPose(bytes);
  }

  act(action: Game['action']): void {
    if (!this.#replica.expect(action)) return;
    this.#view = null;
    this.transmit({ type: 'action', action });
  }

  ready(ready: boolean): void {
    this.#sendOrQueue({ type: 'ready', ready });
  }

  rotate(rotate: boolean): void {
    this.#sendOrQueue({ type: 'rotate', rotate });
  }

  pause(pause: boolean): void {
    this.#pauseRequest = pause;
    if (this.#replica.mySeat !== null) this.transmit({ type: 'pause', pause });
  }

  away(away: boolean): void {
    this.#sendOrQueue({ type: 'away', away });
  }

  sit(seat: number | null): void {
    this.#sendOrQueue({ type: 'sit', seat });
  }

  calibrate(calibration: Calibration): void {
    this.#calibration = toMillimetres(calibration);
    this.#skeleton = skeletonFromCalibration(this.#calibration);
    if (this.#replica.known) this.transmit({ type: 'calibration', calibration: this.#calibration });
  }

  wear(avatar: WornAvatar): void {
    if (avatar === this.#avatar) return;
    this.#avatar = avatar;
    if (this.#replica.known) this.transmit({ type: 'wear', avatar });
  }

  arenaFromFloor(seat: number): Transform<'arena', 'floor'> {
    return this.#replica.arenaFromFloor(seat);
  }

  /** What to say first on every new connection. */
  protected joinRequest(): JoinRequest {
    const { name, bot = false } = this.#visitor;
    const own = { calibration: this.#calibration, avatar: this.#avatar, voice: this.#voice };
    this.#sentJoin = { name, bot, ...own, ...this.#seatRequest };
    return this.#sentJoin;
  }

  #sendOrQueue(message: ClientMessage): void {
    if (this.status.phase === 'joined') this.transmit(message);
    else this.#queued.set(message.type, message);
  }

  #sendQueued(): void {
    for (const message of this.#queued.values()) this.transmit(message);
    this.#queued.clear();
  }

  /** What was changed while the welcome was on its way has not been sent. */
  #sendChanges({ calibration, avatar, voice }: JoinRequest): void {
    if (calibration !== this.#calibration) this.transmit({ type: 'calibration', calibration: this.#calibration });
    if (avatar !== this.#avatar) this.transmit({ type: 'wear', avatar: this.#avatar });
    if (voice !== this.#voice) this.transmit({ type: 'voice', voice: this.#voice });
  }

  /** Takes a message of the Room in, heard at this time of the page's clock [s]. */
  protected onMessage(message: RoomMessage<Game>, at: number): void {
    this.#now = Math.max(this.#now, at);
    this.#view = null;
    switch (message.type) {
      case 'pong':
        this.#clock.receive(message.sent, message.time, at);
        return;
      case 'signal':
        this.#voiceListener?.onSignal(message.from, message.body);
        return;
      case 'welcome':
        if (this.#replica.onWelcome(message)) this.#news.push('voided');
        this.#news.push('welcome');
        this.#welcomes += 1;
        // A player who returns to a server that has forgotten them asks for the same seat.
        if (message.seat !== null) this.#seatRequest = { spectate: false, seat: message.seat };
        if (this.#sentJoin) this.#sendChanges(this.#sentJoin);
        this.#sendQueued();
        // The room may have forgotten the wish, or have been told otherwise before the connection was lost.
        if (this.#pauseRequest !== null && message.seat !== null)
          this.transmit({ type: 'pause', pause: this.#pauseRequest });
        this.#voiceListener?.onSeatsChanged();
        return;
      default:
        if (this.#replica.onChange(message)) this.#afterChange(message);
    }
  }

  /** Takes a frame of poses in, heard at this time of the page's clock [s]. */
  protected onFrame(frame: Uint8Array, arrivedAt: number): void {
    // A bot looks at no one: it plays by what the match says.
    if (this.#visitor.bot) return;
    for (const { seat, bytes } of decodeFrame(frame) ?? []) {
      const skeleton = this.#replica.skeletonOf(seat);
      if (!skeleton || seat === this.#replica.mySeat) continue;
      const packet = decodePose(bytes, skeleton);
      if (packet) this.#poses.push({ seat, packet, arrivedAt });
    }
    if (this.#poses.length > mostWaiting) this.#poses = this.#poses.slice(-mostWaiting);
  }

  /** This page's clock left out `seconds` of a pause that ended at `now`; the Room's went on. */
  protected leaveOut(seconds: number, now: number): void {
    this.#clock.paused(seconds, now);
  }

  /** What came since the last call; asks for the Room's time when that is due. */
  protected takeUpdate(time: number, connected: boolean): ConnectionUpdate<Game> {
    this.#now = time;
    this.#view = null;
    if (connected && !this.#knowsClock && this.#clock.due(time)) this.transmit({ type: 'ping', sent: time });
    const since = { events: this.#events, poses: this.#poses, news: this.#news };
    this.#events = [];
    this.#poses = [];
    this.#news = [];
    return since;
  }

  #setVoice(voice: Voice | null): void {
    this.#voice = voice;
    if (this.#replica.known) this.transmit({ type: 'voice', voice });
  }

  #afterChange(message: RoomMessage<Game>): void {
    switch (message.type) {
      case 'seat':
        this.#news.push('seats');
        this.#voiceListener?.onSeatsChanged();
        return;
      case 'seated':
        this.#seatRequest = { spectate: message.seat === null, seat: message.seat };
        this.#news.push('seats');
        if (this.#pauseRequest && message.seat !== null) this.transmit({ type: 'pause', pause: true });
        this.#voiceListener?.onSeatsChanged();
        return;
      case 'match':
        this.#news.push('match');
        return;
      case 'events':
        this.#events.push(...message.events);
    }
  }

  /** Seconds of the Room's clock minus seconds of this page's. */
  get #ahead(): number {
    return this.#knowsClock ? 0 : this.#clock.offset;
  }

  /** Seconds of the match minus seconds of this page's clock. */
  get #matchAhead(): number {
    const { known } = this.#replica;
    if (!known) return 0;
    return known.paused === null ? this.#ahead - known.matchStart : known.paused - this.#now;
  }
}
