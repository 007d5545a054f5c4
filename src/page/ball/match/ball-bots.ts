import { type Calibration, createEstimator, type PoseEstimator } from 'threepoint/core';
import type { BallBot, BallConnection, BallGestures, BallState } from 'threepoint-games/ball';
import type { Visitor } from 'threepoint-rooms/room';
import { readyAfter } from '../../people/match/match-play';
import {
  type BotKnowledge,
  createGestures,
  createSimulatedPlayer,
  stationOf,
  stepSimulated,
  stepTimes,
} from './simulated-seat';

/** Bots of different build. Labels mark them as bots. */
const botPeople: readonly { readonly name: string; readonly calibration: Calibration }[] = [
  { name: 'Ada', calibration: { eyeHeight: 1.52, armSpan: 1.42 } },
  { name: 'Max', calibration: { eyeHeight: 1.7, armSpan: 1.62 } },
  { name: 'Kim', calibration: { eyeHeight: 1.6, armSpan: 1.51 } },
];

/** The interval between two checks for free seats [s]. */
const seatsEvery = 0.4;

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
    private readonly sight: BotKnowledge,
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
    const { connection, estimator } = bot;
    const update = connection.update(time);
    const seen = connection.room;
    if (!seen || seen.mySeat === null || !seen.match) return;
    const { match, mySeat } = seen;
    bot.gestures ??= createGestures(connection);
    if (update.changes.length > 0) bot.gestures.resume();
    bot.gestures.onEvents(update.events);
    const actor = this.actorOf(bot, stationOf(seen, mySeat), match.phase, mySeat);
    const seat = { connection, gestures: bot.gestures, player: actor, estimator };
    for (const moment of stepTimes(time, bot.movedAt)) stepSimulated(seat, moment, this.sight);
    bot.movedAt = time;
    const me = match.players[mySeat];
    if (me && !me.ready && match.phase !== 'running' && time - bot.since > readyAfter) connection.setReady(true);
  }

  /** Returns the actor of a bot; a new one for another station or another round, except during a match. */
  private actorOf(bot: Bot, station: number, phase: BallState['phase'], seat: number): BallBot {
    const fresh = phase === 'ready';
    if (!bot.actor || ((bot.station !== station || bot.fresh !== fresh) && phase !== 'running')) {
      bot.actor = createSimulatedPlayer(station, bot.calibration, this.options.seed + seat);
      bot.station = station;
      bot.fresh = fresh;
    }
    return bot.actor;
  }
}
