import {
  type AvatarRef,
  averageSkeleton,
  type Calibration,
  defaultAvatar,
  type Skeleton,
  sameMeasures,
} from 'threepoint/core';
import type { Transform } from 'threepoint/math';
import {
  type Absence,
  type ClientMessage,
  type JoinRequest,
  type RoomMessage,
  type SeatInfo,
  unpackSeatInfo,
  type Welcome,
} from '../protocol/messages';
import { packetMs } from '../protocol/packet-time';
import { decodePose, encodePose } from '../protocol/pose-codec';
import { decodeFrame } from '../protocol/pose-frame';
import { toMillimetres } from '../protocol/sent-measures';
import type { SignalBody, Voice } from '../protocol/voice-messages';
import type { HostedGame } from '../room/match-policy';
import type { ClientPolicy } from './client-policy';
import { ClockSync } from './clock-sync';
import type {
  Connection,
  ConnectionStatus,
  ConnectionUpdate,
  OutgoingPose,
  ReceivedPose,
  RoomView,
  SeenAbsence,
  Visitor,
  VoiceChannel,
  VoiceListener,
} from './connection';
import { MatchPrediction } from './match-prediction';

const poseSeconds = 1 / 30;

/** The most packets, and the most events, that are stored while the page is hidden and calls no `update`. */
const maxWaiting = 256;

/** A page that skips more than this [s] was hidden; slow pages skip less between two frames. */
const longestSlowFrame = 3;

/** The state of the Room, as its messages report it. */
interface KnownRoom
  extends Pick<Welcome<HostedGame>, 'room' | 'epoch' | 'seat' | 'spectators' | 'matchStart' | 'paused'> {
  readonly seats: readonly (SeatInfo | null)[];
}

const none: readonly never[] = [];

const skeletonOf = (info: SeatInfo | null): Skeleton | null => info && averageSkeleton(info.calibration);

/** The client's side of the protocol. Subclasses send its messages, in `transmit` and `transmitPose`. */
export abstract class RoomSession<Game extends HostedGame> implements Connection<Game> {
  readonly voices: VoiceChannel = {
    setVoice: (voice) => this.#setVoice(voice),
    sendSignal: (to: string, body: SignalBody) => this.transmit({ type: 'signal', to, body }),
    setListener: (listener) => {
      this.#voiceListener = listener;
    },
  };
  readonly #visitor: Visitor;
  /** Whether the Room uses this page's clock. */
  readonly #knowsClock: boolean;
  readonly #clock = new ClockSync();
  readonly #match: MatchPrediction<Game>;
  readonly #absences = new Map<number, Absence>();
  #known: KnownRoom | null = null;
  #skeletons: (Skeleton | null)[] = [];
  #calibration: Calibration;
  #avatar: AvatarRef;
  #voice: Voice | null = null;
  #voiceListener: VoiceListener | null = null;
  #skeleton: Skeleton;
  #seatRequest: { spectate: boolean; seat: number | null };
  /** The join request of this connection. */
  #sentJoin: JoinRequest | null = null;
  /** Requests that wait for the welcome, the newest of each type. */
  readonly #queued = new Map<ClientMessage['type'], ClientMessage>();
  /** The last requested pause state; null: never requested. */
  #pauseRequest: boolean | null = null;
  #welcomes = 0;
  #voidedRounds = 0;
  #now = 0;
  #nextPose = Number.NEGATIVE_INFINITY;
  #events: Game['event'][] = [];
  #poses: ReceivedPose[] = [];
  #changes: ConnectionUpdate<Game>['changes'][number][] = [];
  #view: RoomView<Game> | null = null;

  constructor(policy: ClientPolicy<Game>, visitor: Visitor, knowsClock: boolean) {
    this.#match = new MatchPrediction(policy);
    this.#visitor = visitor;
    this.#knowsClock = knowsClock;
    this.#calibration = toMillimetres(visitor.calibration);
    this.#skeleton = averageSkeleton(this.#calibration);
    this.#avatar = visitor.avatar ?? defaultAvatar;
    this.#seatRequest = { spectate: visitor.spectate ?? false, seat: visitor.seat ?? null };
  }

  abstract get status(): ConnectionStatus;
  abstract update(time: number): ConnectionUpdate<Game>;
  abstract leave(): void;
  /** Sends a message to the Room, in order; dropped while there is no connection. */
  protected abstract transmit(message: ClientMessage): void;
  protected abstract transmitPose(bytes: Uint8Array): void;

