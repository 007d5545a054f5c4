import type { BallAction, BallEvent, BallOptions, BallState, Refusal } from '../games/ball/ball-state';
import { ballRules } from '../games/ball/rules';
import { createMatch, type Match } from '../games/match';
import { transformPoint, transformPose } from '../math/pose';
import { distance, type Vec3 } from '../math/vec3';
import { packBall } from '../protocol/ball-snapshot';
import {
  type ClientMessage,
  type Farewell,
  type Joining,
  packRow,
  protocolVersion,
  type RoomKind,
  type RoomMessage,
  type SeatRow,
} from '../protocol/messages';
import { decodePoints } from '../protocol/pose-codec';
import { encodeFrame, type SeatPose } from '../protocol/pose-frame';
import { arenaFromFloorOf } from './seat-places';

/** One connection; a person who comes back has another one. */
export type ClientId = string;

export interface RoomOptions {
  readonly id: string;
  /** Another one whenever a room of this id is made anew. */
  readonly epoch: string;
  readonly kind: RoomKind;
  /** Of an open room; the ball game has three. */
  readonly seats?: number;
  readonly seed?: number;
  readonly ball?: Partial<BallOptions>;
  /** Players on a seat may stop the match's clock: in a study, where all pages do as the experimenter says. Default: none may. */
  readonly pausable?: boolean;
  /** Every seat is one person's own: each who joins names theirs, and no one moves to another. */
  readonly assigned?: boolean;
}

/** Something that the Room would not do. */
export interface RoomRefusal {
  readonly client: ClientId;
  readonly seat: number | null;
  readonly what: 'pose' | 'deed' | 'sit' | 'message';
  readonly reason:
    | Refusal
    | 'too-fast'
    | 'occupied'
    | 'no-seat'
    | 'not-joined'
    | 'joined-already'
    | 'not-pausable'
    | 'assigned';
}

/** How a Room speaks. Called from within its methods, never at another time. */
export interface RoomOutlet {
  /** Reliable and in order. */
  send(to: ClientId, message: RoomMessage): void;
  /** The same to everybody who has joined. */
  broadcast(message: RoomMessage): void;
  /** To everybody who has joined; worth nothing once there is a newer one. */
  frame(bytes: Uint8Array): void;
  /** The Room has forgotten this client. */
  drop(client: ClientId, reason: Farewell): void;
  refused(refusal: RoomRefusal): void;
  /** The actions of every tick before it is stepped: enough to play a match again from its start. */
  stepped?(actions: readonly BallAction[]): void;
}

/** Seats are held this long after a connection is lost [s]. */
export const seatHoldSeconds = 30;
/** Who has been silent or without connection this long [s] counts as away, and lets go of what they hold when the connection is lost. */
export const awayAfter = 2.5;
/** Where somebody was is forgotten this long after it was told [s]: movements identify people. With a tick to spare of 2 s. */
export const poseMemory = 1.9;
/** No head moves faster [m/s] without telling that its space was re-anchored. */
export const fastestHead = 20;
/** What was refused for its speed is believed after this [s]: a device that lost its place has found it again. */
const disbeliefSeconds = 1;

interface Seat {
  identity: string;
  client: ClientId | null;
  name: string;
  calibration: { readonly eyeHeight: number; readonly armSpan: number };
  bot: boolean;
  /** Room time [s] of losing the connection. */
  lostAt: number | null;
  /** The rules count them as playing. */
  playing: boolean;
  declaredAway: boolean;
  presence: SeatRow['presence'];
  /** Room time [s] of the newest pose believed, or of sitting down. */
  heardAt: number;
  /** Room time [s] that the newest packet gives itself. */
  packetTime: number | null;
  /** Room time [s] of the newest pose that is remembered, here or in the match; null: none is. */
  posedAt: number | null;
  head: Vec3 | null;
  fresh: Uint8Array | null;
  /** Wants the match's clock to stand. */
  holds: boolean;
}

interface Client {
  readonly identity: string;
  readonly name: string;
  readonly bot: boolean;
  calibration: Seat['calibration'];
  seat: number | null;
}

