import { describe, expect, test } from 'vitest';
import type { AvatarPose } from '../../../src/core/body/avatar-pose';
import { forwardKinematics } from '../../../src/core/body/forward-kinematics';
import { jointNames } from '../../../src/core/body/joints';
import { skeletonFromCalibration } from '../../../src/core/body/skeleton';
import { createEstimator, needsRegressor } from '../../../src/core/estimation/estimators';
import type { PoseRegressor } from '../../../src/core/estimation/pose-regressor';
import { distance } from '../../../src/core/math/vec3';
import { movingPerson } from './moving-person';
import { openShippedModel } from './shipped-models';

const calibration = { eyeHeight: 1.65, armSpan: 1.56 };
const at = movingPerson(7, calibration, { x: 1, z: -0.5, yaw: 2 });
const frames = Array.from({ length: 90 }, (_, i) => at(3 + i / 60));

const apart = (a: AvatarPose, b: AvatarPose): number => {
  const [first, second] = [a, b].map(({ body }) => forwardKinematics(skeletonFromCalibration(calibration), body!));
  return Math.max(...jointNames.map((joint) => distance(first![joint].position, second![joint].position)));
};

const ikPose = (count: number): AvatarPose => {
  const ik = createEstimator('ik', calibration);
  return frames.slice(0, count).map((frame) => ik.estimate(frame))[count - 1]!;
};

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
  test.each(ways)('that %s: the body is IK’s, and a sentence names the network', async (_, way, sentence) => {
    const estimator = createEstimator(name, calibration, breaking(await openShippedModel(name), 0, way));
    let pose: AvatarPose | null = null;
    for (const frame of frames.slice(0, 5)) {
      await estimator.prepare(frame);
      pose = estimator.estimate(frame);
    }
    expect(apart(pose!, ikPose(5))).toBeLessThan(1e-9);
    expect(estimator.fault()).toMatch(sentence);
    expect(estimator.fault()).toContain(name);
    expect(estimator.rawJoints()).toBeNull();
  });

  test.each(ways)('that works for a while and then %s: the body goes over to IK', async (_, way) => {
    const estimator = createEstimator(name, calibration, breaking(await openShippedModel(name), 30, way));
    let pose: AvatarPose | null = null;
    for (const [i, frame] of frames.entries()) {
      await estimator.prepare(frame);
      pose = estimator.estimate(frame);
      expect(estimator.fault() === null).toBe(i < 30);
    }
    // A second after the fault nothing of the network is left, but for where the elbow's memory began.
    expect(apart(pose!, ikPose(frames.length))).toBeLessThan(1e-3);
  });

  test('that recovers: the fault is forgotten', async () => {
    let run = 0;
    const shipped = await openShippedModel(name);
    const estimator = createEstimator(name, calibration, {
      ...shipped,
      run: (features) => (run++ === 0 ? Promise.reject(new Error('cold')) : shipped.run(features)),
    });
    await estimator.prepare(frames[0]!);
    expect(estimator.fault()).not.toBeNull();
    await estimator.prepare(frames[1]!);
    expect(estimator.fault()).toBeNull();
    expect(estimator.rawJoints()).not.toBeNull();
  });
});

describe.each(['paper', 'learned'] as const)('%s with a slow network', (name) => {
  test('never runs it twice at once, never waits for it, and uses what has finished', async () => {
    const shipped = await openShippedModel(name);
    let running = 0;
    let started = 0;
    let finish: (() => void) | null = null;
    const estimator = createEstimator(name, calibration, {
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
    const first = estimator.prepare(frames[0]!);
    const second = estimator.prepare(frames[1]!);
    expect(apart(estimator.estimate(frames[1]!), ikPose(1))).toBeLessThan(0.2);
    expect(estimator.rawJoints()).toBeNull();
    await expect.poll(() => finish).not.toBeNull();
    finish!();
    await Promise.all([first, second]);
    expect(started).toBe(1);
    expect(estimator.rawJoints()).not.toBeNull();
    const third = estimator.prepare(frames[2]!);
    expect(started).toBe(2);
    expect(estimator.estimate(frames[2]!).head).toEqual(frames[2]!.head);
    finish = null;
    await expect.poll(() => finish).not.toBeNull();
    finish!();
    await third;
  });

  test('forgets a run that a reset overtook', async () => {
    const shipped = await openShippedModel(name);
    const estimator = createEstimator(name, calibration, shipped);
    const running = estimator.prepare(frames[0]!);
    estimator.reset();
    await running;
    expect(estimator.rawJoints()).toBeNull();
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
