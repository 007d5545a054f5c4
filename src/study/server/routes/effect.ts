/** The effect of a request. A participant withdraws, an experimenter deletes. */
export type Effect = 'reads' | 'stores' | 'deletes' | 'withdraws';

/** What a request that failed has not done, and what its sender can do, after the cause; the ends of sentences. */
const notDone = {
  reads: '. Try again later',
  stores: ': nothing was stored',
  deletes: ': nothing was deleted yet. Try again later',
  withdraws: ': nothing was deleted yet. Try again later, or ask the experimenter',
} as const satisfies Record<Effect, string>;

/** What is unknown about a request that may have been done, and what its sender can do. */
const unknown = {
  reads: '. Try again later',
  stores: ', and it is unknown whether this was stored. Send it again',
  deletes: ', and it is unknown whether this was deleted. Try again',
  withdraws: ', and it is unknown whether this was deleted. Send the code again, or ask the experimenter',
} as const satisfies Record<Effect, string>;

/** Returns a sentence about a request that was not done, or of which this is unknown, because of `cause`. */
export const failureSentence = (cause: string, effect: Effect, isKnown: boolean): string =>
  `${cause}${(isKnown ? notDone : unknown)[effect]}`;
