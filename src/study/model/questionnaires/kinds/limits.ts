import { numberBetween } from 'threepoint/core';
import * as v from 'valibot';

/** The magnitude that no number of a questionnaire exceeds. */
export const limit = 1_000_000;
export const limitedNumber = numberBetween(-limit, limit);
export const flag = v.boolean('expected true or false');

/** The schema of names of questions and options, which are used in tables and in ids of the screen. */
export const code = v.pipe(
  v.string('expected text'),
  v.regex(
    /^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$/,
    'expected letters, digits, hyphens and underscores, at most 32, a letter or digit first',
  ),
);
