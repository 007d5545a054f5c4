import type { AvatarPose } from './core/body/avatar-pose';
import type { Calibration } from './core/body/calibration';
import { chestSpaceBody } from './core/body/skeleton';
import { createEstimator } from './core/estimation/estimators';
import type { PoseEstimator } from './core/estimation/pose-estimator';
import type { BallAction, BallEvent, BallRole, BallState } from './core/games/ball/ball-state';
import { basketInHands, type Opening } from './core/games/ball/basket';
import {
  type BallCue,
  type BallGestureFrame,
  type BallGestures,
  type BallPulse,
  createBallGestures,
} from './core/games/ball/gestures';
import { createHolder } from './core/games/ball/holder-motion';
import type { Performed, PlayerBody } from './core/games/ball/player-postures';
import { ballSecondsLeft, ballsLeft } from './core/games/ball/rules';
import { holderStation, stations } from './core/games/ball/stations';
import {
  type BallSteering,
  createSteeredHolder,
  createSteeredThrower,
  type SteeredPlayer,
} from './core/games/ball/steered-players';
import { type BallBot, createThrower } from './core/games/ball/thrower-motion';
import type { Launch } from './core/games/ballistics';
import type { Buttons } from './core/games/button-presses';
import { fistOf, type Side } from './core/games/fist';
import { composeTransforms, invertTransform, type Transform, transformPoint, transformPose } from './core/math/pose';
import { identity } from './core/math/quat';
import { length, type Vec3, zero } from './core/math/vec3';
import type { TrackedPose, TrackingFrame } from './core/tracking/tracking-frame';
import type { Connection, ConnectionStatus, RoomView, Visitor } from './net/connection';
import { createRemotePlayers, type RemotePlayer } from './net/remote-players';

/** Somebody at the court in one frame. */
export interface PlayerFrame {
  readonly name: string;
  readonly bot: boolean;
  readonly presence: 'here' | 'away' | 'gone';
  readonly me: boolean;
  readonly role: BallRole;
  readonly station: number;
  readonly ready: boolean;
  /** Arena frame; null: not to be seen now. */
  readonly head: Vec3 | null;
  readonly fists: Readonly<Record<Side, Vec3 | null>>;
  readonly opacity: number;
}

/** A body to be drawn; its floor as it lies in this room. */
export interface BodyFrame {
  readonly id: number;
  readonly calibration: Calibration;
  readonly station: number;
  readonly pose: AvatarPose;
  readonly placement: Transform<'floor', 'floor'>;
  readonly grips: Readonly<Record<Side, number>>;
  readonly opacity: number;
}

/** What one frame of the match brought: to be seen, heard and felt. */
export interface BallFrame {
  readonly state: BallState;
  /** Seconds of the match. */
  readonly time: number;
  readonly me: number | null;
  readonly role: BallRole | null;
  readonly rotate: boolean;
  readonly spectators: number;
  /** The match's clock stands because somebody stopped it. */
  readonly paused: boolean;
  readonly players: readonly (PlayerFrame | null)[];
  readonly bodies: readonly BodyFrame[];
  readonly opening: Opening | null;
  readonly events: readonly BallEvent[];
  readonly cues: readonly BallCue[];
  readonly haptics: readonly BallPulse[];
  readonly held: Readonly<Record<Side, number | null>>;
  /** How the ball in the own hand would fly, arena frame; null: nobody aims it with a mouse. */
  readonly aim: Launch | null;
}

