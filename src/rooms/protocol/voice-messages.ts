import * as v from 'valibot';

/** The most seats of a room with voices: each page connects to every other one. */
export const maxVoiceSeats = 6;

/** Identifies one page's voice session; a new id after a reload, or when all peer connections restart. */
const session = v.pipe(v.string(), v.regex(/^[\w-]{8,16}$/));

/** A page's part in the voices of its room. */
export const voice = v.strictObject({ session, muted: v.boolean() });
export type Voice = v.InferOutput<typeof voice>;

/** Wire form of `Voice` in a seat: [session, muted as 0 or 1]; 0: takes no part. */
export const packedVoice = v.union([v.literal(0), v.tuple([session, v.picklist([0, 1])])]);
type PackedVoice = v.InferOutput<typeof packedVoice>;

export const packVoice = (of: Voice | null): PackedVoice => (of ? [of.session, of.muted ? 1 : 0] : 0);
export const unpackVoice = (packed: PackedVoice): Voice | null =>
  packed === 0 ? null : { session: packed[0], muted: packed[1] === 1 };

/**
 * The longest description [characters], and the most candidates in one message, so that it fits into a control message.
 */
export const maxDescriptionLength = 3200;
export const maxCandidates = 8;

/** Text of a signal: one line, or several. */
const line = /^[\x20-\x7e]*$/;
const lines = /^[\x20-\x7e\t\r\n]*$/;

/** The address of a candidate: a number, or a name by which a browser hides one on its own network. */
const address = String.raw`(?:[\d.]+|[\da-f]*:[\da-f:.]*|[\w-]+\.local)`;
const udpCandidate = new RegExp(String.raw`^candidate:\S+ \d+ udp \d+ ${address} \d+ typ `, 'i');
const activeTcpCandidate = new RegExp(
  String.raw`^candidate:\S+ \d+ tcp \d+ ${address} \d+ typ \S+ (?:raddr \S+ rport \d+ )?tcptype active(?: |$)`,
  'i',
);

/**
 * Returns whether a page may pass an ICE candidate to another one. The other page connects to passive TCP ports, and
 * looks up names; browsers gather neither for themselves.
 */
export const isPassableCandidate = (text: string): boolean =>
  text === '' || udpCandidate.test(text) || activeTcpCandidate.test(text);

/**
 * Returns whether a description has one audio section at most, no other media, no other candidates, and no identity
 * provider, which a page would contact.
 */
const isOneVoice = (sdp: string): boolean => {
  const parts = sdp.split(/[\r\n]+/).filter(Boolean);
  const media = parts.filter((text) => text.startsWith('m='));
  return (
    media.length <= 1 &&
    media.every((text) => text.startsWith('m=audio ')) &&
    // Browsers disagree about lines of another form.
    parts.every((text) => /^(s=|[a-z]=\S)/.test(text)) &&
    !parts.some((text) => text.startsWith('a=identity')) &&
    parts.every((text) => !text.startsWith('a=candidate') || isPassableCandidate(text.slice(2)))
  );
};

/** An ICE candidate, as in RTCIceCandidateInit, with its media section. */
const candidate = v.pipe(
  v.strictObject({
    candidate: v.pipe(v.string(), v.maxLength(300), v.regex(line), v.check(isPassableCandidate)),
    sdpMid: v.nullable(v.pipe(v.string(), v.maxLength(16), v.regex(line))),
    sdpMLineIndex: v.nullable(v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(7))),
    usernameFragment: v.nullable(v.pipe(v.string(), v.maxLength(256), v.regex(line))),
  }),
  v.check(({ sdpMid, sdpMLineIndex }) => sdpMid !== null || sdpMLineIndex !== null),
);

/**
 * A signal between two pages that connect: a description, or ICE candidates. Browsers would also accept other media,
 * and throw at a candidate without a media section; rooms and pages reject both.
 */
const signalBody = v.union([
  v.strictObject({
    description: v.strictObject({
      type: v.picklist(['offer', 'answer']),
      sdp: v.pipe(v.string(), v.maxLength(maxDescriptionLength), v.regex(lines), v.check(isOneVoice)),
    }),
  }),
  v.strictObject({ candidates: v.pipe(v.array(candidate), v.minLength(1), v.maxLength(maxCandidates)) }),
]);
export type SignalBody = v.InferOutput<typeof signalBody>;

/** A signal to another page's session. The room forwards it with the sender's session. */
export const signalTo = v.strictObject({ type: v.literal('signal'), to: session, body: signalBody });
export const signalFrom = v.strictObject({ type: v.literal('signal'), from: session, body: signalBody });
