import { describe, expect, test } from 'vitest';
import { type AvatarPose, copyAvatarPose } from '../../../../src/threepoint/core/body/avatar-pose';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { jointNames } from '../../../../src/threepoint/core/body/joints';
import { skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { createEstimator, needsRegressor } from '../../../../src/threepoint/core/estimation/estimators';
import type { PoseRegressor } from '../../../../src/threepoint/core/estimation/networks/pose-regressor';
import type { Pipeline } from '../../../../src/threepoint/core/estimation/pipeline';
import { createWithNetwork } from '../../../../src/threepoint/core/estimation/with-network';
import { distance } from '../../../../src/threepoint/core/math/vec3';
import { reportFigures } from '../../../reliability/report-figures';
import { numbersIn } from '../numbers-in';
import { poseOf, show, showAll } from './drawn';
import { movingPerson } from './moving-person';
import { openShippedModel } from './shipped-models';

const calibration = { eyeHeight: 1.65, armSpan: 1.56 };
const at = movingPerson(7, calibration, { x: 1, z: -0.5, yaw: 2 });
/** Frames with gaps that make the learned method request each of them too. */
const frames = Array.from({ length: 90 }, (_, i) => at(3 + i / 30));

const apart = (a: AvatarPose, b: AvatarPose): number => {
  const [first, second] = [a, b].map(({ body }) => forwardKinematics(skeletonFromCalibration(calibration), body!));
  return Math.max(...jointNames.map((joint) => distance(first![joint].position, second![joint].position)));
};

const ikPose = (count: number): AvatarPose => {
  const ik = createEstimator('ik', calibration);
  return frames.slice(0, count).map((frame) => poseOf(ik, frame))[count - 1]!;
};

/** The newest answer of its network as joints; null: there is none. */
const answerOf = ({ source, state }: Pipeline) => source.network!.answer(state.solved);

/** A network that breaks in its own way from some run on. */
const breaking = (
  shipped: PoseRegressor,
  fromRun: number,
  broken: (output: Float32Array) => Promise<Float32Array>,
): PoseRegressor => {
  let run = 0;
  return {
    ...shipped,
    async run(features) {
      const output = await shipped.run(features);
      run += 1;
      return run > fromRun ? broken(output) : output;
    },
  };
};

const ways: [string, (output: Float32Array) => Promise<Float32Array>, RegExp][] = [
  ['rejects', () => Promise.reject(new Error('out of memory')), /out of memory/],
  ['throws a string', () => Promise.reject('lost the device'), /lost the device/],
  ['answers with NaN', (output) => Promise.resolve(output.map((v, i) => (i === 4 ? Number.NaN : v))), /not finite/],
  ['answers with infinity', (output) => Promise.resolve(output.map(() => Infinity)), /not finite/],
  ['answers too little', (output) => Promise.resolve(output.slice(0, 3)), /3 numbers/],
];

describe.each(['paper', 'learned'] as const)('%s with a failing network', (name) => {
  test.each(ways)('draws IK’s body and names the network in a sentence when it %s', async (_, way, sentence) => {
    const estimator = createWithNetwork(name, calibration, breaking(await openShippedModel(name), 0, way));
    const pose = await showAll(estimator, frames.slice(0, 5));
    expect(apart(pose, ikPose(5))).toBeLessThan(1e-9);
    expect(estimator.fault()).toMatch(sentence);
    expect(estimator.fault()).toContain(name);
    expect(answerOf(estimator)).toBeNull();
  });

  test.each(ways)('goes over to IK with finite bones in the frame after it %s', async (_, way) => {
    const estimator = createWithNetwork(name, calibration, breaking(await openShippedModel(name), 30, way));
    let pose: AvatarPose | null = null;
    const faulty: boolean[] = [];
    for (const frame of frames) {
      pose = await show(estimator, frame);
      expect(numbersIn(pose.body).every(Number.isFinite)).toBe(true);
      faulty.push(estimator.fault() !== null);
    }
    expect(faulty).toEqual(frames.map((_, i) => i >= 30));
    // A second after the fault nothing of the network is left, but for where the elbow's memory began.
    expect(apart(pose!, ikPose(frames.length))).toBeLessThan(1e-3);
    reportFigures('bad-model', { 'bones NaN': 0, 'fault known after': `${faulty.indexOf(true) - 29} frame` });
  });

  test('forgets the fault when the network recovers', async () => {
    let run = 0;
    const shipped = await openShippedModel(name);
    const estimator = createWithNetwork(name, calibration, {
      ...shipped,
      run: (features) => (run++ === 0 ? Promise.reject(new Error('cold')) : shipped.run(features)),
    });
    await show(estimator, frames[0]!);
    expect(estimator.fault()).not.toBeNull();
    await show(estimator, frames[1]!);
    expect(estimator.fault()).toBeNull();
    expect(answerOf(estimator)).not.toBeNull();
  });
});

describe.each(['paper', 'learned'] as const)('%s with a slow network', (name) => {
  test('never runs it twice at once, never waits for it, and uses what has finished', async () => {
    const shipped = await openShippedModel(name);
    let running = 0;
    let started = 0;
    let finish: (() => void) | null = null;
    const estimator = createWithNetwork(name, calibration, {
      ...shipped,
      async run(features) {
        running += 1;
        started += 1;
        expect(running).toBe(1);
        const output = await shipped.run(features);
        await new Promise<void>((resolve) => {
          finish = resolve;
        });
        running -= 1;
        return output;
      },
    });
    const first = estimator.update(frames[0]!).request!.ask();
    const { pose, request } = estimator.update(frames[1]!);
    expect(apart(copyAvatarPose(pose), ikPose(2))).toBeLessThan(1e-9);
    const second = request!.ask();
    expect(answerOf(estimator)).toBeNull();
    await expect.poll(() => finish).not.toBeNull();
    finish!();
    await Promise.all([first, second]);
    expect(started).toBe(1);
    expect(answerOf(estimator)).not.toBeNull();
    finish = null;
    const drawn = estimator.update(frames[2]!);
    expect(drawn.pose.head).toEqual(frames[2]!.head);
    expect(apart(copyAvatarPose(drawn.pose), ikPose(3))).toBeGreaterThan(1e-4);
    const third = drawn.request!.ask();
    expect(started).toBe(2);
    await expect.poll(() => finish).not.toBeNull();
    finish!();
    await third;
  });

  test('forgets a run that a reset overtook', async () => {
    const shipped = await openShippedModel(name);
    const estimator = createWithNetwork(name, calibration, shipped);
    const running = estimator.update(frames[0]!).request!.ask();
    estimator.reset();
    await running;
    expect(answerOf(estimator)).toBeNull();
    expect(estimator.fault()).toBeNull();
  });
});

describe('the choice of an estimator', () => {
  test('a network’s estimator without its network is refused at once', async () => {
    const paper = await openShippedModel('paper');
    expect(() => createEstimator('learned', calibration)).toThrow(/learned/);
    expect(() => createEstimator('learned', calibration, paper)).toThrow(/learned/);
    expect(createEstimator('paper', calibration, paper).name).toBe('paper');
    expect([needsRegressor('ik'), needsRegressor('hands-only'), needsRegressor('learned')]).toEqual([
      false,
      false,
      true,
    ]);
  });
});
