import { expect, test } from 'vitest';
import { type CheckStep, remainingSteps } from '../../../src/page/check/check-steps';
import { StepSequence } from '../../../src/page/check/step-sequence';

/** Runs a sequence at 72 Hz; returns what it called, with times [s], and how many frames counted for each kind. */
function run(remaining: () => readonly CheckStep[], pace: number) {
  const calls: string[] = [];
  const counted: Record<string, number> = {};
  let time = 0;
  const note = (what: string) => (step: CheckStep) => void calls.push(`${time.toFixed(1)} ${what} ${step.title}`);
  const sequence = new StepSequence({
    remaining,
    pace,
    listener: { begin: note('begin'), measure: note('measure'), end: note('end') },
  });
  for (let row = 0; !sequence.over && row < 72 * 600; row++) {
    time = 100 + row / 72;
    const kind = sequence.measured?.kind;
    if (kind) counted[kind] = (counted[kind] ?? 0) + 1;
    sequence.advance(time);
  }
  return { calls, counted, seconds: time - 100, steps: sequence.steps };
}

test('the whole check takes two minutes, with and without a body of the device', () => {
  expect(run(() => remainingSteps(false), 1).seconds).toBeLessThan(120);
  expect(run(() => remainingSteps(true), 1).seconds).toBeLessThan(140);
});

test('frames count after the lead of a step, and as long as it takes', () => {
  const { calls, counted } = run(() => remainingSteps(true), 1);
  expect(calls.slice(0, 8)).toEqual([
    '100.0 begin Welcome',
    '105.0 measure Welcome',
    '105.0 end Welcome',
    '105.0 begin Noise at rest',
    '109.0 measure Noise at rest',
    '123.0 end Noise at rest',
    '123.0 begin Lost hands',
    '127.0 measure Lost hands',
  ]);
  expect(Math.abs(counted.noise! / (14 * 72) - 1)).toBeLessThan(0.01);
  expect(Math.abs(counted.losses! / (20 * 72) - 1)).toBeLessThan(0.01);
});

test('the pace shortens leads and steps alike', () => {
  const [whole, quick] = [1, 0.25].map((pace) => run(() => remainingSteps(false), pace));
  expect(quick!.seconds / whole!.seconds).toBeCloseTo(0.25, 1);
  expect(quick!.steps).toEqual(whole!.steps);
});

test('a body that appears during the first steps adds its steps; a later one changes nothing', () => {
  let requests = 0;
  // The first request is for the preview, the second one follows the opening steps.
  const { steps } = run(() => remainingSteps(requests++ > 0), 0.1);
  expect(steps.map(({ measured }) => measured?.kind)).toContain('body');
  expect(requests).toBe(2);
});
