import type { Calibration } from 'threepoint/core/body/calibration';
import { avatarHash, isOwnAvatar, type OwnAvatar, type WornAvatar } from 'threepoint/core/body/worn-avatar';
import * as v from 'valibot';
import { cleanName } from './names';
import { packedVoice, packVoice, signalFrom, signalTo, unpackVoice, type Voice, voice } from './voice-messages';

/**
 * Bumped with every change that an older page or server would misunderstand: of these messages, of pose packets and of their frames, which each
 * have a version of their own. Who joins with another one is told so, and shows nothing to those who could not read it.
 */
export const protocolVersion = 9;

/** No control message is longer [bytes of UTF-8]; a snapshot takes at most half of it. */
export const longestMessage = 4096;

/** A finite number in [−limit, limit]. */
export const finiteWithin = (limit: number) => v.pipe(v.number(), v.finite(), v.minValue(-limit), v.maxValue(limit));
/** A whole number in [min, max]. */
export const wholeFrom = (min: number, max: number) =>
  v.pipe(v.number(), v.integer(), v.minValue(min), v.maxValue(max));
/** Seconds since any clock's start: within a century and a half. */
export const seconds = finiteWithin(5e9);
/** Sixteen seats at most. */
export const mostSeats = 16;
const seat = wholeFrom(0, mostSeats - 1);

const calibration = v.strictObject({
  eyeHeight: v.pipe(finiteWithin(3), v.minValue(0.5)),
  armSpan: v.pipe(finiteWithin(3), v.minValue(0.5)),
  forearm: v.optional(v.pipe(finiteWithin(1), v.minValue(0.05))),
});

const name = v.pipe(v.string(), v.maxLength(200), v.transform(cleanName));
/** A WornAvatar. */
const avatar = v.union([v.custom<OwnAvatar>(isOwnAvatar), v.pipe(v.string(), v.regex(avatarHash))]);

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
  avatar,
  /** How the page takes part in the voices; null: it does not. */
  voice: v.nullable(voice),
});

const clientMessage = v.variant('type', [
  join,
  /** Ready for the match, or after its end for another. */
  v.strictObject({ type: v.literal('ready'), ready: v.boolean() }),
  /** Whether roles move on with every rematch. */
  v.strictObject({ type: v.literal('rotate'), rotate: v.boolean() }),
  /** The page is hidden, or the headset is off. */
  v.strictObject({ type: v.literal('away'), away: v.boolean() }),
  /** To another seat that is free, or to one from among the spectators; null: become a spectator. */
  v.strictObject({ type: v.literal('sit'), seat: v.nullable(seat) }),
  v.strictObject({ type: v.literal('calibration'), calibration }),
  /** To be seen with another avatar; of a file, the server's store has it. */
  v.strictObject({ type: v.literal('wear'), avatar }),
  /** To take part in the voices of the room, or no longer (null): from a seat, where the room has voices. */
  v.strictObject({ type: v.literal('voice'), voice: v.nullable(voice) }),
  signalTo,
  /** Stop the match's clock, or take that back: in a room whose terms allow it, from a seat. */
  v.strictObject({ type: v.literal('pause'), pause: v.boolean() }),
  /** Answered at once; `sent` comes back as it is. */
  v.strictObject({ type: v.literal('ping'), sent: seconds }),
  /** For good: the seat is not held. */
  v.strictObject({ type: v.literal('leave') }),
  /** What the player does in the game; its policy reads it. */
  v.strictObject({ type: v.literal('action'), action: v.unknown() }),
]);

/** What a client may say, apart from pose packets. */
export type ClientMessage = v.InferOutput<typeof clientMessage>;
export type JoinRequest = Omit<v.InferOutput<typeof join>, 'type' | 'version'>;

/** The message, checked field by field; null for anything else. */
export function clientMessageFrom(value: unknown): ClientMessage | null {
  const result = v.safeParse(clientMessage, value, { abortEarly: true });
  return result.success ? result.output : null;
}

/**
 * What a person may ask of a room that does not exist yet; the first person in it decides, and nothing changes them later. `seconds`,
 * `balls`: of a round of the ball game. `pausable`: players may stop the match's clock.
 */
export const roomTerms = v.strictObject({
  seconds: v.exactOptional(v.pipe(v.number(), v.finite(), v.minValue(1), v.maxValue(3600))),
  balls: v.exactOptional(v.pipe(v.number(), v.integer(), v.minValue(1), v.maxValue(20))),
  pausable: v.exactOptional(v.boolean()),
});
export type RoomTerms = v.InferOutput<typeof roomTerms>;

