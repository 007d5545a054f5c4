import * as v from 'valibot';
import type { Calibration } from '../body/calibration';
import { packedBallSchema } from './ball-snapshot';
import { cleanName } from './names';

/** Bumped with every change that an older page or server would misunderstand. */
export const protocolVersion = 2;

/** No control message is longer [bytes of UTF-8]; a snapshot takes at most half of it. */
export const longestMessage = 4096;

const finiteWithin = (limit: number) => v.pipe(v.number(), v.finite(), v.minValue(-limit), v.maxValue(limit));
const wholeFrom = (min: number, max: number) => v.pipe(v.number(), v.integer(), v.minValue(min), v.maxValue(max));
/** Seconds since a clock's zero, whatever that is: a century and a half. */
const seconds = finiteWithin(5e9);
/** Not in the order of a vector: see `Vec3` for why an object with schemas in it must not be written like one. */
const vector = (limit: number) =>
  v.strictObject({ z: finiteWithin(limit), y: finiteWithin(limit), x: finiteWithin(limit) });
const side = v.picklist(['left', 'right']);
const ball = wholeFrom(0, 19);
const player = wholeFrom(0, 2);
const sequence = wholeFrom(1, 2 ** 31 - 1);
/** Sixteen seats at most. */
export const mostSeats = 16;
const seat = wholeFrom(0, mostSeats - 1);

const grab = v.strictObject({ type: v.literal('grab'), sequence, side, ball });
const drop = v.strictObject({ type: v.literal('drop'), sequence, side });
/** Limits here are those of a message; what no arm can do the rules refuse, with their reason. */
const throwing = v.strictObject({
  type: v.literal('throw'),
  sequence,
  side,
  ball,
  at: finiteWithin(1e7),
  position: vector(1000),
  velocity: vector(1000),
});

const calibration = v.strictObject({
  eyeHeight: v.pipe(finiteWithin(3), v.minValue(0.5)),
  armSpan: v.pipe(finiteWithin(3), v.minValue(0.5)),
});

const name = v.pipe(v.string(), v.maxLength(200), v.transform(cleanName));

/** First of all: who this is to the others. Where a seat is free and none is named, the first. */
const join = v.strictObject({
  type: v.literal('join'),
  version: v.literal(protocolVersion),
  name,
  calibration,
  spectate: v.boolean(),
  /** Not a person: gives its seat to the first person who finds none. */
  bot: v.boolean(),
  seat: v.nullable(seat),
});

const clientMessage = v.variant('type', [
  join,
  /** Ready for the match, or after its end for another. */
  v.strictObject({ type: v.literal('ready'), ready: v.boolean() }),
  /** Whether roles move on by one seat with every rematch. */
  v.strictObject({ type: v.literal('rotate'), rotate: v.boolean() }),
  /** The page is hidden, or the headset is off. */
  v.strictObject({ type: v.literal('away'), away: v.boolean() }),
  /** To another seat that is free, or to one from among the spectators; null: become a spectator. */
  v.strictObject({ type: v.literal('sit'), seat: v.nullable(seat) }),
  v.strictObject({ type: v.literal('calibration'), calibration }),
  /** Stop the match's clock, or take that back: in a room whose terms allow it, for who has a seat. */
  v.strictObject({ type: v.literal('pause'), pause: v.boolean() }),
  /** Answered at once; `sent` comes back as it is. */
  v.strictObject({ type: v.literal('ping'), sent: seconds }),
  /** For good: the seat is not held. */
  v.strictObject({ type: v.literal('leave') }),
  v.strictObject({ type: v.literal('deed'), deed: v.variant('type', [grab, drop, throwing]) }),
]);

/** What a client may say, apart from pose packets. */
export type ClientMessage = v.InferOutput<typeof clientMessage>;
export type Joining = Omit<v.InferOutput<typeof join>, 'type' | 'version'>;

/** The kinds of message that a client may send. */
export const clientMessageTypes: readonly ClientMessage['type'][] = clientMessage.options.map(
  ({ entries }) => entries.type.literal,
);

/** The message, checked field by field; null for anything else. */
export function clientMessageFrom(value: unknown): ClientMessage | null {
  const result = v.safeParse(clientMessage, value, { abortEarly: true });
  return result.success ? result.output : null;
}

/** What a room is for: the ball game has three seats, an open room sixteen and no game. */
export const roomKinds = ['ball', 'open'] as const;
export type RoomKind = (typeof roomKinds)[number];

/**
 * What a person may ask of a room that does not exist yet; whoever comes first decides, and nothing changes them later. `seconds`: of
 * a round of the ball game. `pausable`: whoever has a seat may stop the match's clock.
 */
export const roomTerms = v.strictObject({
  seconds: v.exactOptional(v.pipe(v.number(), v.finite(), v.minValue(1), v.maxValue(3600))),
  balls: v.exactOptional(v.pipe(v.number(), v.integer(), v.minValue(1), v.maxValue(20))),
  pausable: v.exactOptional(v.boolean()),
});
export type RoomTerms = v.InferOutput<typeof roomTerms>;

/** Somebody on a seat. away: hides the page or took the headset off. gone: connection lost, the seat is held. */
export interface SeatRow {
  readonly name: string;
  readonly calibration: Calibration;
  readonly bot: boolean;
  readonly presence: (typeof presences)[number];
}
const presences = ['here', 'away', 'gone'] as const;

