import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import { type WorldName, worldNames } from './headset-report';

/** The quantity that a step measures. */
export type Measured =
  | { readonly kind: 'nothing' }
  | { readonly kind: 'noise' }
  | { readonly kind: 'losses' }
  | { readonly kind: 'body' }
  | { readonly kind: 'frames'; readonly world: WorldName; readonly estimator: EstimatorName };

/** One step of the check. */
export interface CheckStep {
  readonly title: string;
  /** What the person is asked to do, spoken and shown. Steps in a row with the same sentence say it once. */
  readonly sentence: string;
  /** Time for the sentence and for what begins [s]; nothing of it counts. */
  readonly leadSeconds: number;
  /** The time that counts [s]. */
  readonly seconds: number;
  readonly measured: Measured;
}

const step = (
  title: string,
  sentence: string,
  [leadSeconds, seconds]: readonly [number, number],
  measured: Measured,
) => ({
  title,
  sentence,
  leadSeconds,
  seconds,
  measured,
});

const worldSentences: Readonly<Record<WorldName, string>> = {
  mirror: 'This is the mirror. Look around slowly and move your arms.',
  archery: 'This is the archery range. Look around slowly and move your arms.',
  ball: 'This is the ball court with three players. Look around slowly and move your arms.',
};
const worldTitles: Readonly<Record<WorldName, string>> = {
  mirror: 'Frames: mirror',
  archery: 'Frames: archery',
  ball: 'Frames: ball court',
};

/** The longest lead is the first of a world, whose materials are compiled then [s]. */
const [worldLead, estimatorLead, countedFrames] = [4, 0.7, 2.5];

/** The steps before the device's body is known to be there or not. */
export const openingSteps: readonly CheckStep[] = [
  step('Welcome', 'Stand upright, look ahead, and take both controllers or show both hands.', [5, 0], {
    kind: 'nothing',
  }),
  step('Noise at rest', 'Hold your head and both hands still, in front of your chest.', [4, 14], { kind: 'noise' }),
  step('Lost hands', 'Wave both hands fast. Hide them behind your back, and bring them back. Repeat.', [4, 20], {
    kind: 'losses',
  }),
];

const bodyStep = step('Body tracking', 'Move your arms slowly: to your hips, ahead, up, and to the sides.', [3, 12], {
  kind: 'body',
});

const worldSteps = (world: WorldName, estimators: readonly EstimatorName[]): readonly CheckStep[] =>
  estimators.map((estimator, index) =>
    step(worldTitles[world], worldSentences[world], [index === 0 ? worldLead : estimatorLead, countedFrames], {
      kind: 'frames',
      world,
      estimator,
    }),
  );

const lastStep = step('Done', 'Thank you. Take the headset off: the page shows your card.', [4, 0], {
  kind: 'nothing',
});

/** Returns the steps after those; `deviceBody`: the device reports a body. */
export function remainingSteps(deviceBody: boolean): readonly CheckStep[] {
  const estimators: readonly EstimatorName[] = [
    'learned',
    'ik',
    'paper',
    'hands-only',
    ...(deviceBody ? ['device' as const] : []),
  ];
  return [...(deviceBody ? [bodyStep] : []), ...worldNames.flatMap((world) => worldSteps(world, estimators)), lastStep];
}
