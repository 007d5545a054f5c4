import type { AvatarPose, AvatarRef, Buttons, Calibration, Fingers, TrackingFrame } from 'threepoint/core';
import type { Side, Transform } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import {
  type BallConnection,
  type BallEvent,
  type BallGame,
  type BallGestureFrame,
  type BallGestures,
  type BallRoomView,
  type BallSteering,
  displayedSeconds,
} from 'threepoint-games/ball';
import { RoomClient } from 'threepoint-rooms';
import type { ConnectionStatus, Visitor, VoiceChannel } from 'threepoint-rooms/room';
import { CourtPeople } from '../../people/match/seated-people';
import { BallBots, readyAfter } from './ball-bots';
import type { BallFrame } from './ball-frame';
import type { BallProbe } from './ball-probe';
import { probeOf } from './ball-probe';
import { joined, SimulatedPlayer } from './simulated-player';
import type { BotKnowledge } from './simulated-seat';
import { createGestures, playFrame } from './simulated-seat';

export interface BallPlayOptions {
  connect(visitor: Visitor, time: number): BallConnection;
  readonly visitor: Visitor;
  /** Whether bots take free seats; read in every frame. */
  bots(): boolean;
  /** Whether a simulated player moves the user's body. It is ready without being asked. */
  acting(): boolean;
  /** The mouse's target, floor frame of the user; null or absent: a simulated player plays. */
  steering?(): BallSteering | null;
  readonly seed: number;
}

const emptyHands: Readonly<Record<Side, number | null>> = { left: null, right: null };
/** The time for which a person can read a result before a simulated player asks for another round [s]. */
const rematchAfter = 7;

/** The empty list, shared. */
const none: readonly never[] = [];

/** A match and its players, without the view. */
export class BallPlay {
  newest: BallFrame | null = null;
  private readonly client: RoomClient<BallGame>;
  private readonly sight: BotKnowledge = { pausedSeconds: 0, opening: null };
  private readonly bots: BallBots;
  private readonly simulated: SimulatedPlayer;
  private readonly people = new CourtPeople();
  private events: readonly BallEvent[] = none;
  private gestures: BallGestures | null = null;
  private resumed = false;
  private secondsLeft = 0;
  /** Since when the match has been waiting in this phase for a player to be ready [s]. */
  private waitingSince: { readonly phase: string; readonly at: number } | null = null;
  private begunAt: number | null = null;
  /** Whether roles are to move on, until the request is sent; null: none waits. */
  private rotateRequest: boolean | null = null;

  constructor(private readonly options: BallPlayOptions) {
    this.client = new RoomClient((time) => options.connect(options.visitor, time));
    this.simulated = new SimulatedPlayer(options, options.visitor.calibration, this.sight);
    this.bots = new BallBots(options, this.sight);
  }

  get status(): ConnectionStatus {
    return this.client.status;
  }

  get room(): BallRoomView | null {
    return this.client.room;
  }

  /** The channel for setting up voice connections; null: not connected yet. */
  get voices(): VoiceChannel | null {
    return this.connection?.voices ?? null;
  }

  private get connection(): BallConnection | null {
    return this.client.connection;
  }

  /**
   * The arena in the user's floor frame, by the user's seat. A spectator's floor frame is the arena frame. Every change
   * yields another object.
   */
  get floorFromArena(): Transform<'floor', 'arena'> {
    return this.client.floorFromArena;
  }

  /** Receives messages from the room and moves the bots. Call it first in every frame. */
  begin(time: number): void {
    if (this.room?.paused && this.begunAt !== null) this.sight.pausedSeconds += time - this.begunAt;
    this.begunAt = time;
    const update = this.client.update(time);
    if (update.changes.includes('resumed')) this.resumed = true;
    if (update.events.length > 0) this.events = [...this.events, ...update.events];
    if (update.changes.length > 0) this.gestures?.resume();
    this.gestures?.onEvents(update.events);
    if (this.connection) {
      this.bots.seat(this.connection, time);
      this.sendRotateRequest(this.connection);
    }
    this.bots.move(time);
    this.readyByItself(time);
  }

  /**
   * Returns the input of the simulated player on the user's seat at a time [s], or null without a seat. `catchUp`: also
   * plays the moments between two slow frames, which no device could.
   */
  act(time: number, catchUp = true): SimulatedInput | null {
    if (!this.connection) return null;
    this.gestures ??= createGestures(this.connection);
    return this.simulated.act(this.connection, this.gestures, time, catchUp);
  }

