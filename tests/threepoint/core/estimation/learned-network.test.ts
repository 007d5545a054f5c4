import fc from 'fast-check';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { createEstimator } from '../../../../src/threepoint/core/estimation/estimators';
import { createPlainRegressor } from '../../../../src/threepoint/core/estimation/networks/learned-network';
import type { PoseRegressor } from '../../../../src/threepoint/core/estimation/networks/pose-regressor';
import { movingPerson } from './moving-person';
import { openPlainModel, openShippedModel, readShipped } from './shipped-models';

/**
 * How far the forward pass may be from onnxruntime [eye heights]. Weights are the same 32-bit numbers in both, the
 * 8-bit levels times their scale; what differs is the order and width of sums and the exponential.
 */
const tolerance = 1e-5;

const furthest = (a: ArrayLike<number>, b: ArrayLike<number>): number =>
  Math.max(...Array.from(a, (value, index) => Math.abs(value - b[index]!)));

describe('the learned network without a runtime', () => {
  const plain = openPlainModel();
  let runtime: PoseRegressor | null = null;
  beforeAll(async () => {
    runtime = await openShippedModel('learned');
  });
  afterAll(() => runtime?.dispose());

  test('gives what onnxruntime gives for any features, far outside those of people too', async () => {
    const length = plain.contract.inputs[0]!.shape.at(-1)!;
    const features = fc
      .array(fc.float({ min: -2, max: 2, noNaN: true }), { minLength: length, maxLength: length })
      .chain((numbers) => fc.constantFrom(0, 0.2, 1, 30).map((size) => Float32Array.from(numbers, (n) => n * size)));
    await fc.assert(
      fc.asyncProperty(features, async (input) => {
        const [ours, theirs] = [await plain.run(input), await runtime!.run(input)];
        // Corrections of bodies that no one has may be large; rounding grows with them.
        const largest = Math.max(1, ...theirs.map(Math.abs));
        expect(furthest(ours, theirs)).toBeLessThan(tolerance * largest);
      }),
    );
  });

  test('answers within its frame, leaving no question, and draws another body than inverse kinematics', () => {
    const calibration = { eyeHeight: 1.65, armSpan: 1.56 };
    const at = movingPerson(3, calibration, { x: 1, z: -0.5, yaw: 2 });
    const [estimator, ik] = [createEstimator('learned', calibration, plain), createEstimator('ik', calibration)];
    let drawn = '';
    let drawnByIk = '';
    for (let frame = 0; frame < 3; frame++) {
      const { pose, request } = estimator.update(at(frame / 60));
      expect(request).toBeNull();
      drawn = JSON.stringify(pose.body);
      drawnByIk = JSON.stringify(ik.update(at(frame / 60)).pose.body);
    }
    expect(estimator.fault()).toBeNull();
    expect(drawn).not.toBe(drawnByIk);
  });

  test.each([
    ['later', false],
    ['in the frame', true],
  ])('is asked about every frame when it answers %s', async (_, inFrame) => {
    const calibration = { eyeHeight: 1.65, armSpan: 1.56 };
    const at = movingPerson(3, calibration, { x: 1, z: -0.5, yaw: 2 });
    let runs = 0;
    const counted = <Result>(run: (features: Float32Array) => Result) => {
      return (features: Float32Array): Result => {
        runs += 1;
        return run(features);
      };
    };
    const { runNow, ...later } = plain;
    const estimator = createEstimator('learned', calibration, {
      ...later,
      run: counted(later.run),
      ...(inFrame && { runNow: counted(runNow!) }),
    });
    for (const rate of [36, 60, 72, 80, 90, 120]) {
      estimator.reset();
      runs = 0;
      for (let frame = 0; frame < 30; frame++) await estimator.update(at(frame / rate)).request?.ask();
      expect(runs).toBe(30);
    }
    estimator.update(at(1));
    estimator.reset();
    runs = 0;
    await estimator.update(at(1.001)).request?.ask();
    expect(runs).toBe(1);
  });

  test('may be an object with memory of its own, as those of a class are', () => {
    const { contract, provider, run, dispose } = plain;
    const own = {
      ...{ contract, provider, run, dispose, network: plain },
      runNow(features: Float32Array) {
        return this.network.runNow!(features);
      },
    };
    const calibration = { eyeHeight: 1.65, armSpan: 1.56 };
    const estimator = createEstimator('learned', calibration, own);
    estimator.update(movingPerson(7, calibration, { x: 1, z: -0.5, yaw: 2 })(3));
    expect(estimator.fault()).toBeNull();
  });

  test('a network that breaks in a frame leaves that frame to inverse kinematics and says so', () => {
    const calibration = { eyeHeight: 1.65, armSpan: 1.56 };
    const at = movingPerson(3, calibration, { x: 1, z: -0.5, yaw: 2 });
    const ways: [(features: Float32Array) => Float32Array, RegExp][] = [
      [(features) => plain.runNow!(features).map(() => Number.NaN), /^learned: .*not finite/],
      [(features) => plain.runNow!(features).slice(0, 3), /^learned: 3 numbers/],
      [
        () => {
          throw new Error('out of memory');
        },
        /^learned: out of memory/,
      ],
    ];
    for (const [runNow, sentence] of ways) {
      const estimator = createEstimator('learned', calibration, { ...plain, runNow });
      const ik = createEstimator('ik', calibration);
      const drawn = JSON.stringify(estimator.update(at(1)).pose.body);
      expect(drawn).toBe(JSON.stringify(ik.update(at(1)).pose.body));
      expect(estimator.fault()).toMatch(sentence);
    }
  });
});

describe('weights that do not go with their contract', () => {
  const { contract, bytes } = readShipped('learned', 'weights');
  const weights = contract.weights!;
  const features = contract.inputs[0]!.shape.at(-1);
  const listed = (change: Record<string, string>) => ({
    ...contract,
    weights: { ...weights, tensors: { ...weights.tensors, ...change } },
  });

  test.each([
    ['too short', contract, bytes.subarray(0, 1000), /^learned\.bin: ends before /],
    ['too long', contract, Buffer.concat([bytes, Buffer.alloc(4)]), /^learned\.bin: \d+ bytes long, its tensors are /],
    ['a type that is none', listed({ 'arm.0.bias': 'float8 96' }), bytes, /^learned\.bin: arm\.0\.bias: “float8 96”/],
    [
      'another shape',
      listed({ 'trunk.0.levels': `int8 ${features} 192` }),
      bytes,
      new RegExp(`^trunk\\.0\\.levels is ${features} × 192, expected 192 × ${features}$`),
    ],
    ['no weights', { ...contract, weights: undefined } as never, bytes, /^learned\.json: names no weights/],
    ['numbers that are not finite', contract, Buffer.concat([Buffer.alloc(4, 255), bytes.subarray(4)]), /not finite$/],
  ])('%s', (_, changed, content, sentence) => {
    expect(() => createPlainRegressor(changed, content)).toThrow(sentence);
  });
});