/** What tools may know of a match. */
export interface BallProbe {
  readonly name: 'ball';
  readonly phase: BallState['phase'];
  readonly end: BallState['end'];
  readonly score: number;
  readonly ballsLeft: number;
  readonly secondsLeft: number;
  /** Own seat; null: a spectator. */
  readonly seat: number | null;
  readonly role: BallRole | null;
  readonly ready: boolean;
  readonly rotate: boolean;
  readonly spectators: number;
  readonly paused: boolean;
  readonly held: Readonly<Record<Side, number | null>>;
  /** How fast the ball would leave the hand that a mouse aims [m/s]; null: it aims none. */
  readonly aim: number | null;
  readonly connection: ConnectionStatus['phase'];
  /** Rounds cut short because the room had forgotten them. */
  readonly voided: number;
  /** How many balls are in each kind of place. */
  readonly balls: Readonly<Record<'rack' | 'hand' | 'air' | 'floor' | 'basket', number>>;
  /** The middle of the opening, arena frame [m]. */
  readonly basket: readonly [number, number, number];
  readonly people: readonly ({ readonly name: string; readonly bot: boolean; readonly presence: string } | null)[];
}

/** A match and who plays it, apart from everything that is seen of it. */
export interface BallPlay {
  readonly status: ConnectionStatus;
  readonly room: RoomView | null;
  /** Where the arena lies in this room: by the own seat; a spectator stands in the arena's own frame. */
  readonly floorFromArena: Transform<'floor', 'arena'>;
  readonly newest: BallFrame | null;
  /** Once a frame, before anything else of it: hears the room and moves the bots. */
  begin(time: number): void;
  /**
   * Head, hands and buttons of a built-in player on the own seat at `time` [s]; null: there is no seat yet. catchUp: what it does
   * between two slow frames is played as well, as no device could.
   */
  act(time: number, catchUp?: boolean): Performed | null;
  /** The tracked frame and its buttons become play; null frame: nobody is seen, or a spectator. */
  follow(time: number, frame: TrackingFrame | null, buttons: Buttons): BallFrame | null;
  /** The solved body of this frame, for the others. */
  send(frame: TrackingFrame, pose: AvatarPose, grips: Readonly<Record<Side, number>>): void;
  /** The space was re-anchored: others see a jump and no streak. */
  jumped(): void;
  ready(on: boolean): void;
  rotate(on: boolean): void;
  sit(seat: number | null): void;
  /** Stops the match's clock, or no longer wants it stopped; refused where the room's terms do not allow it. */
  pause(on: boolean): void;
  away(on: boolean): void;
  calibrate(calibration: Calibration): void;
  probe(): BallProbe | null;
  leave(): void;
}

export interface BallPlayOptions {
  connect(visitor: Visitor, time: number): Connection;
  readonly visitor: Visitor;
  /** Whether bots take the seats that are free; asked for in every frame. */
  bots(): boolean;
  /** Whether the own seat's hands are a built-in player's: who is then ready by itself. */
  acting(): boolean;
  /** What a mouse wants of the own seat's player, own floor frame; null or absent: nothing, a built-in one plays. */
  steering?(): BallSteering | null;
  readonly seed: number;
}

interface Bot {
  readonly connection: Connection;
  readonly calibration: Calibration;
  readonly estimator: PoseEstimator;
  gestures: BallGestures | null;
  actor: { readonly key: string; readonly bot: BallBot } | null;
  readonly since: number;
  movedAt: number | null;
}

/** Bots of different build; they say that they are bots. */
const botPeople: readonly { readonly name: string; readonly calibration: Calibration }[] = [
  { name: 'Ada', calibration: { eyeHeight: 1.52, armSpan: 1.42 } },
  { name: 'Max', calibration: { eyeHeight: 1.7, armSpan: 1.62 } },
  { name: 'Kim', calibration: { eyeHeight: 1.6, armSpan: 1.51 } },
];

const idle: BallSteering = {
  ray: { origin: zero, direction: { x: 0, y: 0, z: -1 } },
  pressed: false,
  cancelled: false,
};
const nowhere: Transform<'floor', 'arena'> = { position: zero, orientation: identity };
/** Seconds between two looks for free seats. */
const seatsEvery = 0.4;
/** A built-in player is ready after this long [s], and after a result that somebody may want to read. */
const readyAfter = 1;
const rematchAfter = 7;

