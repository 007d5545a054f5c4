import { fingersFromButtons } from 'threepoint/avatar/hands/button-fingers';
import type { Calibration } from 'threepoint/core/body/calibration';
import { chestSpaceBody } from 'threepoint/core/body/skeleton';
import { createEstimator } from 'threepoint/core/estimation/estimators';
import type { PoseEstimator } from 'threepoint/core/estimation/pose-estimator';
import type { Buttons } from 'threepoint/core/input/button-presses';
import { identity } from 'threepoint/core/math/quat';
import { zero } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { BallConnection, BallRoomView } from 'threepoint-games/ball/ball-client';
import type { BallInput, BallState } from 'threepoint-games/ball/ball-state';
import type { Opening } from 'threepoint-games/ball/basket';
import { type BallGestureFrame, BallGestures } from 'threepoint-games/ball/gestures';
import { createHolder } from 'threepoint-games/ball/holder-motion';
import type { PlayerBody } from 'threepoint-games/ball/player-postures';
import { holderStation, stations } from 'threepoint-games/ball/stations';
import { type BallBot, createThrower } from 'threepoint-games/ball/thrower-motion';
import type { PlayerInput } from 'threepoint-games/simulated-body';
import type { Visitor } from 'threepoint-rooms/client/connection';

/** The least rate at which a simulated player moves, even if pictures are slower: a throw takes a fifth of a second. */
const movesPerSecond = 60;
/** After a longer gap than this [s] nothing is caught up. */
const longestCatchUp = 1;

/** Returns the moments since the last one at which a simulated player moves; the last is now. */
export function momentsUntil(time: number, last: number | null): readonly number[] {
  const passed = last === null ? 0 : time - last;
  if (passed > longestCatchUp) return [time];
  const count = Math.max(1, Math.floor(passed * movesPerSecond));
  const moments: number[] = [];
  for (let i = 0; i < count; i++) moments.push(time - (passed * (count - 1 - i)) / count);
  return moments;
}

const isHandAction = (action: BallInput): action is Extract<BallInput, { type: 'grab' | 'drop' | 'throw' }> =>
  action.type === 'grab' || action.type === 'drop' || action.type === 'throw';

export const bodyAt = (station: number, calibration: Calibration): PlayerBody => ({
  eyeHeight: calibration.eyeHeight,
  armLength: chestSpaceBody(calibration).arm,
  arenaFromFloor: stations[station] ?? { position: zero, orientation: identity },
});

/** Creates the simulated player of a station. `seed`: for the scatter of its throws. */
export function actorFor(station: number, calibration: Calibration, seed: number): BallBot {
  const body = bodyAt(station, calibration);
  return station === holderStation ? createHolder(body) : createThrower(body, seed + 31 * station);
}

/** What simulated players know about the court in addition to the state of the match. */
export interface CourtSight {
  /** The total time for which the match's clock was paused [s]: simulated players stand still meanwhile. */
  pausedSeconds: number;
  opening: Opening | null;
}

/** Creates the gestures of the player on this connection. */
export function gesturesOf(of: BallConnection): BallGestures {
  return new BallGestures(() => {
    const seen = of.room;
    const seat = seen?.mySeat ?? 0;
    return {
      player: seat,
      // Asked only while there is a match: see `play`.
      state: seen?.match as BallState,
      arenaFromFloor: of.arenaFromFloor(seat),
      matchAhead: seen?.matchClockOffset ?? 0,
    };
  });
}

/** Sends the actions of a player's frame. While the clock is paused, hands do nothing. */
export function play(
  of: BallConnection,
  gestures: BallGestures,
  frame: TrackingFrame,
  buttons: Buttons,
): BallGestureFrame {
  const done = gestures.follow(of.room?.paused ? { ...frame, suspended: true } : frame, buttons);
  for (const action of done.actions) {
    if (!isHandAction(action)) continue;
    const { player: _, ...ownAction } = action;
    of.sendAction(ownAction);
  }
  return done;
}

export const stationOf = (seen: BallRoomView, seat: number): number => seen.match?.players[seat]?.station ?? seat;

/** Returns head, hands and buttons of a simulated player. Its own time stops while the match is paused. */
export function performedAt(
  actor: BallBot,
  time: number,
  state: BallState,
  player: number,
  { pausedSeconds, opening }: CourtSight,
): PlayerInput {
  const done = actor.follow(time - pausedSeconds, { state, player, ...(opening && { basket: opening.position }) });
  return pausedSeconds === 0 ? done : { ...done, frame: { ...done.frame, time } };
}

/** A simulated player on a connection, and the estimator that solves its body. */
export interface Mover {
  readonly line: BallConnection;
  readonly gestures: BallGestures;
  readonly actor: BallBot;
  readonly estimator: PoseEstimator;
}

/** Plays one moment of a simulated player: sends its actions and its solved body. */
export function moveOnce(
  { line, gestures, actor, estimator }: Mover,
  moment: number,
  sight: CourtSight,
): BallGestureFrame | null {
  const seen = line.room;
  if (!seen?.match || seen.mySeat === null) return null;
  const { frame, buttons } = performedAt(actor, moment, seen.match, seen.mySeat, sight);
  const { pose } = estimator.update(frame);
  line.sendPose(moment, { jump: false, pose, fingers: fingersFromButtons(buttons) });
  return play(line, gestures, frame, buttons);
}

