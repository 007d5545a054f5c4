import { reasonOf } from 'threepoint/core/errors/reasons';
import { PhrasedError, type Phrases } from '../model/phrases/phrases';
import { refusals } from '../model/progress/advance';

/** What was thrown, for a participant to read; what has no words of its own is technical, and stays in English. */
export const reasonFor = (error: unknown, phrases: Phrases): string =>
  error instanceof PhrasedError ? error.in(phrases) : phrases.say('reason', { reason: reasonOf(error) });

/** Why a session did not take an event, for a participant to read; null: it did. */
export function refusalFor(refusal: string | null, { say }: Phrases): string | null {
  if (refusal === null) return null;
  if (refusal === refusals.paused) return say('refused.paused');
  if (refusal === refusals.asked) return say('refused.asked');
  return say('reason', { reason: refusal });
}
