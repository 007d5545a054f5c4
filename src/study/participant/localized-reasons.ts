import { reasonOf } from 'threepoint/core';
import { PhrasedError, type Phrases } from '../model/phrases/phrases';
import { Rejection } from '../model/progress/rejection';

/** Returns an error in the participant's language. Technical errors stay in English. */
export function localizedReason(error: unknown, phrases: Phrases): string {
  if (error instanceof PhrasedError) return error.in(phrases);
  const phrase = error instanceof Rejection ? error.phrase : null;
  return phrase === null ? phrases.text('reason', { reason: reasonOf(error) }) : phrases.text(phrase);
}
