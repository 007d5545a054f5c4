import {
  type AvatarRef,
  avatarHashPattern,
  type BuiltInAvatar,
  type Calibration,
  isBuiltInAvatar,
} from 'threepoint/core';
import * as v from 'valibot';
import { cleanName } from './player-name';
import { toMillimetres } from './sent-measures';
import { packedVoice, packVoice, signalFrom, signalTo, unpackVoice, type Voice, voice } from './voice-messages';

/**
 * Rises with every incompatible change of messages, pose packets (which also have `poseVersion`) or frames of poses.
 * The server disconnects a client with another version.
 */
export const protocolVersion = 12;

/** The longest control message [bytes of UTF-8]; a snapshot takes at most half of it. */
export const maxMessageBytes = 4096;

/** Returns the schema of a finite number in [−limit, limit]. */
export const finiteWithin = (limit: number) => v.pipe(v.number(), v.finite(), v.minValue(-limit), v.maxValue(limit));
/** Returns the schema of an integer in [min, max]. */
export const integerWithin = (min: number, max: number) =>
  v.pipe(v.number(), v.integer(), v.minValue(min), v.maxValue(max));
/** The schema of a time [s] by any clock. */
export const seconds = finiteWithin(5e9);
/** The most seats of a room. */
export const maxSeats = 16;
const seat = integerWithin(0, maxSeats - 1);

const calibration = v.strictObject({
  eyeHeight: v.pipe(finiteWithin(3), v.minValue(0.5)),
  armSpan: v.pipe(finiteWithin(3), v.minValue(0.5)),
  forearm: v.optional(v.pipe(finiteWithin(1), v.minValue(0.05))),
});

const name = v.pipe(v.string(), v.maxLength(200), v.transform(cleanName));
/** The schema of a AvatarRef. */
const avatar = v.union([v.custom<BuiltInAvatar>(isBuiltInAvatar), v.pipe(v.string(), v.regex(avatarHashPattern))]);

/** The first message: what the others see of the player. Without a seat (null) the first free one is taken. */
const join = v.strictObject({
  type: v.literal('join'),
  version: v.literal(protocolVersion),
  name,
  calibration,
  spectate: v.boolean(),
  // Whether it is a bot, which yields its seat to a person who finds no other.
  bot: v.boolean(),
  seat: v.nullable(seat),
  avatar,
  // The voice session; null: takes no part in the voices.
  voice: v.nullable(voice),
});

const clientMessage = v.variant('type', [
  join,
  /** Whether the player is ready for the match, or after its end for another. */
  v.strictObject({ type: v.literal('ready'), ready: v.boolean() }),
  /** The page is hidden, or the headset is off. */
  v.strictObject({ type: v.literal('away'), away: v.boolean() }),
  /** Requests a free seat; null: become a spectator. */
  v.strictObject({ type: v.literal('sit'), seat: v.nullable(seat) }),
  v.strictObject({ type: v.literal('calibration'), calibration }),
  /** Changes the avatar; a file must be in the server's store. */
  v.strictObject({ type: v.literal('wear'), avatar }),
  /** Joins the voices of the room, or leaves them (null); needs a seat and a room with voices. */
  v.strictObject({ type: v.literal('voice'), voice: v.nullable(voice) }),
  signalTo,
  /** Requests or releases a pause of the match clock; needs a seat and a pausable room. */
  v.strictObject({ type: v.literal('pause'), pause: v.boolean() }),
  /** Answered at once with `pong`, which repeats `sent`. */
  v.strictObject({ type: v.literal('ping'), sent: seconds }),
  /** Leaves for good: the seat is not held. */
  v.strictObject({ type: v.literal('leave') }),
  /** An action of the game, which the match policy reads. */
  v.strictObject({ type: v.literal('action'), action: v.unknown() }),
]);

/** A control message of a client. */
export type ClientMessage = v.InferOutput<typeof clientMessage>;
export type JoinRequest = Omit<v.InferOutput<typeof join>, 'type' | 'version'>;

/** Returns the validated message; null for anything else. */
export function clientMessageFrom(value: unknown): ClientMessage | null {
  const result = v.safeParse(clientMessage, value, { abortEarly: true });
  return result.success ? result.output : null;
}

/**
 * What others see of a player. away: the page is hidden or the headset is off. gone: the connection is lost, the seat
 * is held.
 */
export interface SeatInfo {
  readonly name: string;
  readonly calibration: Calibration;
  readonly bot: boolean;
  readonly presence: (typeof presences)[number];
  readonly avatar: AvatarRef;
  /** The voice session; null: takes no part in the voices. */
  readonly voice: Voice | null;
}
const presences = ['here', 'away', 'gone'] as const;

/**
 * Wire form of a seat: name, eye height, arm span, forearm [m] or null, presence (index), 1 for a bot, avatar, voice;
 * null: the seat is empty.
 */
const packedSeatInfo = v.nullable(
  v.tuple([
    v.string(),
    finiteWithin(3),
    finiteWithin(3),
    v.nullable(finiteWithin(1)),
    integerWithin(0, presences.length - 1),
    integerWithin(0, 1),
    avatar,
    packedVoice,
  ]),
);
type PackedSeatInfo = v.InferOutput<typeof packedSeatInfo>;

