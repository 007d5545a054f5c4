import type { Calibration } from '../core/body/calibration';
import { type Skeleton, skeletonFromCalibration } from '../core/body/skeleton';
import type { BallDeed, BallEvent, BallState } from '../core/games/ball/ball-state';
import { answersDeed, followBallEvent, predictDeed, withMatchTime } from '../core/games/ball/replica';
import { arenaFromSeatFloor } from '../core/games/ball/stations';
import type { BallRoomMessage, SentBallGame } from '../core/protocol/ball-messages';
import { unpackBall } from '../core/protocol/ball-snapshot';
import {
  type ClientMessage,
  type Joining,
  type SeatInfo,
  unpackSeatInfo,
  type Welcome,
} from '../core/protocol/messages';
import { decodePose, encodePose } from '../core/protocol/pose-codec';
import { decodeFrame } from '../core/protocol/pose-frame';
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
  onMessage(message: BallRoomMessage, now: number): void;
  onFrame(frame: Uint8Array, now: number): void;
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
interface Known extends Pick<Welcome<SentBallGame>, 'room' | 'epoch' | 'seat' | 'spectators' | 'rotate'> {
  seats: (SeatInfo | null)[];
  matchStart: number;
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
    return known.paused === null ? ahead() - known.matchStart : known.paused - now;
  };

  const predicted = (): BallState | null => {
    const seat = known?.seat ?? null;
    if (!confirmed) return null;
    const state = withMatchTime(confirmed, now + matchAhead());
    return seat === null ? state : pending.reduce((at, deed) => predictDeed(at, seat, deed), state);
  };

  function setSeatInfo(seat: number, info: SeatInfo | null): void {
    if (!known || seat >= known.seats.length) return;
    const before = known.seats[seat];
    known.seats = known.seats.map((other, index) => (index === seat ? info : other));
    if (
      !info ||
      before?.calibration.eyeHeight !== info.calibration.eyeHeight ||
      before.calibration.armSpan !== info.calibration.armSpan
    ) {
      skeletons[seat] = info && skeletonFromCalibration(info.calibration);
    }
  }

  function welcomed(message: Welcome<SentBallGame>): void {
    const { room, epoch, seat, spectators, rotate, matchStart, paused } = message;
    const forgotten = known !== null && known.epoch !== epoch && confirmed?.phase === 'running';
    const seats = message.seats.map(unpackSeatInfo);
    known = { room, epoch, seat, spectators, rotate, seats, matchStart, paused };
    skeletons = seats.map((info) => info && skeletonFromCalibration(info.calibration));
    confirmed = unpackBall(message.match);
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

  function onMessage(message: BallRoomMessage, at: number): void {
    now = Math.max(now, at);
    view = null;
    if (message.type === 'welcome') welcomed(message);
    else if (message.type === 'pong') clock.hear(message.sent, message.time, at);
    else if (known) onChange(known, message);
  }

  function onChange(room: Known, message: Exclude<BallRoomMessage, { type: 'welcome' | 'pong' }>): void {
    switch (message.type) {
      case 'seat':
        setSeatInfo(message.seat, unpackSeatInfo(message.info));
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
        known = { ...room, matchStart: message.matchStart, paused: message.at };
        return;
      case 'match-start':
        known = { ...room, matchStart: message.matchStart };
        return;
      case 'match':
        known = { ...room, matchStart: message.matchStart };
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
    onMessage,
    onFrame(frame, at) {
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
    act(action) {
      if (!known || known.seat === null || !confirmed) return;
      pending.push(action);
      view = null;
      wire.message({ type: 'action', action });
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
    arenaFromFloor: (seat) => arenaFromSeatFloor(seat, confirmed),
  };
}
