import * as v from 'valibot';

/** A room in which there are voices has no more seats than this: each page has a connection to each other one. */
export const mostVoices = 6;

/** Identifies one page's voice session; a new id after a reload, or when all peer connections restart. */
const session = v.pipe(v.string(), v.regex(/^[\w-]{8,16}$/));

/** How a page takes part in the voices of its room. */
export const voice = v.strictObject({ session, muted: v.boolean() });
export type Voice = v.InferOutput<typeof voice>;

/** Wire form of `Voice` in a packed seat: [session, muted as 0 or 1]; 0 alone: not taking part. */
export const packedVoice = v.union([v.literal(0), v.tuple([session, v.picklist([0, 1])])]);
type PackedVoice = v.InferOutput<typeof packedVoice>;

export const packVoice = (of: Voice | null): PackedVoice => (of ? [of.session, of.muted ? 1 : 0] : 0);
export const unpackVoice = (packed: PackedVoice): Voice | null =>
  packed === 0 ? null : { session: packed[0], muted: packed[1] === 1 };

/** Longest description of a connection [characters], and most addresses in one message, so that it fits into a control message. */
export const longestDescription = 3200;
export const mostCandidates = 8;

/** Text as browsers write it into a signal: one line, or with ends of lines. */
const line = /^[\x20-\x7e]*$/;
const lines = /^[\x20-\x7e\t\r\n]*$/;

/** Whether a description is of a voice and of nothing else: no video, no channel of data, no second voice. */
const isOneVoice = (sdp: string): boolean => {
  const [first, ...more] = sdp.split(/[\r\n]+/).filter((text) => text.startsWith('m='));
  return more.length === 0 && (first === undefined || first.startsWith('m=audio '));
};

/** One address at which a page may be reached; as RTCIceCandidateInit has it, which belongs to a part of the description. */
const candidate = v.pipe(
  v.strictObject({
    candidate: v.pipe(v.string(), v.maxLength(300), v.regex(line)),
    sdpMid: v.nullable(v.pipe(v.string(), v.maxLength(16), v.regex(line))),
    sdpMLineIndex: v.nullable(v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(7))),
    usernameFragment: v.nullable(v.pipe(v.string(), v.maxLength(256), v.regex(line))),
  }),
  v.check(({ sdpMid, sdpMLineIndex }) => sdpMid !== null || sdpMLineIndex !== null),
);

/**
 * What two pages tell each other to set up the connection between them: what it is to carry, or where they may be reached. A browser takes more
 * than a voice, and fails with a fault of the page at what belongs to no part: the room passes neither on, and no page reads it.
 */
const signalBody = v.union([
  v.strictObject({
    description: v.strictObject({
      type: v.picklist(['offer', 'answer']),
      sdp: v.pipe(v.string(), v.maxLength(longestDescription), v.regex(lines), v.check(isOneVoice)),
    }),
  }),
  v.strictObject({ candidates: v.pipe(v.array(candidate), v.minLength(1), v.maxLength(mostCandidates)) }),
]);
export type SignalBody = v.InferOutput<typeof signalBody>;

/** From a page to another one's session, which the room passes on; whose it is, the room says itself. */
export const signalTo = v.strictObject({ type: v.literal('signal'), to: session, body: signalBody });
export const signalFrom = v.strictObject({ type: v.literal('signal'), from: session, body: signalBody });
