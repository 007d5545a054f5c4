import { reasonOf } from 'threepoint/core';
import { PhrasedError, type Phrases } from '../model/phrases/phrases';
import { refusals } from '../model/progress/apply-event';

/** Returns an error in the participant's language. Technical errors stay in English. */
export const localizedReason = (error: unknown, phrases: Phrases): string =>
  error instanceof PhrasedError ? error.in(phrases) : phrases.text('reason', { reason: reasonOf(error) });

/** Returns why a session refused an event, in the participant's language, or null. */
export function localizedRefusal(refusal: string | null, { text }: Phrases): string | null {
  if (refusal === null) return null;
  if (refusal === refusals.paused) return text('refused.paused');
  if (refusal === refusals.asked) return text('refused.asked');
  return text('reason', { reason: refusal });
}
