import { defaultCalibration } from 'threepoint/core';
import type { TaskRunner } from 'threepoint-study/participant';
import type { PlayedStep } from '../../../src/study/model/plan/schedule';
import { PlayedTrial, type TrialHost, type TrialOptions } from '../../../src/study/participant/trial/study-trial';

interface TrialOfTest extends Partial<Pick<TrialHost, 'listenToFrames'>>, Partial<TrialOptions> {
  readonly task?: string;
  readonly seconds: number;
}

/** Returns a trial by `ik`, of archery unless stated, which this runner plays. */
export function trialOf(
  runner: TaskRunner,
  { task = 'archery', seconds, listenToFrames = () => undefined, ...options }: TrialOfTest,
): PlayedTrial {
  const step = { kind: 'trial', id: `${task}/1/trial-1`, task, embodiment: { estimator: 'ik' }, seconds };
  return new PlayedTrial(
    step as PlayedStep,
    runner,
    {
      calibration: () => defaultCalibration,
      device: () => ({ name: 'Test headset', refreshRateHz: 72, input: 'controllers' }),
      estimator: () => 'ik',
      listenToFrames,
    },
    { key: `${step.id}@1.1`, motion: true, seed: 3, now: () => 1e9, ...options },
  );
}
