import { describe, expect, test } from 'vitest';
import { EstimatorSelector } from '../../../src/threepoint/api/estimator-selector';
import { defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { createEstimator, networkOf } from '../../../src/threepoint/core/estimation/estimators';
import type { PoseRegressor } from '../../../src/threepoint/core/estimation/networks/pose-regressor';
import {
  type EstimatorName,
  estimatorNames,
  type PoseEstimator,
} from '../../../src/threepoint/core/estimation/pose-estimator';
import { tracked } from '../core/estimation/moving-person';
import { openPlainModel } from '../core/estimation/shipped-models';

const head = tracked({ x: 0, y: 1.6, z: 0 });

/** A stand-in that draws nothing; its network is at fault when the regressor's provider says so. */
function estimatorOf(name: EstimatorName, _: unknown, network: PoseRegressor | null): PoseEstimator {
  if (!estimatorNames.includes(name)) return createEstimator(name, defaultCalibration);
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

function choiceThat(load: (name: 'paper' | 'learned') => Promise<PoseRegressor>, onChange = () => undefined) {
  const faults: string[] = [];
  const changes: string[] = [];
  const choice = new EstimatorSelector({
    estimator: 'ik',
    calibration: { eyeHeight: 1.6, armSpan: 1.4 },
    create: estimatorOf,
    load,
    onChange() {
      changes.push(`${choice.current.name} ${choice.regressor?.provider ?? 'alone'}`);
      onChange();
    },
    onUnavailable: (name, reason) => faults.push(`${name}: ${reason}`),
  });
  return { choice, faults, changes };
}

describe('the estimator that draws', () => {
  test('inverse kinematics draws while the network loads, then the network does', async () => {
    let arrive: (network: PoseRegressor) => void = () => undefined;
    const { choice, faults } = choiceThat(() => new Promise((resolve) => (arrive = resolve)));
    const chosen = choice.setEstimator('learned');
    expect([choice.selected, choice.current.name]).toEqual(['learned', 'ik']);
    arrive(networkOn('wasm'));
    await chosen;
    expect(choice.current.name).toBe('learned');
    expect(faults).toEqual([]);
  });

  test('the drawing estimator goes on where it is chosen again', async () => {
    const { choice } = choiceThat(async () => networkOn('wasm'));
    const { current } = choice;
    await choice.setEstimator('ik');
    expect(choice.current).toBe(current);
    await choice.setEstimator('learned');
    const learned = choice.current;
    await choice.setEstimator('learned');
    expect(choice.current).toBe(learned);
    await choice.setEstimator('ik');
    expect(choice.current).not.toBe(learned);
  });

  test('a network that cannot be loaded leaves inverse kinematics after another network, too', async () => {
    const { choice, changes } = choiceThat(async (name) => {
      if (name === 'paper') throw new Error('paper.onnx: 404');
      return networkOn('wasm');
    });
    await choice.setEstimator('learned');
    await choice.setEstimator('paper');
    expect([choice.selected, choice.current.name, choice.regressor]).toEqual(['ik', 'ik', null]);
    expect(changes).toEqual(['learned wasm', 'ik alone']);
  });

  test.each(['paper', 'device'] as const)('a network for another method is none for %s', async (name) => {
    const network = openPlainModel();
    const other =
      name === 'paper' ? network : { ...network, contract: { ...network.contract, name: 'paper' as const } };
    const faults: string[] = [];
    const choice = new EstimatorSelector({
      estimator: 'ik',
      calibration: defaultCalibration,
      create: createEstimator,
      load: async () => other,
      onChange: () => undefined,
      onUnavailable: (network, reason) => faults.push(`${network}: ${reason}`),
    });
    await choice.setEstimator(name);
    const needed = networkOf(name);
    expect([choice.selected, choice.current.name]).toEqual(name === 'paper' ? ['ik', 'ik'] : ['device', 'device']);
    expect(faults).toEqual([`${needed}: estimator “${needed}” needs the regressor of “${needed}”`]);
  });

  test('a failed network makes every method that needs it unavailable', async () => {
    const { choice, faults } = choiceThat(async () => Promise.reject(new Error('no such file')));
    await choice.setEstimator('paper-published');
    expect([choice.selected, choice.current.name]).toEqual(['ik', 'ik']);
    expect(choice.unavailable).toEqual({ paper: 'no such file', 'paper-published': 'no such file' });
    await choice.setEstimator('paper-published');
    await choice.setEstimator('paper');
    expect([choice.selected, choice.current.name]).toEqual(['ik', 'ik']);
    expect(faults).toEqual(['paper: no such file']);
  });

  test('a name of no estimator is refused in a sentence, and changes nothing', async () => {
    const { choice, changes } = choiceThat(async () => networkOn('wasm'));
    await choice.setEstimator('learned');
    const lerned = 'lerned' as EstimatorName;
    await expect(choice.setEstimator(lerned)).rejects.toThrow(
      '“lerned” is not an estimator. Use one of hands-only, ik',
    );
    expect([choice.selected, choice.current.name]).toEqual(['learned', 'learned']);
    expect(changes).toHaveLength(1);
  });

  test('a network that fails while it runs gives way to inverse kinematics, once', async () => {
    const { choice, faults, changes } = choiceThat(async () => networkOn('broken'));
    await choice.setEstimator('learned');
    expect(choice.current.name).toBe('learned');
    choice.check();
    choice.check();
    await choice.setEstimator('learned');
    expect(choice.current.name).toBe('ik');
    expect(faults).toEqual(['learned: out of memory']);
    expect(changes, 'each reported once').toEqual(['learned broken', 'ik alone']);
  });

  test.each([
    ['fails while it runs', async () => networkOn('broken'), 'out of memory'],
    [
      'cannot be loaded',
      async () => {
        throw new Error('404');
      },
      '404',
    ],
  ])('the device’s body is drawn without its network where that %s', async (_, load, reason) => {
    const { choice, faults } = choiceThat(load);
    await choice.setEstimator('device');
    choice.check();
    choice.check();
    expect([choice.selected, choice.current.name, choice.regressor]).toEqual(['device', 'device', null]);
    expect(choice.unavailable).toEqual({ learned: reason });
    expect(faults).toEqual([`learned: ${reason}`]);
    await choice.setEstimator('ik');
    await choice.setEstimator('device');
    choice.check();
    expect([choice.current.name, choice.regressor], 'and chosen again').toEqual(['device', null]);
    expect(faults).toHaveLength(1);
  });

  test('an exception of a listener is no fault of the network', async () => {
    const { choice, faults } = choiceThat(
      async () => networkOn('wasm'),
      () => {
        throw new Error('a bug of the page');
      },
    );
    await expect(choice.setEstimator('learned')).rejects.toThrow('a bug of the page');
    expect([choice.selected, choice.current.name, choice.regressor?.provider]).toEqual(['learned', 'learned', 'wasm']);
    expect([choice.unavailable, faults]).toEqual([{}, []]);
  });

  test('every network is let go, also after one that cannot be', async () => {
    const letGo: string[] = [];
    const { choice } = choiceThat(async (name) => ({
      ...networkOn('webgpu'),
      async dispose() {
        letGo.push(name);
        if (name === 'learned') throw new Error('the device is lost');
      },
    }));
    await choice.setEstimator('learned');
    await choice.setEstimator('paper');
    await expect(choice.dispose()).rejects.toThrow('the device is lost');
    expect(letGo).toEqual(['learned', 'paper']);
  });

  test('a person who changes their mind while a network loads keeps the later choice', async () => {
    let arrive: (network: PoseRegressor) => void = () => undefined;
    const { choice } = choiceThat(() => new Promise((resolve) => (arrive = resolve)));
    const first = choice.setEstimator('paper');
    await choice.setEstimator('hands-only');
    arrive(networkOn('wasm'));
    await first;
    expect(choice.current.name).toBe('hands-only');
  });
});
