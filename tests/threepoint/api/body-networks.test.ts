import { describe, expect, test, vi } from 'vitest';
import { Body } from '../../../src/threepoint/api/body';
import type { PoseRegressor } from '../../../src/threepoint/core/estimation/networks/pose-regressor';
import { openPlainModel } from '../core/estimation/shipped-models';
import { at, calibration, observed } from './observed-body';
import { openPorts } from './open-ports';

describe('a body whose network is unavailable', () => {
  test('is drawn by inverse kinematics, and says why', async () => {
    const { body, reported } = await observed({ networks: async () => Promise.reject(new Error('learned.bin: gone')) });
    expect(reported).toEqual(['fallback learned learned.bin: gone']);
    expect([body.selectedEstimator, body.unavailableEstimators]).toEqual(['ik', { learned: 'learned.bin: gone' }]);
    expect(body.update(at(0))?.body).not.toBeNull();
    expect(body.estimator).toBe('ik');
  });

  test('warns once with reason and remedy where the page handles no fallback', async () => {
    const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
    const body = new Body({ networks: async () => Promise.reject(new Error('learned.bin: gone')) });
    await body.setEstimator('learned').catch(() => undefined);
    body.update(at(0));
    body.update(at(1 / 30));
    expect(warn.mock.calls).toEqual([
      [
        expect.stringMatching(
          /“learned”: learned\.bin: gone\. To report it yourself, prevent the default of “fallback”\./,
        ),
      ],
    ]);
  });

  test('goes over to it when the network breaks in a frame', async () => {
    const plain = openPlainModel();
    let broken = false;
    const runNow = (features: Float32Array) => {
      if (broken) throw new Error('out of memory');
      return plain.runNow!(features);
    };
    const { body, reported } = await observed({ calibration, networks: async () => ({ ...plain, runNow }) });
    body.update(at(0));
    expect(body.estimator).toBe('learned');
    broken = true;
    body.update(at(1 / 30));
    expect(body.estimator).toBe('ik');
    expect(reported.at(-1)).toBe('fallback learned learned: out of memory');
  });

  test('the paper’s network asks for a runtime', async () => {
    const reported: string[] = [];
    const body = new Body({ estimator: 'ik' });
    body.addEventListener('fallback', (event) => {
      event.preventDefault();
      reported.push(`${event.estimator} ${event.reason}`);
    });
    // reason: what a page without types may pass
    await body.setEstimator('paper' as 'learned');
    expect(reported).toEqual([expect.stringMatching(/^paper .*onnxNetworks/)]);
    expect(body.estimator).toBe('ik');
  });
});

/** The learned network as a runtime brings it: it answers later, and `begun` is what it does before. */
function answeringLater(begun: () => void = () => undefined) {
  const plain = openPlainModel();
  const disposed: string[] = [];
  const network = (name: string): PoseRegressor => ({
    contract: { ...plain.contract, name: name as 'learned' },
    provider: 'later',
    async run(features) {
      begun();
      await Promise.resolve();
      return plain.run(features);
    },
    dispose: async () => void disposed.push(name),
  });
  return { network, disposed };
}

describe('a network that answers later', () => {
  test('is asked once a frame is over, about the newest frame alone', async () => {
    let runs = 0;
    const { network } = answeringLater(() => {
      runs += 1;
    });
    const { body } = await observed({ calibration, networks: async (name) => network(name) });
    for (let frame = 0; frame < 3; frame++) body.update(at(frame / 60));
    await Promise.resolve();
    expect(runs, 'nothing within the frame, nor in its microtasks').toBe(0);
    await expect.poll(() => runs).toBe(1);
    expect(body.provider).toBe('later');
  });

  test('is not asked about a frame from before a jump', async () => {
    let runs = 0;
    const { network } = answeringLater(() => {
      runs += 1;
    });
    const { body } = await observed({ calibration, networks: async (name) => network(name) });
    body.update(at(0));
    body.discontinuity();
    for (let turn = 0; turn < 3; turn++) await new Promise((resolve) => setTimeout(resolve, 0));
    expect(runs).toBe(0);
    body.update(at(1 / 60));
    await expect.poll(() => runs).toBe(1);
  });

  test('is measured where a page measures: features until it is asked, inference until it waits', async () => {
    const marks: string[] = [];
    const { network } = answeringLater(() => void marks.push('runs'));
    const { body } = await observed({
      calibration,
      networks: async (name) => network(name),
      profiler: { resume: () => void marks.push('resume'), mark: (part) => void marks.push(part) },
    });
    body.update(at(0));
    expect(marks, 'nothing of it lies in the frame').toEqual([]);
    await expect.poll(() => marks).toEqual(['resume', 'features', 'runs', 'inference', 'features']);
  });

  test('leaves nothing that keeps a process running once its body is disposed of', async () => {
    const open = openPorts();
    const { network } = answeringLater();
    const { body } = await observed({ calibration, networks: async (name) => network(name) });
    body.update(at(0));
    expect(openPorts()).toBeGreaterThan(open);
    await body.dispose();
    const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
    body.update(at(1 / 60));
    warn.mockRestore();
    await expect.poll(openPorts).toBe(open);
  });

  test('is released with the body, as are one chosen before and one still on its way', async () => {
    const { network, disposed } = answeringLater();
    let arrive: () => void = () => undefined;
    const arriving = new Promise<void>((resolve) => {
      arrive = resolve;
    });
    const { body, reported } = await observed({
      calibration,
      async networks(name) {
        if (name === 'paper') await arriving;
        return network(name);
      },
    });
    await body.setEstimator('ik');
    const chosen = body.setEstimator('paper');
    const over = body.dispose();
    arrive();
    await Promise.all([chosen, over]);
    expect(disposed.toSorted()).toEqual(['learned', 'paper']);
    expect(body.estimator).toBe('ik');
    expect(reported).toEqual([]);
  });
});