/** Who is in a Room. */
export interface RoomCensus {
  readonly players: number;
  readonly bots: number;
  readonly spectators: number;
  /** Seats that a person may take: empty, or a bot's. */
  readonly free: number;
  /** Nobody is connected and no seat is held. */
  readonly empty: boolean;
}

/**
 * The authority over one room and its match: seats, ready-up, rules, newest poses. It knows no socket and no clock: times are the room
 * clock's [s], they never go back, and whoever hosts it says when to tick.
 */
export interface Room {
  readonly options: RoomOptions;
  readonly census: RoomCensus;
  /** The match as the rules have it; null in an open room. */
  readonly match: BallState | null;
  /** The match's clock stands because somebody on a seat wants it to. */
  readonly paused: boolean;
  /** A new connection of somebody whose identity the host has made sure of. Replaces an older one of theirs and takes their held seat. */
  join(client: ClientId, identity: string, joining: Joining, time: number): void;
  /** The connection is lost; the seat is held for 30 s. */
  disconnect(client: ClientId, time: number): void;
  receive(client: ClientId, message: Exclude<ClientMessage, { type: 'join' }>, time: number): void;
  /** bad: not a pose packet. ignored: a good one that changes nothing, because it is old, unbelievable or nobody's. */
  receivePose(client: ClientId, bytes: Uint8Array, time: number): 'taken' | 'ignored' | 'bad';
  /** Steps the match as far as `time`, says what happened, and sends the newest poses. */
  tick(time: number): void;
}

/** The time nearest to `now` [s] that ends in these milliseconds, modulo 65 536. */
export function unwrapTime(timeMs: number, now: number): number {
  const nowMs = now * 1000;
  const off = (((timeMs - nowMs + 32768) % 65536) + 65536) % 65536;
  return now + (off - 32768) / 1000;
}

