import { describe, expect, test } from 'vitest';
import type { EstimatorName, PoseEstimator } from '../../src/core/estimation/pose-estimator';
import type { PoseRegressor } from '../../src/core/estimation/pose-regressor';
import { EstimatorChoice } from '../../src/lib/estimator-choice';

const head = {
  position: { x: 0, y: 1.6, z: 0 },
  orientation: { x: 0, y: 0, z: 0, w: 1 },
  tracking: 'tracked',
} as const;

/** A stand-in that draws nothing; its network is at fault when the regressor's provider says so. */
function estimatorOf(name: EstimatorName, _: unknown, network?: PoseRegressor): PoseEstimator {
  return {
    name,
    calibrate: () => undefined,
    reset: () => undefined,
    update: () => ({ pose: { head, leftHand: null, rightHand: null, body: null }, request: null }),
    fault: () => (network?.provider === 'broken' ? 'out of memory' : null),
  };
}

function networkOn(provider: string): PoseRegressor {
  return {
    // reason: the choice of an estimator reads nothing of the contract
    contract: {} as PoseRegressor['contract'],
    provider,
    run: async () => new Float32Array(18),
    dispose: async () => undefined,
  };
}

function choiceThat(load: (name: 'paper' | 'learned') => Promise<PoseRegressor>) {
  const faults: string[] = [];
  const choice = new EstimatorChoice({
    calibration: { eyeHeight: 1.6, armSpan: 1.4 },
    create: estimatorOf,
    load,
    onChange: () => undefined,
    onFault: (name, reason) => faults.push(`${name}: ${reason}`),
  });
  return { choice, faults };
}

describe('which estimator draws', () => {
  test('inverse kinematics draws while the network loads, then the network does', async () => {
    let arrive: (network: PoseRegressor) => void = () => undefined;
    const { choice, faults } = choiceThat(() => new Promise((resolve) => (arrive = resolve)));
    const chosen = choice.choose('learned');
    expect([choice.wanted, choice.current.name]).toEqual(['learned', 'ik']);
    arrive(networkOn('wasm'));
    await chosen;
    expect(choice.current.name).toBe('learned');
    expect(faults).toEqual([]);
  });

  test('a network that cannot be loaded leaves inverse kinematics, with the reason', async () => {
    const { choice, faults } = choiceThat(async () => {
      throw new Error('learned.onnx: 404');
    });
    await choice.choose('learned');
    expect([choice.wanted, choice.current.name]).toEqual(['ik', 'ik']);
    expect(choice.unavailable.learned).toBe('learned.onnx: 404');
    expect(faults).toEqual(['learned: learned.onnx: 404']);
  });

  test('a network that fails while it runs gives way to inverse kinematics, once', async () => {
    const { choice, faults } = choiceThat(async () => networkOn('broken'));
    await choice.choose('learned');
    expect(choice.current.name).toBe('learned');
    choice.check();
    choice.check();
    await choice.choose('learned');
    expect(choice.current.name).toBe('ik');
    expect(faults).toEqual(['learned: out of memory']);
  });

  test('a person who changes their mind while a network loads keeps the later choice', async () => {
    let arrive: (network: PoseRegressor) => void = () => undefined;
    const { choice } = choiceThat(() => new Promise((resolve) => (arrive = resolve)));
    const first = choice.choose('paper');
    await choice.choose('hands-only');
    arrive(networkOn('wasm'));
    await first;
    expect(choice.current.name).toBe('hands-only');
  });
});
