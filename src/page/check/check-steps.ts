import type { EstimatorName } from 'threepoint/core';
import { type WorldName, worldNames } from './headset-report';

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

const worlds: Readonly<Record<WorldName, Pick<CheckStep, 'title' | 'sentence'>>> = {
  mirror: {
    title: 'Frames: mirror',
    sentence: 'This is the mirror. Look around slowly and move your arms.',
  },
  archery: {
    title: 'Frames: archery',
    sentence: 'This is the archery range. Look around slowly and move your arms.',
  },
  ball: {
    title: 'Frames: ball court',
    sentence: 'This is the ball court with three players. Look around slowly and move your arms.',
  },
};

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

const worldSteps = (world: WorldName, estimators: readonly EstimatorName[]): readonly CheckStep[] =>
  estimators.map((estimator, index) => ({
    ...worlds[world],
    leadSeconds: index === 0 ? worldLead : estimatorLead,
    seconds: framesSeconds,
    measured: { kind: 'frames', world, estimator },
  }));

const lastStep = step('Done', 'Thank you. Take the headset off: the page shows your card.', [4, 0], null);

/** Returns the steps after `openingSteps`. `deviceBody`: the device reports a body. */
export function remainingSteps(deviceBody: boolean): readonly CheckStep[] {
  const estimators: readonly EstimatorName[] = ['learned', 'ik', 'paper', 'hands-only'];
  const measured = deviceBody ? [...estimators, 'device' as const] : estimators;
  return [...(deviceBody ? [bodyStep] : []), ...worldNames.flatMap((world) => worldSteps(world, measured)), lastStep];
}
