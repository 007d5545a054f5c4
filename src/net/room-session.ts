import type { Calibration } from '../core/body/calibration';
import { type Skeleton, skeletonFromCalibration } from '../core/body/skeleton';
import type { BallDeed, BallEvent, BallState } from '../core/games/ball/ball-state';
import { answersDeed, followBallEvent, predictDeed, withMatchTime } from '../core/games/ball/replica';
import { unpackBall } from '../core/protocol/ball-snapshot';
import {
  type ClientMessage,
  type Joining,
  type RoomMessage,
  type SeatRow,
  unpackRow,
  type Welcome,
} from '../core/protocol/messages';
import { decodePose, encodePose } from '../core/protocol/pose-codec';
import { decodeFrame } from '../core/protocol/pose-frame';
import { arenaFromFloorOf } from '../core/room/seat-places';
import { createClockSync } from './clock-sync';
import type { ArrivedPose, Connection, ConnectionUpdate, RoomView, ShownPose, Visitor } from './connection';

/** The way to the Room. */
export interface Wire {
  message(message: ClientMessage): void;
  pose(bytes: Uint8Array): void;
}

/** A client's half of the protocol, whatever carries it. */
export interface RoomSession extends Omit<Connection, 'status' | 'leave' | 'update'> {
  /** What to say first on every new connection. */
  joining(): Joining;
  hear(message: RoomMessage, now: number): void;
  hearFrame(frame: Uint8Array, now: number): void;
  /** This page's clock left out `seconds` of a pause that ended at `now`; the Room's went on. */
  paused(seconds: number, now: number): void;
  /** What came since the last call; asks for the time when that is due. */
  update(now: number, connected: boolean): ConnectionUpdate;
}

const poseSeconds = 1 / 30;

/** The last frames while nobody asks (a hidden page) are not kept longer than this [packets]. */
const mostWaiting = 256;

const toMillimetres = ({ eyeHeight, armSpan }: Calibration): Calibration => ({
  eyeHeight: Math.round(eyeHeight * 1000) / 1000,
  armSpan: Math.round(armSpan * 1000) / 1000,
});

/** Mutable half of a RoomView. */
interface Known extends Pick<Welcome, 'room' | 'epoch' | 'kind' | 'seat' | 'spectators' | 'rotate'> {
  seats: (SeatRow | null)[];
  zero: number;
  /** Second of the match at which its clock stands; null: it runs. */
  paused: number | null;
}