export function createRoom(options: RoomOptions, outlet: RoomOutlet): Room {
  const count = options.kind === 'ball' ? 3 : (options.seats ?? 16);
  const seats: (Seat | null)[] = Array.from({ length: count }, () => null);
  const clients = new Map<ClientId, Client>();
  let match: Match<BallState, BallAction, BallEvent> | null = null;
  /** Room time at which the match's clock was at 0; it moves on with every second that the clock stands. */
  let zero = 0;
  /** For how long the match's clock has stood in all [s]. */
  let stood = 0;
  /** Room time at which the match's clock was stopped; null: it runs. */
  let stoppedAt: number | null = null;
  let round = 0;
  let rotate = false;
  let actions: BallAction[] = [];

  function startMatch(time: number): void {
    const rotation = (options.ball?.rotation ?? 0) + round;
    const players = seats.map((_, seat) => `seat ${seat}`);
    match = createMatch(ballRules, ballRules.start(players, options.seed ?? 0, { ...options.ball, rotation }), {
      onTick: (due) => outlet.stepped?.(due),
    });
    actions = [];
    zero = time;
  }

  const rowOf = (seat: Seat | null): SeatRow | null =>
    seat && { name: seat.name, calibration: seat.calibration, bot: seat.bot, presence: seat.presence };

  const tellSeat = (index: number): void =>
    outlet.broadcast({ type: 'seat', seat: index, row: packRow(rowOf(seats[index] ?? null)) });

  const spectators = (): number => [...clients.values()].filter(({ seat }) => seat === null).length;
  const tellAbout = (): void => outlet.broadcast({ type: 'about', spectators: spectators(), rotate });

  function welcome(to: ClientId, time: number): void {
    outlet.send(to, {
      type: 'welcome',
      version: protocolVersion,
      room: options.id,
      epoch: options.epoch,
      kind: options.kind,
      seat: clients.get(to)?.seat ?? null,
      seats: seats.map((seat) => packRow(rowOf(seat))),
      spectators: spectators(),
      rotate,
      zero: match && zero,
      match: match && packBall(match.state),
      paused: stoppedAt === null ? null : stoppedAt - zero,
      time,
    });
  }

  const act = (action: BallAction): void => {
    if (match) actions.push(action);
  };

  function enter(index: number, client: ClientId, time: number): void {
    const { identity, name, calibration, bot } = clients.get(client)!;
    seats[index] = {
      identity,
      client,
      name: name || `Player ${index + 1}`,
      calibration,
      bot,
      lostAt: null,
      playing: true,
      declaredAway: false,
      presence: 'here',
      heardAt: time,
      packetTime: null,
      posedAt: null,
      head: null,
      fresh: null,
      holds: false,
    };
    clients.get(client)!.seat = index;
    act({ type: 'join', player: index });
  }

  function vacate(index: number): void {
    const seat = seats[index];
    if (!seat) return;
    if (seat.playing) act({ type: 'leave', player: index });
    const client = seat.client === null ? undefined : clients.get(seat.client);
    if (client) client.seat = null;
    seats[index] = null;
  }

  /** A seat for a person or bot who asks; −1: none. People take a bot's seat where no other is free. */
  function seatFor(wish: number | null, bot: boolean): number {
    if (options.assigned) return wish !== null && wish < count && !seats[wish] ? wish : -1;
    if (wish !== null && wish < count && (!seats[wish] || (seats[wish].bot && !bot))) return wish;
    const free = seats.indexOf(null);
    return free >= 0 || bot ? free : seats.findIndex((seat) => seat?.bot);
  }

  function dismiss(client: ClientId, reason: Farewell): void {
    clients.delete(client);
    outlet.drop(client, reason);
  }

  /** Makes room on a seat and sits down. */
  function takeSeat(index: number, client: ClientId, time: number): void {
    const sitting = seats[index]?.client ?? null;
    vacate(index);
    if (sitting !== null) dismiss(sitting, 'yielded');
    enter(index, client, time);
    tellSeat(index);
  }

  function setPresence(index: number, seat: Seat, time: number): void {
    const silent = time - seat.heardAt > awayAfter;
    const presence = seat.client === null ? 'gone' : seat.declaredAway || silent ? 'away' : 'here';
    if (presence === seat.presence) return;
    seat.presence = presence;
    tellSeat(index);
  }

  function watchSeats(time: number): void {
    seats.forEach((seat, index) => {
      if (!seat) return;
      setPresence(index, seat, time);
      if (seat.posedAt !== null && time - seat.posedAt > poseMemory) {
        seat.posedAt = null;
        seat.head = null;
        act({ type: 'silent', player: index });
      }
      if (seat.lostAt === null) return;
      if (seat.playing && time - seat.lostAt > awayAfter) {
        seat.playing = false;
        act({ type: 'leave', player: index });
      }
      if (time - seat.lostAt > seatHoldSeconds) {
        vacate(index);
        tellSeat(index);
      }
    });
  }

  /** Another match once everybody who is there wants one and it can begin. */
  function rematch(time: number): void {
    const before = match?.state;
    if (before?.phase !== 'over') return;
    const there = before.players.filter(({ present }) => present);
    if (there.length === 0 || !there.every(({ ready }) => ready)) return;
    if (rotate) round += 1;
    const throwing = there.filter(({ role }) => role === 'thrower').length;
    if (!rotate && (throwing === 0 || throwing === there.length)) return;
    startMatch(time);
    before.players.forEach(({ present }, player) => {
      if (!present) return;
      act({ type: 'join', player });
      act({ type: 'ready', player, ready: true });
    });
    const events = match?.advance(time - stood, actions) ?? [];
    actions = [];
    outlet.broadcast({ type: 'match', match: packBall(match!.state), zero });
    tell(events);
  }

  function tell(events: readonly BallEvent[]): void {
    const shared = events.filter(({ type }) => type !== 'refused');
    if (shared.length > 0) outlet.broadcast({ type: 'events', events: shared });
    for (const event of events) {
      if (event.type !== 'refused') continue;
      const client = seats[event.player]?.client ?? null;
      if (client === null) continue;
      outlet.send(client, { type: 'events', events: [event] });
      outlet.refused({ client, seat: event.player, what: 'deed', reason: event.reason });
    }
  }

  const tellPause = (at: number | null): void => outlet.broadcast({ type: 'paused', at, zero });

  function stepMatch(time: number): void {
    if (!match) return;
    const held = seats.some((seat) => seat?.holds);
    if (stoppedAt !== null) {
      if (held) return;
      stood += time - stoppedAt;
      zero += time - stoppedAt;
      stoppedAt = null;
      tellPause(null);
    }
    const stopping = held && match.state.phase === 'running';
    const due = actions;
    actions = [];
    if (stopping) due.push({ type: 'pause' });
    const before = match.state.tick;
    tell(match.advance(time - stood, due));
    // Between two ticks of the match nothing is stepped: then it stops with the next one.
    if (stopping && match.state.tick !== before) {
      stoppedAt = time;
      tellPause(time - zero);
      return;
    }
    // The match cuts pauses of its host out of its time.
    const shifted = time - match.lead - match.state.tick * ballRules.tickSeconds;
    if (Math.abs(shifted - zero) > 1e-3) {
      zero = shifted;
      outlet.broadcast({ type: 'zero', zero });
    }
    rematch(time);
  }

  function sendPoses(): void {
    const poses: SeatPose[] = [];
    seats.forEach((seat, index) => {
      if (!seat?.fresh) return;
      poses.push({ seat: index, bytes: seat.fresh });
      seat.fresh = null;
    });
    if (poses.length > 0) outlet.frame(encodeFrame(poses));
  }

  if (options.kind === 'ball') startMatch(0);
  let begun = false;
  /** The first time anybody tells is the match's beginning. */
  function begin(time: number): void {
    if (begun) return;
    begun = true;
    zero = time;
    match?.advance(time - stood, []);
  }

  return {
    options,
    get census() {
      const taken = seats.filter((seat) => seat !== null);
      const bots = taken.filter(({ bot }) => bot).length;
      return {
        players: taken.length - bots,
        bots,
        spectators: spectators(),
        free: count - taken.length + bots,
        empty: clients.size === 0 && taken.length === 0,
      };
    },
    get match() {
      return match?.state ?? null;
    },
    get paused() {
      return stoppedAt !== null;
    },

    join(client, identity, joining, time) {
      begin(time);
      if (clients.has(client)) {
        outlet.refused({ client, seat: clients.get(client)!.seat, what: 'message', reason: 'joined-already' });
        return;
      }
      for (const [older, { identity: theirs }] of clients) {
        if (theirs !== identity) continue;
        const seat = seats.find((candidate) => candidate?.client === older);
        if (seat) {
          seat.client = null;
          seat.lostAt = time;
        }
        dismiss(older, 'replaced');
      }
      const { name, calibration, bot, spectate } = joining;
      clients.set(client, { identity, name, bot, calibration, seat: null });
      const held = seats.findIndex((seat) => seat?.identity === identity);
      const seat = held >= 0 ? seats[held] : null;
      if (seat && !spectate) {
        // Whoever was away too long for the rules begins as a new face; within the grace nothing has happened.
        if (!seat.playing) act({ type: 'join', player: held });
        Object.assign(seat, { client, lostAt: null, playing: true, declaredAway: false, heardAt: time, calibration });
        seat.packetTime = null;
        seat.head = null;
        if (name) seat.name = name;
        clients.get(client)!.seat = held;
        seat.presence = 'here';
        tellSeat(held);
      } else {
        if (held >= 0) {
          vacate(held);
          tellSeat(held);
        }
        const index = spectate ? -1 : seatFor(joining.seat, bot);
        if (index >= 0) takeSeat(index, client, time);
      }
      welcome(client, time);
      tellAbout();
    },

    disconnect(client, time) {
      const known = clients.get(client);
      if (!known) return;
      clients.delete(client);
      const seat = known.seat === null ? null : seats[known.seat];
      if (seat && known.seat !== null) {
        if (seat.bot) vacate(known.seat);
        else {
          seat.client = null;
          seat.lostAt = time;
          seat.presence = 'gone';
        }
        tellSeat(known.seat);
      }
      tellAbout();
    },

    receive(client, message, time) {
      const known = clients.get(client);
      if (!known) {
        outlet.refused({ client, seat: null, what: 'message', reason: 'not-joined' });
        return;
      }
      const { seat: index } = known;
      const seat = index === null ? null : (seats[index] ?? null);
      const refuse = (what: RoomRefusal['what'], reason: RoomRefusal['reason']) =>
        outlet.refused({ client, seat: index, what, reason });
      switch (message.type) {
        case 'ping':
          outlet.send(client, { type: 'pong', sent: message.sent, time });
          return;
        case 'leave':
          if (index !== null) {
            vacate(index);
            tellSeat(index);
          }
          dismiss(client, 'left');
          tellAbout();
          return;
        case 'rotate':
          if (!seat) return refuse('message', 'no-seat');
          rotate = message.rotate;
          tellAbout();
          return;
        case 'pause':
          if (!seat) return refuse('message', 'no-seat');
          if (!options.pausable) return refuse('message', 'not-pausable');
          seat.holds = message.pause;
          return;
        case 'calibration':
          known.calibration = message.calibration;
          if (seat && index !== null) {
            seat.calibration = message.calibration;
            tellSeat(index);
          }
          return;
        case 'away':
          if (seat && index !== null) {
            seat.declaredAway = message.away;
            if (!message.away) seat.heardAt = time;
            setPresence(index, seat, time);
          }
          return;
        case 'sit': {
          const wish = message.seat;
          if (wish === index) return;
          if (options.assigned) return refuse('sit', 'assigned');
          if (wish !== null && (wish >= count || (seats[wish] && (!seats[wish].bot || known.bot)))) {
            refuse('sit', 'occupied');
            return;
          }
          if (index !== null) {
            vacate(index);
            tellSeat(index);
          }
          if (wish !== null) takeSeat(wish, client, time);
          outlet.send(client, { type: 'seated', seat: wish });
          tellAbout();
          return;
        }
        case 'ready':
          if (index === null) return refuse('message', 'no-seat');
          // Nothing that waits for a clock which stands piles up.
          if (stoppedAt === null) act({ type: 'ready', player: index, ready: message.ready });
          return;
        case 'deed':
          if (index === null) return refuse('deed', 'no-seat');
          if (stoppedAt !== null) {
            tell([{ type: 'refused', player: index, sequence: message.deed.sequence, reason: 'phase' }]);
            return;
          }
          act({ ...message.deed, player: index });
      }
    },

    receivePose(client, bytes, time) {
      const packet = decodePoints(bytes);
      if (!packet) return 'bad';
      const index = clients.get(client)?.seat ?? null;
      const seat = index === null ? null : seats[index];
      if (!seat || index === null) return 'ignored';
      const packetTime = unwrapTime(packet.timeMs, time);
      const patient = time - seat.heardAt <= disbeliefSeconds;
      if (patient && seat.packetTime !== null && packetTime <= seat.packetTime) return 'ignored';
      const { head, leftHand, rightHand } = packet.pose;
      if (patient && seat.head && seat.packetTime !== null && !packet.jump) {
        const way = distance(head.position, seat.head);
        // A tenth of a metre is what rounding and a hiccup of the device may move it.
        if (way > 0.1 + fastestHead * (packetTime - seat.packetTime)) {
          outlet.refused({ client, seat: index, what: 'pose', reason: 'too-fast' });
          return 'ignored';
        }
      }
      seat.packetTime = packetTime;
      seat.head = head.position;
      seat.heardAt = time;
      seat.posedAt = time;
      // What a receiver may still draw is kept until the next tick and no longer.
      seat.fresh = bytes.slice();
      if (match && stoppedAt === null) {
        const arenaFromFloor = arenaFromFloorOf(index, count, match.state);
        const seen = (hand: typeof leftHand) =>
          hand?.tracking === 'tracked' ? transformPose(arenaFromFloor, hand) : null;
        act({
          type: 'pose',
          player: index,
          at: packetTime - zero,
          head: transformPoint(arenaFromFloor, head.position),
          left: seen(leftHand),
          right: seen(rightHand),
        });
      }
      return 'taken';
    },

    tick(time) {
      begin(time);
      watchSeats(time);
      stepMatch(time);
      sendPoses();
    },
  };
}
