import { describe, expect, test } from 'vitest';
import { estimatedJoints } from '../../../../src/threepoint/core/body/joints';
import { learnedInputCount } from '../../../../src/threepoint/core/estimation/methods/residual';
import { type GoldenModel, readGolden } from './golden';
import { type NetworkName, openShippedModel } from './shipped-models';

const golden = readGolden<Record<NetworkName, GoldenModel>>('models.json');

describe.each(['paper', 'learned'] as const)('the shipped %s model', (name) => {
  test('is the one that Python ran, and answers the same to its tolerance', async () => {
    const regressor = await openShippedModel(name);
    const { sha256, tolerance, cases } = golden[name];
    expect(regressor.contract.sha256).toBe(sha256);
    expect(tolerance).toBeLessThanOrEqual(1e-3);
    expect(cases.length).toBeGreaterThan(10);
    for (const { input, output } of cases) {
      const ours = await regressor.run(Float32Array.from(input));
      expect(ours.length).toBe(output.length);
      output.forEach((expected, i) => {
        expect(Math.abs(ours[i]! - expected), `output ${i}`).toBeLessThanOrEqual(tolerance);
      });
    }
    await regressor.dispose();
  });

  test('takes and gives what its contract says, and the contract what the page computes', async () => {
    const { contract } = await openShippedModel(name);
    const size = (shape: readonly number[]) => shape.reduce((product, length) => product * length, 1);
    expect(contract.name).toBe(name);
    expect(contract.windowSeconds[0]).toBe(0);
    expect(contract.windowSeconds).toEqual([...contract.windowSeconds].sort((a, b) => a - b));
    const window = contract.windowSeconds;
    expect(size(contract.inputs[0]!.shape)).toBe(name === 'paper' ? 18 : learnedInputCount(window));
    expect(size(contract.outputs[0]!.shape)).toBe(3 * estimatedJoints.length);
    expect(contract.inputs[0]!.frame).toBe('heading');
    expect(contract.outputs[0]!.frame).toBe(name === 'paper' ? 'heading' : 'chest');
  });
});
