import { ownBodies } from 'threepoint/core/body/avatar-ref';
import { type ThreePointName, threePointNames } from 'threepoint/core/estimation/pose-estimator';
import { mostLatencyMs } from 'threepoint/core/tracking/tracking-degradation';
import { numberBetween } from 'threepoint/core/validation/validation';
import * as v from 'valibot';

/** A method by the name that plans call it. */
export const estimatorSchema = v.picklist(threePointNames, `expected one of ${threePointNames.join(', ')}`);

const trueOrFalse = v.boolean('expected true or false');

/** How a body is presented: what a condition, or a cohort, may say of it. */
export const embodimentFields = {
  /** The method that draws the body. */
  estimator: v.exactOptional(estimatorSchema),
  /** Which of our own bodies is worn. */
  avatar: v.exactOptional(v.picklist(ownBodies, `expected one of ${ownBodies.join(', ')}`)),
  /** Whether a mirror stands there; the ball game has none. */
  mirror: v.exactOptional(trueOrFalse),
  /** Whether the body ends at the hips. */
  upperBodyOnly: v.exactOptional(trueOrFalse),
  /** By how much the body follows its wearer later than it could [ms]. */
  latencyMs: v.exactOptional(numberBetween(0, mostLatencyMs)),
  /** Added to head and hands in every frame: standard deviation along and about each axis. */
  trackerNoise: v.exactOptional(
    v.strictObject({ positionMm: numberBetween(0, 100), rotationDegrees: numberBetween(0, 30) }),
  ),
  /** Each hand is lost so often, at random, for so long each time. */
  dropouts: v.exactOptional(v.strictObject({ perMinute: numberBetween(0, 60), seconds: numberBetween(0.1, 10) })),
};

const fields = Object.keys(embodimentFields) as (keyof PartialEmbodiment)[];

/** What a condition or a cohort says of the body; what neither says stays as the page has it. */
export type PartialEmbodiment = v.InferOutput<v.StrictObjectSchema<typeof embodimentFields, undefined>>;

/** How a participant is embodied in a round. */
export type Embodiment = PartialEmbodiment & { readonly estimator: ThreePointName };

/** The fields of the body that are said here. */
export const embodimentFieldsOf = (said: PartialEmbodiment): readonly (keyof PartialEmbodiment)[] =>
  fields.filter((field) => said[field] !== undefined);

/** What cohort and condition say together; an estimator is among it, as `checkedPlan` sees to. */
export function embodimentOf(cohort: PartialEmbodiment, condition: PartialEmbodiment): Embodiment {
  const said = [cohort, condition].flatMap((of) => embodimentFieldsOf(of).map((field) => [field, of[field]] as const));
  return Object.fromEntries(said) as Embodiment;
}

/** "learned, 100 ms later, no mirror". */
export function embodimentInWords(said: PartialEmbodiment): string {
  const { estimator, avatar, mirror, upperBodyOnly, latencyMs, trackerNoise: noise, dropouts } = said;
  return [
    estimator,
    avatar && `as ${avatar}`,
    mirror !== undefined && (mirror ? 'with a mirror' : 'without a mirror'),
    upperBodyOnly !== undefined && (upperBodyOnly ? 'upper body alone' : 'whole body'),
    latencyMs !== undefined && `${latencyMs} ms later`,
    noise && `noise of ${noise.positionMm} mm and ${noise.rotationDegrees}°`,
    dropouts && `hands lost ${dropouts.perMinute} times a minute for ${dropouts.seconds} s`,
  ]
    .filter(Boolean)
    .join(', ');
}