  /** Advances the match by a tracked frame and its buttons. `frame`: null if nothing is tracked, or for a spectator. */
  follow(time: number, frame: TrackingFrame | null, buttons: Buttons): BallFrame | null {
    const connection = this.connection;
    const before = connection?.room;
    if (!connection || !before?.match) {
      this.newest = null;
      return null;
    }
    const me = before.mySeat;
    let played: BallGestureFrame | null = null;
    if (frame && me !== null) {
      this.gestures ??= createGestures(connection);
      played = playFrame(connection, this.gestures, frame, buttons);
    }
    const seen = connection.room ?? before;
    const state = seen.match ?? before.match;
    this.people.update(connection, seen, frame, this.client.people);
    const { players, bodies, opening } = this.people;
    this.sight.opening = opening;
    this.secondsLeft = displayedSeconds(state, this.secondsLeft);
    const missed = this.simulated.takeMissed();
    this.newest = {
      state,
      epoch: before.epoch,
      connection: connection.status.phase,
      time: time + before.matchClockOffset,
      secondsLeft: this.secondsLeft,
      me,
      role: me === null ? null : (state.players[me]?.role ?? null),
      spectators: before.spectators,
      paused: before.paused,
      players,
      bodies,
      opening,
      events: this.events,
      resumed: this.resumed,
      cues: joined(missed.cues, played?.cues),
      haptics: joined(missed.haptics, played?.haptics),
      held: played?.held ?? emptyHands,
      aim: this.simulated.aim,
    };
    this.events = none;
    this.resumed = false;
    return this.newest;
  }

  /** Sends the solved body of this frame to the others. */
  send(frame: TrackingFrame, pose: AvatarPose, fingers: Fingers): void {
    this.client.sendPose(frame.time, pose, fingers);
  }

  /**
   * The user's floor frame changes with the next frame: others see a jump without interpolation, and hands throw
   * nothing.
   */
  discontinuity(): void {
    this.client.discontinuity();
    this.gestures?.discontinuity();
  }

  ready(on: boolean): void {
    this.connection?.setReady(on);
  }

  rotate(on: boolean): void {
    this.rotateRequest = on;
  }

  sit(seat: number | null): void {
    this.connection?.changeSeat(seat);
  }

  /** Pauses the match's clock, or withdraws the pause. Refused if the room's terms do not allow it. */
  pause(on: boolean): void {
    this.connection?.setPaused(on);
  }

  away(on: boolean): void {
    this.connection?.setAway(on);
    this.bots.setAway(on && this.othersPlay);
  }

  calibrate(next: Calibration): void {
    this.simulated.calibrate(next);
    this.connection?.calibrate(next);
  }

  /** Shows the others this player with another avatar. */
  wear(avatar: AvatarRef): void {
    this.connection?.setAvatar(avatar);
  }

  probe(): BallProbe | null {
    return this.newest && this.connection && probeOf(this.newest, this.connection);
  }

  leave(): void {
    this.bots.leave();
    this.connection?.leave();
  }

  /** Whether another person is connected and has a seat. */
  private get othersPlay(): boolean {
    const { seats = none, mySeat = null } = this.room ?? {};
    return seats.some((row, seat) => seat !== mySeat && row !== null && !row.bot && row.presence !== 'gone');
  }

  /** Sends the request once the room takes actions: it is connected and not paused. */
  private sendRotateRequest(connection: BallConnection): void {
    if (this.rotateRequest === null || connection.status.phase !== 'joined' || connection.room?.paused) return;
    this.gestures ??= createGestures(connection);
    const sequence = this.gestures.nextSequence();
    connection.sendAction({ type: 'rotate', sequence, rotate: this.rotateRequest });
    this.rotateRequest = null;
  }

  /** Reports a simulated player as ready. */
  private readyByItself(time: number): void {
    const { options } = this;
    const seen = this.room;
    const match = seen?.match;
    if (!match || seen.mySeat === null || match.phase === 'running') {
      this.waitingSince = null;
      return;
    }
    if (this.waitingSince?.phase !== match.phase) this.waitingSince = { phase: match.phase, at: time };
    if (!options.acting() || match.players[seen.mySeat]?.ready) return;
    const patience = match.phase === 'over' ? rematchAfter : readyAfter;
    if (time - this.waitingSince.at > patience && match.players.filter(({ present }) => present).length > 1) {
      this.connection?.setReady(true);
    }
  }
}
