import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import type { Calibration } from 'threepoint/core/body/calibration';
import type { Fingers } from 'threepoint/core/body/hand-shape';
import type { WornAvatar } from 'threepoint/core/body/worn-avatar';
import { createEstimator } from 'threepoint/core/estimation/estimators';
import type { Buttons } from 'threepoint/core/input/button-presses';
import { invertTransform, type Transform } from 'threepoint/core/math/pose';
import { identity } from 'threepoint/core/math/quat';
import type { Side } from 'threepoint/core/math/side';
import { zero } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { BallConnection, BallRoomView } from 'threepoint-games/ball/ball-client';
import type { BallEvent } from 'threepoint-games/ball/ball-state';
import type { BallCue, BallGestureFrame, BallGestures, BallPulse } from 'threepoint-games/ball/gestures';
import type { PlayerInput } from 'threepoint-games/ball/player-postures';
import { holderStation } from 'threepoint-games/ball/stations';
import {
  type BallSteering,
  createSteeredHolder,
  createSteeredThrower,
  type SteeredPlayer,
} from 'threepoint-games/ball/steered-players';
import type { BallBot } from 'threepoint-games/ball/thrower-motion';
import type { ConnectionStatus, Visitor, VoiceChannel } from 'threepoint-rooms/client/connection';
import { createRemotePlayers, type RemotePlayer } from 'threepoint-rooms/client/remote-players';
import {
  actorFor,
  BallBots,
  bodyAt,
  type CourtSight,
  gesturesOf,
  momentsUntil,
  moveOnce,
  performedAt,
  play,
  readyAfter,
  stationOf,
} from './ball-bots';
import { type BallFrame, type BallProbe, CourtPeople, probeOf } from './ball-frame';

/** A match and who plays it, apart from everything that is seen of it. */
export interface BallPlay {
  readonly status: ConnectionStatus;
  readonly room: BallRoomView | null;
  /** How this page sets up voices with the others; null: not connected yet. */
  readonly voices: VoiceChannel | null;
  /** Where the arena lies in this room: by the own seat; a spectator stands in the arena's own frame. Another object with every change. */
  readonly floorFromArena: Transform<'floor', 'arena'>;
  readonly newest: BallFrame | null;
  /** Once a frame, before anything else of it: hears the room and moves the bots. */
  begin(time: number): void;
  /**
   * Head, hands and buttons of a built-in player on the own seat at `time` [s]; null: there is no seat yet. catchUp: what it does
   * between two slow frames is played as well, as no device could.
   */
  act(time: number, catchUp?: boolean): PlayerInput | null;
  /** The tracked frame and its buttons become play; null frame: no one is seen, or a spectator. */
  follow(time: number, frame: TrackingFrame | null, buttons: Buttons): BallFrame | null;
  /** The solved body of this frame, for the others. */
  send(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void;
  /** The floor lies elsewhere from the next frame on: others see a jump and no streak, and hands throw nothing by it. */
  jumped(): void;
  ready(on: boolean): void;
  rotate(on: boolean): void;
  sit(seat: number | null): void;
  /** Stops the match's clock, or no longer wants it stopped; refused where the room's terms do not allow it. */
  pause(on: boolean): void;
  away(on: boolean): void;
  calibrate(calibration: Calibration): void;
  /** What the others are to see this player with. */
  wear(avatar: WornAvatar): void;
  probe(): BallProbe | null;
  leave(): void;
}

export interface BallPlayOptions {
  connect(visitor: Visitor, time: number): BallConnection;
  readonly visitor: Visitor;
  /** Whether bots take the seats that are free; asked for in every frame. */
  bots(): boolean;
  /** Whether the own seat's hands are a built-in player's: who is then ready by itself. */
  acting(): boolean;
  /** What a mouse wants of the own seat's player, own floor frame; null or absent: nothing, a built-in one plays. */
  steering?(): BallSteering | null;
  readonly seed: number;
}

const idle: BallSteering = {
  ray: { origin: zero, direction: { x: 0, y: 0, z: -1 } },
  pressed: false,
  cancelled: false,
};
const nowhere: Transform<'floor', 'arena'> = { position: zero, orientation: identity };
const connecting: ConnectionStatus = { phase: 'connecting', attempt: 0, retryIn: null, reason: null };
const emptyHands: Readonly<Record<Side, number | null>> = { left: null, right: null };
/** A result that a person may want to read stands this long before a built-in player wants another round [s]. */
const rematchAfter = 7;

/** The player on the own seat who needs no person, or does what a mouse wants. */
interface OwnPlayer {
  readonly station: number;
  readonly eyeHeight: number;
  readonly since: 'mouse' | 'ready' | 'later';
  readonly bot: BallBot | SteeredPlayer;
}

/** The start of a list that has nothing in it mostly. */
const none: readonly never[] = [];

class MatchPlay implements BallPlay {
  newest: BallFrame | null = null;
  private calibration: Calibration;
  private connection: BallConnection | null = null;
  private readonly remote = createRemotePlayers();
  private others: readonly RemotePlayer[] = [];
  private readonly sight: CourtSight = { stood: 0, opening: null };
  private readonly bots: BallBots;
  private readonly people = new CourtPeople();
  private events: readonly BallEvent[] = none;
  private gestures: BallGestures | null = null;
  private own: OwnPlayer | null = null;
  private wish: BallSteering | null = null;
  private jump = false;
  /** For the moments of the own built-in player that no picture shows. */
  private readonly between;
  private actedAt: number | null = null;
  private missedCues: readonly BallCue[] = none;
  private missedHaptics: readonly BallPulse[] = none;
  /** Since when the match has been waiting in this phase for a player to be ready [s]. */
  private waitingSince: { readonly phase: string; readonly at: number } | null = null;
  /** Who sat where when it was looked at last. */
  private seating: BallRoomView['seats'] = none;
  private begunAt: number | null = null;
  private placedBy: Transform<'arena', 'floor'> | null = null;
  private placed = nowhere;

