import { checked, numberBetween, text, ValidationError } from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import { languageTag } from '../phrases/words';

const consentSchema = v.object({
  /** Of the text that was shown. */
  version: text(40),
  given: v.literal(true, 'nothing is recorded without consent'),
  /** Whether tracked frames may be kept as well. */
  motion: v.boolean('expected true or false'),
  /** Seconds since 1970, on the participant's device. */
  at: numberBetween(0, 1e11),
  /** In which the text was read; absent: the study has only one. */
  language: v.exactOptional(languageTag),
});

/** Consent to a text of a version; there is no record of a refusal, because then nothing is recorded. */
export type Consent = v.InferOutput<typeof consentSchema>;

/** Throws a ValidationError that names the field, also where the version is not the one of the plan. */
export function checkedConsent(value: unknown, version: string): Consent {
  const consent = checked(consentSchema, value);
  if (consent.version !== version) {
    throw new ValidationError(
      'version',
      `consent was given to text ${consent.version}, but the study shows ${version}`,
    );
  }
  return consent;
}
