import { checked, numberBetween, text, ValidationError } from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import { languageTag } from '../phrases/localized-text';

export const consentSchema = v.object({
  /** The version of the text that was shown. */
  version: text(40),
  given: v.literal(true, 'nothing is recorded without consent'),
  /** Whether tracking frames may be kept. */
  motion: v.boolean('expected true or false'),
  /** The time on the participant's device, in seconds since 1970. */
  at: numberBetween(0, 1e11),
  /** The language of the text; absent: the study has only one. */
  language: v.exactOptional(languageTag),
});

/** The consent to a version of the text. A refusal is not recorded. */
export type Consent = v.InferOutput<typeof consentSchema>;

/**
 * Returns a valid consent; throws a ValidationError that names the field, also if the version is not that of the plan.
 */
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
