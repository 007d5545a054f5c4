import { expect, test, vi } from 'vitest';
import { defaultCalibration } from '../../src/core/body/calibration';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import type { Recording } from '../../src/core/tracking/recording';
import { Body } from '../../src/lib/body';
import { exportMotion } from '../../src/lib/export-motion';
import { loadLearned } from '../../src/lib/load-learned';

const models = new URL('../../public/models/', import.meta.url);

test('a program of Node has the learned network from the disk, without a word of where it lies', async () => {
  const told: string[] = [];
  const body = new Body({ events: { fallback: (_, reason) => told.push(reason) } });
  await body.choose('learned');
  expect(told).toEqual([]);
  expect([body.estimator, body.provider]).toEqual(['learned', 'plain']);
  await body.dispose();
});

test('a program of Node makes files of motion by the learned method, which is the default', async () => {
  const frames = Array.from({ length: 30 }, (_, i) => actorFrame(2 + i / 60, defaultCalibration));
  const recording: Recording = { device: 'actor', rateHz: 60, calibration: defaultCalibration, frames };
  const { parts } = await exportMotion(recording, { to: 'bvh' });
  expect(parts.join('')).toMatch(/^HIERARCHY/);
});

test('another contract may lie on the disk of a program of Node, its weights beside it', async () => {
  const shares: number[] = [];
  const modelUrl = new URL('learned.json', models);
  const regressor = await loadLearned({ modelUrl, onProgress: (share) => shares.push(share) });
  expect(regressor.provider).toBe('plain');
  expect(shares.at(-1)).toBe(1);
});

test('a contract that is not on the disk is told in a sentence', async () => {
  await expect(loadLearned({ modelUrl: new URL('gone.json', models) })).rejects.toThrow(
    /^gone\.json: could not be read \(ENOENT/,
  );
});

test('weights that cannot be checked, as on a page without https, are refused in a sentence', async () => {
  vi.stubGlobal('crypto', {});
  await expect(loadLearned()).rejects.toThrow(/^learned\.bin: cannot be checked: the page is not secure/);
});