  get room(): RoomView<Game> | null {
    const known = this.#known;
    if (!known) return null;
    this.#view ??= {
      id: known.room,
      epoch: known.epoch,
      seats: known.seats,
      mySeat: known.seat,
      spectators: known.spectators,
      match: this.#match.at(this.#now + this.#matchAhead, known.seat),
      responseTime: this.#knowsClock ? null : this.#clock.delayAt(this.#now),
      matchClockOffset: this.#matchAhead,
      paused: known.paused !== null,
      absences: this.#absences.size === 0 ? none : [...this.#absences.values()].map((absence) => this.#seen(absence)),
      welcomeCount: this.#welcomes,
      voidedRounds: this.#voidedRounds,
    };
    return this.#view;
  }

  sendPose(time: number, shown: OutgoingPose): void {
    if (this.#mySeat === null || (time < this.#nextPose && !shown.jump)) return;
    // Frames have their own rate; this keeps an average of 30 packets a second.
    this.#nextPose = Math.max(this.#nextPose + poseSeconds, time + poseSeconds / 2);
    const timeMs = packetMs((time + this.#ahead) * 1000);
    const bytes = encodePose({ ...shown, timeMs }, this.#skeleton);
    if (bytes) this.transmitPose(bytes);
  }

  sendAction(action: Game['action']): void {
    if (this.#mySeat === null || !this.#match.add(action)) return;
    this.#view = null;
    this.transmit({ type: 'action', action });
  }

  setReady(ready: boolean): void {
    this.#sendOrQueue({ type: 'ready', ready });
  }

  setPaused(pause: boolean): void {
    this.#pauseRequest = pause;
    if (this.#mySeat !== null) this.transmit({ type: 'pause', pause });
  }

  setAway(away: boolean): void {
    this.#sendOrQueue({ type: 'away', away });
  }

  changeSeat(seat: number | null): void {
    this.#sendOrQueue({ type: 'sit', seat });
  }

  calibrate(calibration: Calibration): void {
    this.#calibration = toMillimetres(calibration);
    this.#skeleton = averageSkeleton(this.#calibration);
    if (this.#known) this.transmit({ type: 'calibration', calibration: this.#calibration });
  }

  setAvatar(avatar: AvatarRef): void {
    if (avatar === this.#avatar) return;
    this.#avatar = avatar;
    if (this.#known) this.transmit({ type: 'wear', avatar });
  }

  arenaFromFloor(seat: number): Transform<'arena', 'floor'> {
    return this.#match.arenaFromFloor(seat);
  }

  /** Returns the first message of every new connection. */
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

  /** Sends what has changed since the join request. */
  #sendChanges({ calibration, avatar, voice }: JoinRequest): void {
    if (calibration !== this.#calibration) this.transmit({ type: 'calibration', calibration: this.#calibration });
    if (avatar !== this.#avatar) this.transmit({ type: 'wear', avatar: this.#avatar });
    if (voice !== this.#voice) this.transmit({ type: 'voice', voice: this.#voice });
  }

  /** Handles a message of the Room that arrived at this time of the page's clock [s]. */
  onMessage(message: RoomMessage<Game>, at: number): void {
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
        this.#onWelcome(message);
        return;
      default:
        if (this.#known) this.#onChange(this.#known, message);
    }
  }

  /** Handles a frame of poses that arrived at this time of the page's clock [s]. */
  onFrame(frame: Uint8Array, arrivedAt: number): void {
    // Bots need no poses: they play from the state of the match.
    if (this.#visitor.bot) return;
    for (const { seat, bytes } of decodeFrame(frame) ?? []) {
      const skeleton = this.#skeletons[seat];
      if (!skeleton || seat === this.#mySeat) continue;
      const packet = decodePose(bytes, skeleton);
      if (packet) this.#poses.push({ seat, packet, arrivedAt });
    }
    if (this.#poses.length > maxWaiting) this.#poses = this.#poses.slice(-maxWaiting);
  }

  /** Accounts for a pause that this page's clock skipped [s] and that ended at `now`; the Room's clock ran on. */
  protected leaveOut(seconds: number, now: number): void {
    if (seconds > longestSlowFrame) this.#addChange('resumed');
    this.#clock.addPause(seconds, now);
  }

  /** Returns what has arrived since the last call, and requests the Room's time when that is due. */
  protected takeUpdate(time: number, connected: boolean): ConnectionUpdate<Game> {
    this.#now = time;
    this.#view = null;
    if (connected && !this.#knowsClock && this.#clock.isDue(time)) this.transmit({ type: 'ping', sent: time });
    const update = { events: this.#events, poses: this.#poses, changes: this.#changes };
    this.#events = [];
    this.#poses = [];
    this.#changes = [];
    return update;
  }

  #setVoice(voice: Voice | null): void {
    this.#voice = voice;
    if (this.#known) this.transmit({ type: 'voice', voice });
  }

  /** Applies the whole state, after joining or reconnecting. */
  #onWelcome(message: Welcome<Game>): void {
    const { room, epoch, seat, spectators, matchStart, paused } = message;
    // The server was restarted, and has lost a running round.
    if (this.#known && this.#known.epoch !== epoch && this.#match.confirmed?.phase === 'running') {
      this.#voidedRounds += 1;
      this.#addChange('voided');
    }
    if (this.#known?.epoch !== epoch) this.#absences.clear();
    const seats = message.seats.map(unpackSeatInfo);
    this.#known = { room, epoch, seat, spectators, seats, matchStart, paused };
    this.#skeletons = seats.map(skeletonOf);
    this.#match.restart(message.match);
    this.#addChange('welcome');
    this.#welcomes += 1;
    // After a restart of the server the player requests the same seat.
    if (seat !== null) this.#seatRequest = { spectate: false, seat };
    if (this.#sentJoin) this.#sendChanges(this.#sentJoin);
    for (const queued of this.#queued.values()) this.transmit(queued);
    this.#queued.clear();
    // The room may have lost the request, or have received another one before the connection was lost.
    if (this.#pauseRequest !== null && seat !== null) this.transmit({ type: 'pause', pause: this.#pauseRequest });
    this.#voiceListener?.onSeatsChanged();
  }

  #onChange(known: KnownRoom, message: RoomMessage<Game>): void {
    switch (message.type) {
      case 'seat':
        this.#setSeatInfo(known, message.seat, unpackSeatInfo(message.info));
        this.#addChange('seats');
        this.#voiceListener?.onSeatsChanged();
        return;
      case 'seated':
        this.#known = { ...known, seat: message.seat };
        this.#match.discardPending();
        this.#seatRequest = { spectate: message.seat === null, seat: message.seat };
        this.#addChange('seats');
        if (this.#pauseRequest && message.seat !== null) this.transmit({ type: 'pause', pause: true });
        this.#voiceListener?.onSeatsChanged();
        return;
      case 'about':
        this.#known = { ...known, spectators: message.spectators };
        return;
      case 'paused':
        this.#known = { ...known, matchStart: message.matchStart, paused: message.at };
        return;
      case 'absence':
        this.#absences.set(message.absence.number, message.absence);
        return;
      case 'match-start':
        this.#known = { ...known, matchStart: message.matchStart };
        return;
      case 'match':
        this.#known = { ...known, matchStart: message.matchStart };
        this.#match.restart(message.match);
        this.#addChange('match');
        return;
      case 'events':
        for (const event of message.events) this.#match.follow(event, known.seat);
        this.#events.push(...message.events);
        if (this.#events.length > maxWaiting) this.#events = this.#events.slice(-maxWaiting);
    }
  }

  #seen({ since: _, until, ...absence }: Absence): SeenAbsence {
    const isLimited = absence.seconds === null && until !== null;
    return { ...absence, secondsLeft: isLimited ? Math.max(0, until - this.#now - this.#ahead) : null };
  }

  #setSeatInfo(known: KnownRoom, seat: number, info: SeatInfo | null): void {
    if (seat >= known.seats.length) return;
    const before = known.seats[seat];
    this.#known = { ...known, seats: known.seats.map((other, index) => (index === seat ? info : other)) };
    if (!info || !before || !sameMeasures(before.calibration, info.calibration))
      this.#skeletons[seat] = skeletonOf(info);
  }

  #addChange(word: ConnectionUpdate<Game>['changes'][number]): void {
    if (!this.#changes.includes(word)) this.#changes.push(word);
  }

  /** This page's seat; null: a spectator, or before the first welcome. */
  get #mySeat(): number | null {
    return this.#known?.seat ?? null;
  }

  /** The Room's clock minus the page's clock [s]. */
  get #ahead(): number {
    return this.#knowsClock ? 0 : this.#clock.offset;
  }

  /** The match clock minus the page's clock [s]. */
  get #matchAhead(): number {
    const known = this.#known;
    if (!known) return 0;
    return known.paused === null ? this.#ahead - known.matchStart : known.paused - this.#now;
  }
}