  constructor(private readonly options: BallPlayOptions) {
    this.calibration = options.visitor.calibration;
    this.between = createEstimator('ik', this.calibration);
    this.bots = new BallBots(options, this.sight);
  }

  get status(): ConnectionStatus {
    return this.connection?.status ?? connecting;
  }

  get room(): BallRoomView | null {
    return this.connection?.room ?? null;
  }

  get voices(): VoiceChannel | null {
    return this.connection?.voices ?? null;
  }

  get floorFromArena(): Transform<'floor', 'arena'> {
    const seat = this.room?.mySeat ?? null;
    if (!this.connection || seat === null) return nowhere;
    const arenaFromFloor = this.connection.arenaFromFloor(seat);
    if (arenaFromFloor !== this.placedBy) {
      this.placedBy = arenaFromFloor;
      this.placed = invertTransform(arenaFromFloor);
    }
    return this.placed;
  }

  begin(time: number): void {
    this.connection ??= this.options.connect(this.options.visitor, time);
    if (this.room?.paused && this.begunAt !== null) this.sight.stood += time - this.begunAt;
    this.begunAt = time;
    const update = this.connection.update(time);
    for (const pose of update.poses) this.remote.receive(pose);
    if (update.events.length > 0) this.events = [...this.events, ...update.events];
    if (update.news.length > 0) this.gestures?.resume();
    this.gestures?.onEvents(update.events);
    this.watchSeats();
    this.bots.seat(this.connection, time);
    this.bots.move(time);
    this.readyByItself(time);
    this.others = this.remote.follow(time);
  }

  act(time: number, catchUp = true): PlayerInput | null {
    const line = this.connection;
    const seen = line?.room;
    if (!line || !seen?.match || seen.mySeat === null) return null;
    this.wish = this.options.steering?.() ?? null;
    const { bot, handedOver } = this.ownPlayer(seen, seen.mySeat);
    if (handedOver) {
      // Other hands than those that held the ball: nothing is thrown on the way from the ones to the others.
      this.gestures ??= gesturesOf(line);
      const { frame, buttons } = performedAt(bot, time, seen.match, seen.mySeat, this.sight);
      play(line, this.gestures, { ...frame, suspended: true }, buttons);
      this.actedAt = time;
    }
    if (catchUp) this.catchUp(line, bot, time);
    return performedAt(bot, time, line.room?.match ?? seen.match, seen.mySeat, this.sight);
  }

  follow(time: number, frame: TrackingFrame | null, buttons: Buttons): BallFrame | null {
    const line = this.connection;
    const before = line?.room;
    if (!line || !before?.match) {
      this.newest = null;
      return null;
    }
    const me = before.mySeat;
    let played: BallGestureFrame | null = null;
    if (frame && me !== null) {
      this.gestures ??= gesturesOf(line);
      played = play(line, this.gestures, frame, buttons);
    }
    const seen = line.room ?? before;
    const state = seen.match ?? before.match;
    this.people.look(line, seen, frame, this.others, this.floorFromArena);
    const { players, bodies, opening } = this.people;
    this.sight.opening = opening;
    this.newest = {
      state,
      epoch: before.epoch,
      connection: line.status.phase,
      time: time + before.matchAhead,
      me,
      role: me === null ? null : (state.players[me]?.role ?? null),
      rotate: before.rotate,
      spectators: before.spectators,
      paused: before.paused,
      players,
      bodies,
      opening,
      events: this.events,
      cues: joined(this.missedCues, played?.cues),
      haptics: joined(this.missedHaptics, played?.haptics),
      held: played?.held ?? emptyHands,
      aim: this.wish && this.own && 'aim' in this.own.bot ? this.own.bot.aim : null,
    };
    this.events = none;
    this.missedCues = none;
    this.missedHaptics = none;
    return this.newest;
  }

