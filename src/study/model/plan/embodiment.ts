import { builtInBodies, maxLatencyMs, numberBetween, type ThreePointName, threePointNames } from 'threepoint/core';
import * as v from 'valibot';

export const estimatorSchema = v.picklist(threePointNames, `expected one of ${threePointNames.join(', ')}`);

const trueOrFalse = v.boolean('expected true or false');

/** The properties of a body that a condition or a cohort may set. */
export const embodimentFields = {
  estimator: v.exactOptional(estimatorSchema),
  avatar: v.exactOptional(v.picklist(builtInBodies, `expected one of ${builtInBodies.join(', ')}`)),
  /** Whether there is a mirror; a game may have none. */
  mirror: v.exactOptional(trueOrFalse),
  /** Whether the body ends at the hips. */
  upperBodyOnly: v.exactOptional(trueOrFalse),
  /** The additional latency of the body [ms]. */
  latencyMs: v.exactOptional(numberBetween(0, maxLatencyMs)),
  /** Noise on head and hands in every frame: standard deviation along and about each axis. */
  trackerNoise: v.exactOptional(
    v.strictObject({ positionMm: numberBetween(0, 100), rotationDegrees: numberBetween(0, 30) }),
  ),
  /** Random losses of each hand: their frequency and their duration. */
  dropouts: v.exactOptional(v.strictObject({ perMinute: numberBetween(0, 60), seconds: numberBetween(0.1, 10) })),
};

const fields = Object.keys(embodimentFields) as (keyof PartialEmbodiment)[];

/** The properties of a body that a condition or a cohort sets; others have the default of the page. */
export type PartialEmbodiment = v.InferOutput<v.StrictObjectSchema<typeof embodimentFields, undefined>>;

/** The body of a participant in a round. */
export type Embodiment = PartialEmbodiment & { readonly estimator: ThreePointName };

export const embodimentFieldsOf = (properties: PartialEmbodiment): readonly (keyof PartialEmbodiment)[] =>
  fields.filter((field) => properties[field] !== undefined);

/** Returns the properties of cohort and condition together; `checkedPlan` ensures that they include an estimator. */
export function embodimentOf(cohort: PartialEmbodiment, condition: PartialEmbodiment): Embodiment {
  const properties = [cohort, condition].flatMap((of) =>
    embodimentFieldsOf(of).map((field) => [field, of[field]] as const),
  );
  return Object.fromEntries(properties) as Embodiment;
}

/** Describes a body: "learned, 100 ms later, no mirror". */
export function embodimentInWords(properties: PartialEmbodiment): string {
  const { estimator, avatar, mirror, upperBodyOnly, latencyMs, trackerNoise: noise, dropouts } = properties;
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