/** `knowsClock`: the Room's clock is this page's own. */
export function createRoomSession(visitor: Visitor, wire: Wire, knowsClock = false): RoomSession {
  const clock = createClockSync();
  let calibration = toMillimetres(visitor.calibration);
  let skeleton = skeletonFromCalibration(calibration);
  let skeletons: (Skeleton | null)[] = [];
  let known: Known | null = null;
  /** What the Room has confirmed. */
  let confirmed: BallState | null = null;
  let pending: BallDeed[] = [];
  let wishes: { spectate: boolean; seat: number | null } = {
    spectate: visitor.spectate ?? false,
    seat: visitor.seat ?? null,
  };
  /** Whether the clock is to stand; null: never asked for. */
  let pauseWish: boolean | null = null;
  let voided = 0;
  let now = 0;
  let nextPose = Number.NEGATIVE_INFINITY;
  let events: BallEvent[] = [];
  let poses: ArrivedPose[] = [];
  let news: ConnectionUpdate['news'][number][] = [];
  let view: RoomView | null = null;

  const ahead = (): number => (knowsClock ? 0 : clock.ahead);
  const matchAhead = (): number => {
    if (!known) return 0;
    return known.paused === null ? ahead() - known.zero : known.paused - now;
  };

  const predicted = (): BallState | null => {
    const seat = known?.seat ?? null;
    if (!confirmed) return null;
    const state = withMatchTime(confirmed, now + matchAhead());
    return seat === null ? state : pending.reduce((at, deed) => predictDeed(at, seat, deed), state);
  };

  function setRow(seat: number, row: SeatRow | null): void {
    if (!known || seat >= known.seats.length) return;
    const before = known.seats[seat];
    known.seats = known.seats.map((other, index) => (index === seat ? row : other));
    if (
      !row ||
      before?.calibration.eyeHeight !== row.calibration.eyeHeight ||
      before.calibration.armSpan !== row.calibration.armSpan
    ) {
      skeletons[seat] = row && skeletonFromCalibration(row.calibration);
    }
  }

  function welcomed(message: Welcome): void {
    const { room, epoch, kind, seat, spectators, rotate, zero, paused } = message;
    const forgotten = known !== null && known.epoch !== epoch && confirmed?.phase === 'running';
    const seats = message.seats.map(unpackRow);
    known = { room, epoch, kind, seat, spectators, rotate, seats, zero: zero ?? 0, paused };
    skeletons = seats.map((row) => row && skeletonFromCalibration(row.calibration));
    confirmed = message.match && unpackBall(message.match);
    pending = [];
    // Who returns to a server that has forgotten them asks for the same seat.
    if (seat !== null) wishes = { spectate: false, seat };
    if (forgotten) {
      voided += 1;
      news.push('voided');
    }
    news.push('welcome');
    // The room may have forgotten it, or have been told otherwise before the connection was lost.
    if (pauseWish !== null && seat !== null) wire.message({ type: 'pause', pause: pauseWish });
  }

  function hear(message: RoomMessage, at: number): void {
    now = Math.max(now, at);
    view = null;
    if (message.type === 'welcome') welcomed(message);
    else if (message.type === 'pong') clock.hear(message.sent, message.time, at);
    else if (known) hearChange(known, message);
  }

  function hearChange(room: Known, message: Exclude<RoomMessage, { type: 'welcome' | 'pong' }>): void {
    switch (message.type) {
      case 'seat':
        setRow(message.seat, unpackRow(message.row));
        news.push('seats');
        return;
      case 'seated':
        known = { ...room, seat: message.seat };
        wishes = { spectate: message.seat === null, seat: message.seat };
        pending = [];
        news.push('seats');
        if (pauseWish && message.seat !== null) wire.message({ type: 'pause', pause: true });
        return;
      case 'about':
        known = { ...room, spectators: message.spectators, rotate: message.rotate };
        return;
      case 'paused':
        known = { ...room, zero: message.zero, paused: message.at };
        return;
      case 'zero':
        known = { ...room, zero: message.zero };
        return;
      case 'match':
        known = { ...room, zero: message.zero };
        confirmed = unpackBall(message.match);
        pending = [];
        news.push('match');
        return;
      case 'events':
        for (const event of message.events) {
          const { seat } = room;
          if (confirmed) confirmed = followBallEvent(confirmed, event);
          if (seat !== null) pending = pending.filter((deed) => !answersDeed(event, seat, deed));
          events.push(event);
        }
    }
  }

  return {
    get room() {
      if (!known) return null;
      view ??= {
        id: known.room,
        kind: known.kind,
        seats: known.seats,
        mySeat: known.seat,
        spectators: known.spectators,
        rotate: known.rotate,
        match: predicted(),
        delay: knowsClock ? null : clock.delayAt(now),
        matchAhead: matchAhead(),
        paused: known.paused !== null,
        voided,
      };
      return view;
    },
    joining: () => ({ name: visitor.name, calibration, bot: visitor.bot ?? false, ...wishes }),
    hear,
    hearFrame(frame, at) {
      // A bot looks at no one: it plays by what the match says.
      if (visitor.bot) return;
      const seatPoses = decodeFrame(frame);
      for (const { seat, bytes } of seatPoses ?? []) {
        const theirs = skeletons[seat];
        if (!theirs || seat === known?.seat) continue;
        const packet = decodePose(bytes, theirs);
        if (packet) poses.push({ seat, packet, arrivedAt: at });
      }
      if (poses.length > mostWaiting) poses = poses.slice(-mostWaiting);
    },
    paused: clock.paused,
    update(time, connected) {
      now = time;
      view = null;
      if (connected && !knowsClock && clock.due(time)) wire.message({ type: 'ping', sent: time });
      const since = { events, poses, news };
      events = [];
      poses = [];
      news = [];
      return since;
    },
    sendPose(time, shown: ShownPose) {
      if (!known || known.seat === null || (time < nextPose && !shown.jump)) return;
      // Frames come at their own rate: on average thirty packets a second.
      nextPose = Math.max(nextPose + poseSeconds, time + poseSeconds / 2);
      const timeMs = Math.round((time + ahead()) * 1000) & 0xffff;
      const bytes = encodePose({ ...shown, timeMs }, skeleton);
      if (bytes) wire.pose(bytes);
    },
    act(deed) {
      if (!known || known.seat === null || !confirmed) return;
      pending.push(deed);
      view = null;
      wire.message({ type: 'deed', deed });
    },
    ready: (ready) => wire.message({ type: 'ready', ready }),
    rotate: (rotate) => wire.message({ type: 'rotate', rotate }),
    pause(pause) {
      pauseWish = pause;
      if (known && known.seat !== null) wire.message({ type: 'pause', pause });
    },
    away: (away) => wire.message({ type: 'away', away }),
    sit: (seat) => wire.message({ type: 'sit', seat }),
    calibrate(measures) {
      calibration = toMillimetres(measures);
      skeleton = skeletonFromCalibration(calibration);
      if (known) wire.message({ type: 'calibration', calibration });
    },
    arenaFromFloor: (seat) => arenaFromFloorOf(seat, known?.seats.length ?? 1, confirmed),
  };
}