/** What others know of a player. away: hides the page or took the headset off. gone: connection lost, the seat is held. */
export interface SeatInfo {
  readonly name: string;
  readonly calibration: Calibration;
  readonly bot: boolean;
  readonly presence: (typeof presences)[number];
  readonly avatar: WornAvatar;
  /** null: takes no part in the voices. */
  readonly voice: Voice | null;
}
const presences = ['here', 'away', 'gone'] as const;

/** Name, eye height, arm span and forearm [m] (null: not told), presence (index), 1 for a bot, avatar, voice; null: the seat is empty. */
const packedSeatInfo = v.nullable(
  v.tuple([
    v.string(),
    finiteWithin(3),
    finiteWithin(3),
    v.nullable(finiteWithin(1)),
    wholeFrom(0, presences.length - 1),
    wholeFrom(0, 1),
    avatar,
    packedVoice,
  ]),
);
type PackedSeatInfo = v.InferOutput<typeof packedSeatInfo>;

const millimetres = (metres: number): number => Math.round(metres * 1000) / 1000;

/** A body as it is told to others. */
export const toMillimetres = ({ eyeHeight, armSpan, forearm }: Calibration): Calibration => ({
  eyeHeight: millimetres(eyeHeight),
  armSpan: millimetres(armSpan),
  ...(forearm !== undefined && { forearm: millimetres(forearm) }),
});

/** Wire form of a seat: lengths rounded to millimetres, null for an empty seat. */
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
 * Why the Room ends a client's stay: the same person connected again (replaced), a person took a bot's seat (yielded), the client
 * asked for it (left), broke the rules, reads too slowly, or the room or its server ends.
 */
const disconnectReasons = [
  'replaced',
  'yielded',
  'left',
  'misbehaved',
  'slow',
  'stopping',
  'closed',
  'old-page',
] as const;
export type DisconnectReason = (typeof disconnectReasons)[number];

/** What a Room says of itself, in any game. */
const controlMessage = v.variant('type', [
  v.strictObject({ type: v.literal('seat'), seat, info: packedSeatInfo }),
  /** The receiver sits here now. */
  v.strictObject({ type: v.literal('seated'), seat: v.nullable(seat) }),
  v.strictObject({ type: v.literal('about'), spectators: wholeFrom(0, 10_000), rotate: v.boolean() }),
  /** The match's clock stands at this second because a player stopped it; null: it runs again, and its start is elsewhere. */
  v.strictObject({ type: v.literal('paused'), at: v.nullable(seconds), matchStart: seconds }),
  /** The match's start is elsewhere now: its host paused. */
  v.strictObject({ type: v.literal('match-start'), matchStart: seconds }),
  v.strictObject({ type: v.literal('pong'), sent: seconds, time: seconds }),
  v.strictObject({ type: v.literal('farewell'), reason: v.picklist(disconnectReasons) }),
  signalFrom,
]);

/** The whole room, on joining and on returning, but for the state of its game. */
const welcome = v.strictObject({
  type: v.literal('welcome'),
  version: v.literal(protocolVersion),
  room: v.string(),
  /** Another one when the room has forgotten everything. */
  epoch: v.string(),
  /** The game. */
  kind: v.string(),
  /** The receiver's; null: a spectator. */
  seat: v.nullable(seat),
  seats: v.pipe(v.array(packedSeatInfo), v.maxLength(mostSeats)),
  spectators: wholeFrom(0, 10_000),
  rotate: v.boolean(),
  /** Room clock [s] at which the match was at 0 s. */
  matchStart: seconds,
  /** Second of the match at which its clock stands; null: it runs. */
  paused: v.nullable(seconds),
  /** Room clock [s], now. */
  time: seconds,
});

/** What a game brings into the messages of its Room: its states as they are sent, and its events. */
interface SentGame {
  readonly snapshot: unknown;
  readonly event: unknown;
}

export type Welcome<Game extends SentGame> = v.InferOutput<typeof welcome> & { readonly match: Game['snapshot'] };

/** What a Room says, apart from frames of poses. */
export type RoomMessage<Game extends SentGame> =
  | v.InferOutput<typeof controlMessage>
  | Welcome<Game>
  /** Another match, as it begins. */
  | { readonly type: 'match'; readonly match: Game['snapshot']; readonly matchStart: number }
  | { readonly type: 'events'; readonly events: readonly Game['event'][] };

/** Reads what the Rooms of one game say: the message, checked field by field; null for anything else. */
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