/** A built-in player moves at least this often, however slowly pictures come: a throw is over in a fifth of a second. */
const movesPerSecond = 60;
/** After a longer pause than this [s] nothing is made up for. */
const longestCatchUp = 1;

/** The moments since the last one at which a built-in player moves; the last is now. */
function momentsUntil(time: number, last: number | null): readonly number[] {
  const passed = last === null ? 0 : time - last;
  if (passed > longestCatchUp) return [time];
  const count = Math.max(1, Math.floor(passed * movesPerSecond));
  return Array.from({ length: count }, (_, i) => time - (passed * (count - 1 - i)) / count);
}

const isDeed = (action: BallAction): action is Extract<BallAction, { type: 'grab' | 'drop' | 'throw' }> =>
  action.type === 'grab' || action.type === 'drop' || action.type === 'throw';

const bodyAt = (station: number, calibration: Calibration): PlayerBody => ({
  eyeHeight: calibration.eyeHeight,
  armLength: chestSpaceBody(calibration).arm,
  arenaFromFloor: stations[station] ?? { position: zero, orientation: identity },
});

/** The built-in player of a station; `seed`: of the scatter of its throws. */
function actorFor(station: number, calibration: Calibration, seed: number): BallBot {
  const body = bodyAt(station, calibration);
  return station === holderStation ? createHolder(body) : createThrower(body, seed + 31 * station);
}

const gripsOf = (buttons: Buttons): Record<Side, number> => {
  const closed = ({ trigger, grip, pinch }: Buttons[Side]) => Math.max(trigger, grip, pinch);
  return { left: closed(buttons.left), right: closed(buttons.right) };
};