/** Returns the wire form of a seat, with lengths rounded to millimetres. */
export function packSeatInfo(info: SeatInfo | null): PackedSeatInfo {
  if (!info) return null;
  const { eyeHeight, armSpan, forearm = null } = toMillimetres(info.calibration);
  const { name, presence, bot, avatar } = info;
  return [name, eyeHeight, armSpan, forearm, presences.indexOf(presence), bot ? 1 : 0, avatar, packVoice(info.voice)];
}

export function unpackSeatInfo(packed: PackedSeatInfo): SeatInfo | null {
  if (!packed) return null;
  const [name, eyeHeight, armSpan, forearm, presence, bot, avatar, wireVoice] = packed;
  const calibration = { eyeHeight, armSpan, ...(forearm !== null && { forearm }) };
  const at = presences[presence] ?? 'gone';
  return { name, calibration, presence: at, bot: bot === 1, avatar, voice: unpackVoice(wireVoice) };
}

/**
 * Why a client is disconnected: the same person connected again (replaced), a person took the bot's seat (yielded), the
 * client asked for it (left), misbehaved or reads too slowly, the server has no place for another room (full), the room
 * was closed, the server stops, or the page has another version.
 */
const disconnectReasons = [
  'replaced',
  'yielded',
  'left',
  'misbehaved',
  'slow',
  'full',
  'stopping',
  'closed',
  'old-page',
] as const;
export type DisconnectReason = (typeof disconnectReasons)[number];

/** A time for which the clock of a match stood because players were away; times of the room [s]. */
const absence = v.strictObject({
  // Counted from 1 over all matches of the room.
  number: integerWithin(1, 1e6),
  seats: v.pipe(v.array(seat), v.maxLength(maxSeats)),
  // The second of the match at which its clock was stopped.
  at: seconds,
  since: seconds,
  // When the match is given up; null: not while a player requests a pause.
  until: v.nullable(seconds),
  // For how long the match waited [s]; null: it still waits.
  seconds: v.nullable(seconds),
  // Whether the match was given up, and replaced by another one at its start.
  givenUp: v.boolean(),
});
export type Absence = v.InferOutput<typeof absence>;

/** The messages of a Room that do not depend on its game. */
const controlMessage = v.variant('type', [
  v.strictObject({ type: v.literal('seat'), seat, info: packedSeatInfo }),
  /** The receiver's new seat; null: a spectator. */
  v.strictObject({ type: v.literal('seated'), seat: v.nullable(seat) }),
  v.strictObject({ type: v.literal('about'), spectators: integerWithin(0, 10_000) }),
  /** The second at which the match clock is paused; null: it runs again, with another start. */
  v.strictObject({ type: v.literal('paused'), at: v.nullable(seconds), matchStart: seconds }),
  /** An absence that has begun, changed or ended; after a welcome, the newest of the room. */
  v.strictObject({ type: v.literal('absence'), absence }),
  /** The match has another start, because its host was suspended. */
  v.strictObject({ type: v.literal('match-start'), matchStart: seconds }),
  v.strictObject({ type: v.literal('pong'), sent: seconds, time: seconds }),
  v.strictObject({ type: v.literal('farewell'), reason: v.picklist(disconnectReasons) }),
  signalFrom,
]);

/** The state of the room after joining or reconnecting, without that of its game. */
const welcome = v.strictObject({
  type: v.literal('welcome'),
  version: v.literal(protocolVersion),
  room: v.string(),
  /** Changes when the server has created the room again. */
  epoch: v.string(),
  /** The name of the game. */
  kind: v.string(),
  /** The receiver's seat; null: a spectator. */
  seat: v.nullable(seat),
  seats: v.pipe(v.array(packedSeatInfo), v.maxLength(maxSeats)),
  spectators: integerWithin(0, 10_000),
  /** Room time at which the match clock is 0 [s]. */
  matchStart: seconds,
  /** The second at which the match clock is paused; null: it runs. */
  paused: v.nullable(seconds),
  /** Room time now [s]. */
  time: seconds,
});

/** The types of a game in the messages of its Room: its states as sent, and its events. */
interface SentGame {
  readonly snapshot: unknown;
  readonly event: unknown;
}

export type Welcome<Game extends SentGame> = v.InferOutput<typeof welcome> & { readonly match: Game['snapshot'] };

/** A control message of a Room. */
export type RoomMessage<Game extends SentGame> =
  | v.InferOutput<typeof controlMessage>
  | Welcome<Game>
  /** Another match at its start. */
  | { readonly type: 'match'; readonly match: Game['snapshot']; readonly matchStart: number }
  | { readonly type: 'events'; readonly events: readonly Game['event'][] };

/** Creates a reader for the messages of one game's Rooms. It returns the validated message; null for anything else. */
export function roomMessageReader<Game extends SentGame>(
  kind: string,
  snapshot: v.GenericSchema<unknown, Game['snapshot']>,
  event: v.GenericSchema<unknown, Game['event']>,
): (value: unknown) => RoomMessage<Game> | null {
  const message = v.variant('type', [
    ...controlMessage.options,
    v.strictObject({ ...welcome.entries, kind: v.literal(kind), match: snapshot }),
    v.strictObject({ type: v.literal('match'), match: snapshot, matchStart: seconds }),
    v.strictObject({ type: v.literal('events'), events: v.array(event) }),
  ]);
  return (value) => {
    const result = v.safeParse(message, value, { abortEarly: true });
    return result.success ? (result.output as RoomMessage<Game>) : null;
  };
}