/** Bots of different build. Labels mark them as bots. */
const botPeople: readonly { readonly name: string; readonly calibration: Calibration }[] = [
  { name: 'Ada', calibration: { eyeHeight: 1.52, armSpan: 1.42 } },
  { name: 'Max', calibration: { eyeHeight: 1.7, armSpan: 1.62 } },
  { name: 'Kim', calibration: { eyeHeight: 1.6, armSpan: 1.51 } },
];

/** The interval between two checks for free seats [s]. */
const seatsEvery = 0.4;
/** A simulated player is ready after this time [s]. */
export const readyAfter = 1;

interface Bot {
  readonly connection: BallConnection;
  readonly calibration: Calibration;
  readonly estimator: PoseEstimator;
  gestures: BallGestures | null;
  actor: BallBot | null;
  /** The station of its actor; `fresh`: the actor was created before the match. */
  station: number;
  fresh: boolean;
  readonly since: number;
  movedAt: number | null;
}

export interface BotsOptions {
  connect(visitor: Visitor, time: number): BallConnection;
  /** Whether bots take free seats; read in every frame. */
  bots(): boolean;
  readonly seed: number;
}

/** The bots of this page. */
export class BallBots {
  private bots: Bot[] = [];
  private lookedAt = Number.NEGATIVE_INFINITY;
  private away = false;

  constructor(
    private readonly options: BotsOptions,
    private readonly sight: CourtSight,
  ) {}

  /**
   * Seats bots in the free seats of the room of `connection`. Removes them when they are not wanted or a person takes
   * the seat.
   */
  seat(connection: BallConnection, time: number): void {
    const { options } = this;
    const wanted = options.bots() && !this.away;
    let ended = false;
    for (const bot of this.bots) {
      const gone = bot.connection.status.phase === 'ended';
      const seatless = bot.connection.room !== null && bot.connection.room.mySeat === null;
      if (!gone && (seatless || !wanted)) bot.connection.leave();
      ended ||= bot.connection.status.phase === 'ended';
    }
    if (ended) this.bots = this.bots.filter(({ connection: { status } }) => status.phase !== 'ended');
    const seen = connection.room;
    if (!seen || connection.status.phase !== 'joined' || !wanted || time - this.lookedAt < seatsEvery) return;
    this.lookedAt = time;
    const coming = this.bots.filter((bot) => bot.connection.room === null).length;
    const free = seen.seats.flatMap((row, seat) => (row === null ? [seat] : [])).slice(coming);
    for (const seat of free) this.invite(seat, time);
  }

  /** Moves all bots, at least 60 times a second. */
  move(time: number): void {
    for (const bot of this.bots) this.moveBot(bot, time);
  }

  /**
   * Leaves the seats to bots of other pages while `away`: a hidden page draws no frames, in which its bots would move.
   */
  setAway(away: boolean): void {
    this.away = away;
    if (away) this.leave();
  }

  /** Takes all bots out of their seats. */
  leave(): void {
    for (const bot of this.bots) bot.connection.leave();
    this.bots = [];
  }

  private invite(seat: number, time: number): void {
    const person = botPeople[seat % botPeople.length];
    if (!person) return;
    this.bots.push({
      connection: this.options.connect({ ...person, bot: true, seat }, time),
      calibration: person.calibration,
      estimator: createEstimator('ik', person.calibration),
      gestures: null,
      actor: null,
      station: -1,
      fresh: false,
      since: time,
      movedAt: null,
    });
  }

  private moveBot(bot: Bot, time: number): void {
    const { connection: line, estimator } = bot;
    const update = line.update(time);
    const seen = line.room;
    if (!seen || seen.mySeat === null || !seen.match) return;
    const { match, mySeat } = seen;
    bot.gestures ??= gesturesOf(line);
    if (update.changes.length > 0) bot.gestures.resume();
    bot.gestures.onEvents(update.events);
    const actor = this.actorOf(bot, stationOf(seen, mySeat), match.phase, mySeat);
    const mover = { line, gestures: bot.gestures, actor, estimator };
    for (const moment of momentsUntil(time, bot.movedAt)) moveOnce(mover, moment, this.sight);
    bot.movedAt = time;
    const me = match.players[mySeat];
    if (me && !me.ready && match.phase !== 'running' && time - bot.since > readyAfter) line.setReady(true);
  }

  /** Returns the actor of a bot; a new one for another station or another round, except during a match. */
  private actorOf(bot: Bot, station: number, phase: BallState['phase'], seat: number): BallBot {
    const fresh = phase === 'ready';
    if (!bot.actor || ((bot.station !== station || bot.fresh !== fresh) && phase !== 'running')) {
      bot.actor = actorFor(station, bot.calibration, this.options.seed + seat);
      bot.station = station;
      bot.fresh = fresh;
    }
    return bot.actor;
  }
}