/** Name, eye height, arm span [m], presence (index), 1 for a bot. */
const packedRow = v.nullable(
  v.tuple([v.string(), finiteWithin(3), finiteWithin(3), wholeFrom(0, presences.length - 1), wholeFrom(0, 1)]),
);
export type PackedRow = v.InferOutput<typeof packedRow>;

const millimetres = (metres: number): number => Math.round(metres * 1000) / 1000;

export const packRow = (row: SeatRow | null): PackedRow =>
  row && [
    row.name,
    millimetres(row.calibration.eyeHeight),
    millimetres(row.calibration.armSpan),
    presences.indexOf(row.presence),
    row.bot ? 1 : 0,
  ];

export function unpackRow(packed: PackedRow): SeatRow | null {
  if (!packed) return null;
  const [name, eyeHeight, armSpan, presence, bot] = packed;
  return { name, calibration: { eyeHeight, armSpan }, presence: presences[presence] ?? 'gone', bot: bot === 1 };
}

const launch = v.strictObject({ time: seconds, position: vector(1e6), velocity: vector(1e6) });
const ballEvent = v.variant('type', [
  v.strictObject({ type: v.picklist(['joined', 'left']), player }),
  v.strictObject({ type: v.literal('ready'), player, ready: v.boolean() }),
  v.strictObject({ type: v.literal('started'), at: seconds }),
  v.strictObject({ type: v.literal('grabbed'), ball, player, side }),
  v.strictObject({ type: v.literal('returned'), ball, player }),
  v.strictObject({ type: v.literal('thrown'), ball, player, launch }),
  v.strictObject({ type: v.literal('bounced'), ball, off: v.picklist(['basket', 'floor']), launch }),
  v.strictObject({ type: v.literal('missed'), ball, player }),
  v.strictObject({ type: v.literal('rolls'), ball, launch }),
  v.strictObject({ type: v.literal('caught'), ball, player, at: seconds, score: wholeFrom(0, 20) }),
  v.strictObject({
    type: v.literal('refused'),
    player,
    sequence: v.number(),
    reason: v.picklist([
      'phase',
      'role',
      'absent',
      'seen-before',
      'no-such-ball',
      'taken',
      'hand-full',
      'not-held',
      'reach',
      'zone',
      'speed',
      'time',
    ]),
  }),
  v.strictObject({ type: v.literal('ended'), end: v.picklist(['balls', 'time']), score: wholeFrom(0, 20) }),
]);

/** Why the Room will have somebody no longer: another connection of the same person, a person for a bot's seat, asked to. */
export const farewells = [
  'replaced',
  'yielded',
  'left',
  'misbehaved',
  'slow',
  'stopping',
  'closed',
  'old-page',
] as const;
export type Farewell = (typeof farewells)[number];

const roomMessage = v.variant('type', [
  /** The whole room, on joining and on returning. `epoch` is new when the room has forgotten everything. */
  v.strictObject({
    type: v.literal('welcome'),
    version: v.literal(protocolVersion),
    room: v.string(),
    epoch: v.string(),
    kind: v.picklist(roomKinds),
    /** The receiver's; null: a spectator. */
    seat: v.nullable(seat),
    seats: v.pipe(v.array(packedRow), v.maxLength(mostSeats)),
    spectators: wholeFrom(0, 10_000),
    rotate: v.boolean(),
    /** Room clock [s] at which the match was at 0 s; null with `match`. */
    zero: v.nullable(seconds),
    match: v.nullable(packedBallSchema),
    /** Second of the match at which its clock stands; null: it runs. */
    paused: v.nullable(seconds),
    /** Room clock [s], now. */
    time: seconds,
  }),
  v.strictObject({ type: v.literal('seat'), seat, row: packedRow }),
  /** The receiver sits here now. */
  v.strictObject({ type: v.literal('seated'), seat: v.nullable(seat) }),
  v.strictObject({ type: v.literal('about'), spectators: wholeFrom(0, 10_000), rotate: v.boolean() }),
  /** Another match, as it begins. */
  v.strictObject({ type: v.literal('match'), match: packedBallSchema, zero: seconds }),
  /** The match's clock stands at this second, because somebody stopped it; null: it runs again, and its zero is elsewhere. */
  v.strictObject({ type: v.literal('paused'), at: v.nullable(seconds), zero: seconds }),
  /** The host of the match paused: its zero is elsewhere now. */
  v.strictObject({ type: v.literal('zero'), zero: seconds }),
  v.strictObject({ type: v.literal('events'), events: v.array(ballEvent) }),
  v.strictObject({ type: v.literal('pong'), sent: seconds, time: seconds }),
  v.strictObject({ type: v.literal('farewell'), reason: v.picklist(farewells) }),
]);

/** What a Room says, apart from frames of poses. */
export type RoomMessage = v.InferOutput<typeof roomMessage>;
export type Welcome = Extract<RoomMessage, { type: 'welcome' }>;

/** The message, checked field by field; null for anything else. */
export function roomMessageFrom(value: unknown): RoomMessage | null {
  const result = v.safeParse(roomMessage, value, { abortEarly: true });
  return result.success ? result.output : null;
}
