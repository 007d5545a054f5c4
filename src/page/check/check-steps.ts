import type { EstimatorName } from 'threepoint/core';
import { activities, home } from '../shell/activity-registry';
import type { WorldName } from './headset-report';

/** The quantity that the frames of a step measure. */
export type MeasuredQuantity =
  | { readonly kind: 'noise' | 'losses' | 'body' }
  | { readonly kind: 'frames'; readonly world: WorldName; readonly estimator: EstimatorName };

export interface CheckStep {
  readonly title: string;
  /** The instruction, spoken and shown. It is spoken once for successive steps that share it. */
  readonly sentence: string;
  /** The time for the instruction and for loading [s], which is not measured. */
  readonly leadSeconds: number;
  /** The measured time [s]. */
  readonly seconds: number;
  readonly measured: MeasuredQuantity | null;
}

const step = (
  title: string,
  sentence: string,
  [leadSeconds, seconds]: readonly [number, number],
  measured: MeasuredQuantity | null,
): CheckStep => ({ title, sentence, leadSeconds, seconds, measured });

/** The worlds in which frames are measured, in their order: the mirror, and every activity of the page. */
export const worlds: readonly { readonly name: WorldName; readonly title: string; readonly place: string }[] = [
  { name: home, title: 'Mirror', place: 'The mirror' },
  ...activities,
];

/** The leads of the first estimator in a world, whose materials are compiled then, and of the others [s]. */
const [worldLead, estimatorLead] = [4, 0.7];
/** The measured time of each estimator in each world [s]. */
const framesSeconds = 2.5;

/** The first steps, which also find out whether the device reports a body. */
export const openingSteps: readonly CheckStep[] = [
  step('Welcome', 'Stand upright, look ahead, and take both controllers or show both hands.', [5, 0], null),
  step('Noise at rest', 'Hold your head and both hands still, in front of your chest.', [4, 14], { kind: 'noise' }),
  step('Lost hands', 'Wave both hands fast. Hide them behind your back, and bring them back. Repeat.', [4, 20], {
    kind: 'losses',
  }),
];

const bodyStep = step('Body tracking', 'Move your arms slowly: to your hips, ahead, up, and to the sides.', [3, 12], {
  kind: 'body',
});

const worldSteps = (
  { name: world, title, place }: (typeof worlds)[number],
  estimators: readonly EstimatorName[],
): readonly CheckStep[] =>
  estimators.map((estimator, index) => ({
    title: `Frames: ${title}`,
    sentence: `This is ${place[0]!.toLowerCase()}${place.slice(1)}. Look around slowly and move your arms.`,
    leadSeconds: index === 0 ? worldLead : estimatorLead,
    seconds: framesSeconds,
    measured: { kind: 'frames', world, estimator },
  }));

const lastStep = step('Done', 'Thank you. Take the headset off: the page shows your card.', [4, 0], null);

/** Returns the steps after `openingSteps`. `deviceBody`: the device reports a body. */
export function remainingSteps(deviceBody: boolean): readonly CheckStep[] {
  const estimators: readonly EstimatorName[] = ['learned', 'ik', 'paper', 'hands-only'];
  const measured = deviceBody ? [...estimators, 'device' as const] : estimators;
  return [...(deviceBody ? [bodyStep] : []), ...worlds.flatMap((world) => worldSteps(world, measured)), lastStep];
}