export function createBallPlay(options: BallPlayOptions): BallPlay {
  let calibration = options.visitor.calibration;
  let connection: Connection | null = null;
  const remote = createRemotePlayers();
  let bots: Bot[] = [];
  let lookedAt = Number.NEGATIVE_INFINITY;
  let events: BallEvent[] = [];
  let others: readonly RemotePlayer[] = [];
  let opening: Opening | null = null;
  let newest: BallFrame | null = null;
  let gestures: BallGestures | null = null;
  let own: { readonly key: string; readonly bot: BallBot | SteeredPlayer } | null = null;
  let wish: BallSteering | null = null;
  let jump = false;
  /** For the moments of the own built-in player that no picture shows. */
  const between = createEstimator('ik', calibration);
  let actedAt: number | null = null;
  let missed: { readonly cues: readonly BallCue[]; readonly haptics: readonly BallPulse[] } = { cues: [], haptics: [] };
  /** Since when the match has been waiting for somebody to be ready [s]. */
  let waitingSince: { readonly phase: string; readonly at: number } | null = null;
  let seating = '';
  /** For how long the match's clock has stood in all [s]: built-in players stand still meanwhile. */
  let stood = 0;
  let begunAt: number | null = null;

  const room = () => connection?.room ?? null;

  function floorFromArena(): Transform<'floor', 'arena'> {
    const seat = room()?.mySeat ?? null;
    return connection && seat !== null ? invertTransform(connection.arenaFromFloor(seat)) : nowhere;
  }

  function gesturesOf(of: Connection): BallGestures {
    return createBallGestures(() => {
      const seen = of.room;
      const seat = seen?.mySeat ?? 0;
      return {
        player: seat,
        // Asked only while there is a match: see `play`.
        state: seen?.match as BallState,
        arenaFromFloor: of.arenaFromFloor(seat),
        matchAhead: seen?.matchAhead ?? 0,
      };
    });
  }

  /** One player's frame as deeds, sent. While the clock stands hands mean nothing. */
  function play(of: Connection, with_: BallGestures, frame: TrackingFrame, buttons: Buttons): BallGestureFrame {
    const done = with_.follow(of.room?.paused ? { ...frame, suspended: true } : frame, buttons);
    for (const action of done.actions) {
      if (!isDeed(action)) continue;
      const { player: _, ...deed } = action;
      of.act(deed);
    }
    return done;
  }

  function stationOf(seen: RoomView, seat: number): number {
    return seen.match?.players[seat]?.station ?? seat;
  }

  /** Head, hands and buttons of a built-in player, whose own time stands when the match's does. */
  function performedAt(actor: BallBot, time: number, state: BallState, player: number): Performed {
    const done = actor.follow(time - stood, { state, player, ...(opening && { basket: opening.position }) });
    return { ...done, frame: { ...done.frame, time } };
  }

  /** The player of a station who does what the mouse wants. */
  function steeredFor(station: number): SteeredPlayer {
    const create = station === holderStation ? createSteeredHolder : createSteeredThrower;
    return create(bodyAt(station, calibration), () => wish ?? idle);
  }

  /** One moment of a built-in player: deeds, and the solved body to the others. */
  function moveOnce(
    line: Connection,
    with_: BallGestures,
    actor: BallBot,
    estimator: PoseEstimator,
    moment: number,
  ): BallGestureFrame | null {
    const seen = line.room;
    if (!seen?.match || seen.mySeat === null) return null;
    const { frame, buttons } = performedAt(actor, moment, seen.match, seen.mySeat);
    void estimator.prepare(frame);
    const pose = estimator.estimate(frame);
    line.sendPose(moment, { jump: false, pose, grips: gripsOf(buttons), curls: { left: null, right: null } });
    return play(line, with_, frame, buttons);
  }

  function moveBot(bot: Bot, time: number): void {
    const { connection: line, estimator } = bot;
    const update = line.update(time);
    const seen = line.room;
    if (!seen || seen.mySeat === null || !seen.match) return;
    const seat = seen.mySeat;
    if (update.news.some((what) => what !== 'seats')) bot.gestures = null;
    bot.gestures ??= gesturesOf(line);
    bot.gestures.hear(update.events);
    const station = stationOf(seen, seat);
    const key = `${station} ${seen.match.phase === 'ready'}`;
    if (bot.actor?.key !== key && (bot.actor === null || seen.match.phase !== 'running')) {
      bot.actor = { key, bot: actorFor(station, bot.calibration, options.seed + seat) };
    }
    for (const moment of momentsUntil(time, bot.movedAt)) {
      moveOnce(line, bot.gestures, (bot.actor as NonNullable<Bot['actor']>).bot, estimator, moment);
    }
    bot.movedAt = time;
    const me = seen.match.players[seat];
    if (me && !me.ready && seen.match.phase !== 'running' && time - bot.since > readyAfter) line.ready(true);
  }

  /** Bots come for seats that are free, and go when they are not wanted or a person has come. */
  function seatBots(time: number): void {
    for (const bot of bots) {
      const gone = bot.connection.status.phase === 'ended';
      const seatless = bot.connection.room !== null && bot.connection.room.mySeat === null;
      if (!gone && (seatless || !options.bots())) bot.connection.leave();
    }
    bots = bots.filter(({ connection: { status } }) => status.phase !== 'ended');
    const seen = room();
    if (!seen || connection?.status.phase !== 'joined' || !options.bots() || time - lookedAt < seatsEvery) return;
    lookedAt = time;
    const coming = bots.filter((bot) => bot.connection.room === null).length;
    const free = seen.seats.flatMap((row, seat) => (row === null ? [seat] : [])).slice(coming);
    for (const seat of free) {
      const person = botPeople[seat % botPeople.length];
      if (!person) continue;
      bots.push({
        connection: options.connect({ ...person, bot: true, seat }, time),
        calibration: person.calibration,
        estimator: createEstimator('ik', person.calibration),
        gestures: null,
        actor: null,
        since: time,
        movedAt: null,
      });
    }
  }

  /** Somebody who needs nobody is ready by themselves. */
  function readyByItself(time: number): void {
    const seen = room();
    const match = seen?.match;
    if (!match || seen.mySeat === null || match.phase === 'running') {
      waitingSince = null;
      return;
    }
    if (waitingSince?.phase !== match.phase) waitingSince = { phase: match.phase, at: time };
    // A mouse has a person behind it, who says when.
    if (!options.acting() || options.steering?.() || match.players[seen.mySeat]?.ready) return;
    const patience = match.phase === 'over' ? rematchAfter : readyAfter;
    if (time - waitingSince.at > patience && match.players.filter(({ present }) => present).length > 1) {
      connection?.ready(true);
    }
  }

  function begin(time: number): void {
    connection ??= options.connect(options.visitor, time);
    if (room()?.paused && begunAt !== null) stood += time - begunAt;
    begunAt = time;
    const update = connection.update(time);
    for (const pose of update.poses) remote.receive(pose);
    events = [...events, ...update.events];
    if (update.news.some((what) => what !== 'seats')) gestures = null;
    gestures?.hear(update.events);
    const seen = connection.room;
    if (seen) {
      const now = seen.seats.map((row) => row && [row.name, row.bot]);
      // Whoever takes a seat does not glide there from where the one before them was.
      if (JSON.stringify(now) !== seating) {
        const before = seating === '' ? [] : (JSON.parse(seating) as unknown[]);
        now.forEach((row, seat) => {
          if (JSON.stringify(row) !== JSON.stringify(before[seat] ?? null)) remote.forget(seat);
        });
        seating = JSON.stringify(now);
      }
    }
    seatBots(time);
    for (const bot of bots) moveBot(bot, time);
    readyByItself(time);
    others = remote.follow(time);
  }

  const inArena = (arenaFromFloor: Transform<'arena', 'floor'>, hand: TrackedPose | null) =>
    hand && transformPose(arenaFromFloor, hand);

  function follow(time: number, frame: TrackingFrame | null, buttons: Buttons): BallFrame | null {
    const seen = room();
    const state = seen?.match;
    if (!connection || !seen || !state) {
      newest = null;
      return null;
    }
    const me = seen.mySeat;
    let played: BallGestureFrame | null = null;
    if (frame && me !== null) {
      gestures ??= gesturesOf(connection);
      played = play(connection, gestures, frame, buttons);
    }
    const shown = connection.room?.match ?? state;
    const toFloor = floorFromArena();
    const line = connection;
    const players = seen.seats.map((row, seat): PlayerFrame | null => {
      const player = shown.players[seat];
      if (!row || !player) return null;
      const there = seat === me ? null : others.find((other) => other.seat === seat);
      const pose = seat === me ? frame : there?.pose;
      const arenaFromFloor = line.arenaFromFloor(seat);
      const fist = (hand: TrackedPose | null | undefined) =>
        hand ? transformPoint(arenaFromFloor, fistOf(hand)) : null;
      return {
        name: row.name,
        bot: row.bot,
        presence: row.presence,
        me: seat === me,
        role: player.role,
        station: player.station,
        ready: player.ready,
        head: pose ? transformPoint(arenaFromFloor, pose.head.position) : null,
        fists: { left: fist(pose?.leftHand), right: fist(pose?.rightHand) },
        opacity: seat === me ? 1 : (there?.opacity ?? 0),
      };
    });
    const holder = shown.players.findIndex(({ role }) => role === 'holder');
    const holding = holder === me ? frame : others.find(({ seat }) => seat === holder)?.pose;
    opening = null;
    if (holding) {
      const arenaFromFloor = connection.arenaFromFloor(holder);
      opening = basketInHands(inArena(arenaFromFloor, holding.leftHand), inArena(arenaFromFloor, holding.rightHand));
    }
    const bodies = others.flatMap(({ seat, pose, grips, opacity }): BodyFrame[] => {
      const row = seen.seats[seat];
      if (!row || seat === me) return [];
      const station = shown.players[seat]?.station ?? seat;
      const placement = composeTransforms(toFloor, line.arenaFromFloor(seat));
      return [{ id: seat, calibration: row.calibration, station, pose, placement, grips, opacity }];
    });
    newest = {
      state: shown,
      time: time + seen.matchAhead,
      me,
      role: me === null ? null : (shown.players[me]?.role ?? null),
      rotate: seen.rotate,
      spectators: seen.spectators,
      paused: seen.paused,
      players,
      bodies,
      opening,
      events,
      cues: [...missed.cues, ...(played?.cues ?? [])],
      haptics: [...missed.haptics, ...(played?.haptics ?? [])],
      held: played?.held ?? { left: null, right: null },
      aim: wish && own && 'aim' in own.bot ? own.bot.aim : null,
    };
    events = [];
    missed = { cues: [], haptics: [] };
    return newest;
  }

  return {
    get status() {
      return connection?.status ?? { phase: 'connecting', attempt: 0, retryIn: null, reason: null };
    },
    get room() {
      return room();
    },
    get floorFromArena() {
      return floorFromArena();
    },
    get newest() {
      return newest;
    },
    begin,
    act(time, catchUp = true) {
      const seen = room();
      if (!seen?.match || seen.mySeat === null) return null;
      const station = stationOf(seen, seen.mySeat);
      wish = options.steering?.() ?? null;
      const steered = wish !== null;
      const key = `${station} ${calibration.eyeHeight} ${steered || seen.match.phase === 'ready'}`;
      const handedOver = own !== null && 'aim' in own.bot !== steered;
      if (own?.key !== key && (own === null || handedOver || seen.match.phase !== 'running')) {
        own = { key, bot: steered ? steeredFor(station) : actorFor(station, calibration, options.seed + seen.mySeat) };
      }
      const { bot } = own as NonNullable<typeof own>;
      // What lies between two slow pictures is played too; the last moment is the picture's own.
      if (catchUp && connection) {
        gestures ??= gesturesOf(connection);
        for (const moment of momentsUntil(time, actedAt).slice(0, -1)) {
          const done = moveOnce(connection, gestures, bot, between, moment);
          if (done) missed = { cues: [...missed.cues, ...done.cues], haptics: [...missed.haptics, ...done.haptics] };
        }
        actedAt = time;
      }
      return performedAt(bot, time, connection?.room?.match ?? seen.match, seen.mySeat);
    },
    follow,
    send(frame, pose, grips) {
      if (room()?.mySeat === null) return;
      connection?.sendPose(frame.time, { jump, pose, grips, curls: { left: null, right: null } });
      jump = false;
    },
    jumped() {
      jump = true;
    },
    ready: (on) => connection?.ready(on),
    rotate: (on) => connection?.rotate(on),
    sit: (seat) => connection?.sit(seat),
    pause: (on) => connection?.pause(on),
    away: (on) => connection?.away(on),
    calibrate(next) {
      calibration = next;
      between.calibrate(next);
      own = null;
      connection?.calibrate(next);
    },
    probe() {
      if (!newest || !connection) return null;
      const { state, me, role, rotate, spectators, paused, held, aim, players } = newest;
      const count = (on: string) => state.balls.filter((place) => place.on === on).length;
      const { x, y, z } = newest.opening?.position ?? state.basket.position;
      return {
        name: 'ball',
        phase: state.phase,
        end: state.end,
        score: state.score,
        ballsLeft: ballsLeft(state),
        secondsLeft: ballSecondsLeft(state),
        seat: me,
        role,
        ready: me !== null && (state.players[me]?.ready ?? false),
        rotate,
        spectators,
        paused,
        held,
        aim: aim && length(aim.velocity),
        connection: connection.status.phase,
        voided: connection.room?.voided ?? 0,
        balls: {
          rack: count('rack'),
          hand: count('hand'),
          air: count('air'),
          floor: count('floor'),
          basket: count('basket'),
        },
        basket: [x, y, z],
        people: players.map((player) => player && { name: player.name, bot: player.bot, presence: player.presence }),
      };
    },
    leave() {
      for (const bot of bots) bot.connection.leave();
      bots = [];
      connection?.leave();
    },
  };
}