  send(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void {
    if (this.room?.mySeat === null) return;
    this.connection?.sendPose(frame.time, { jump: this.jump, pose, fingers });
    this.jump = false;
  }

  jumped(): void {
    this.jump = true;
    this.gestures?.jumped();
  }

  ready(on: boolean): void {
    this.connection?.ready(on);
  }

  rotate(on: boolean): void {
    this.connection?.rotate(on);
  }

  sit(seat: number | null): void {
    this.connection?.sit(seat);
  }

  pause(on: boolean): void {
    this.connection?.pause(on);
  }

  away(on: boolean): void {
    this.connection?.away(on);
  }

  calibrate(next: Calibration): void {
    this.calibration = next;
    this.between.calibrate(next);
    this.own = null;
    this.connection?.calibrate(next);
  }

  wear(avatar: WornAvatar): void {
    this.connection?.wear(avatar);
  }

  probe(): BallProbe | null {
    return this.newest && this.connection && probeOf(this.newest, this.connection);
  }

  leave(): void {
    this.bots.leave();
    this.connection?.leave();
  }

  /** A person who takes a seat does not glide there from where the one before them was. */
  private watchSeats(): void {
    const seats = this.room?.seats;
    if (!seats || seats === this.seating) return;
    for (let seat = 0; seat < seats.length; seat++) {
      const [now, before] = [seats[seat], this.seating[seat]];
      if (now?.name !== before?.name || now?.bot !== before?.bot) this.remote.forget(seat);
    }
    this.seating = seats;
  }

  /** A built-in player is ready by itself. */
  private readyByItself(time: number): void {
    const { options } = this;
    const seen = this.room;
    const match = seen?.match;
    if (!match || seen.mySeat === null || match.phase === 'running') {
      this.waitingSince = null;
      return;
    }
    if (this.waitingSince?.phase !== match.phase) this.waitingSince = { phase: match.phase, at: time };
    // A mouse has a person behind it, who says when.
    if (!options.acting() || options.steering?.() || match.players[seen.mySeat]?.ready) return;
    const patience = match.phase === 'over' ? rematchAfter : readyAfter;
    if (time - this.waitingSince.at > patience && match.players.filter(({ present }) => present).length > 1) {
      this.connection?.ready(true);
    }
  }

  /** Another station, another body, or a mouse that comes or goes: another player, but not while a round is played. */
  private ownPlayer(
    seen: BallRoomView,
    seat: number,
  ): { readonly bot: OwnPlayer['bot']; readonly handedOver: boolean } {
    const { own } = this;
    const { eyeHeight } = this.calibration;
    const station = stationOf(seen, seat);
    const phase = seen.match?.phase;
    const since = this.wish ? 'mouse' : phase === 'ready' ? 'ready' : 'later';
    const handedOver = own !== null && 'aim' in own.bot !== (this.wish !== null);
    const same = own?.station === station && own.eyeHeight === eyeHeight && own.since === since;
    if (own && (same || (!handedOver && phase === 'running'))) return { bot: own.bot, handedOver };
    const bot = this.wish ? this.steeredFor(station) : actorFor(station, this.calibration, this.options.seed + seat);
    this.own = { station, eyeHeight, since, bot };
    return { bot, handedOver };
  }

  /** The player of a station who does what the mouse wants. */
  private steeredFor(station: number): SteeredPlayer {
    const create = station === holderStation ? createSteeredHolder : createSteeredThrower;
    return create(bodyAt(station, this.calibration), () => this.wish ?? idle);
  }

  /** What lies between two slow pictures is played too; the last moment is the picture's own. */
  private catchUp(line: BallConnection, actor: BallBot, time: number): void {
    this.gestures ??= gesturesOf(line);
    const moments = momentsUntil(time, this.actedAt);
    this.actedAt = time;
    if (moments.length === 1) return;
    const mover = { line, gestures: this.gestures, actor, estimator: this.between };
    for (let i = 0; i < moments.length - 1; i++) {
      const done = moveOnce(mover, moments[i]!, this.sight);
      this.missedCues = joined(this.missedCues, done?.cues);
      this.missedHaptics = joined(this.missedHaptics, done?.haptics);
    }
  }
}

/** Both lists; the one of them that has something in it where the other has nothing. */
function joined<T>(a: readonly T[], b: readonly T[] = none): readonly T[] {
  if (a.length === 0) return b;
  return b.length === 0 ? a : [...a, ...b];
}

export const createBallPlay = (options: BallPlayOptions): BallPlay => new MatchPlay(options);
