import { actorFrame, defaultCalibration, type Recording } from 'threepoint/core';
import { expect, test, vi } from 'vitest';
import { Body } from '../../../src/threepoint/api/body';
import { exportMotion } from '../../../src/threepoint/api/export-motion';
import { loadLearned } from '../../../src/threepoint/api/load-learned';

const models = new URL('../../../public/models/', import.meta.url);

test('a program of Node has the learned network from disk without giving its place', async () => {
  const reported: string[] = [];
  const body = new Body();
  body.addEventListener('fallback', ({ reason }) => reported.push(reason));
  await body.setEstimator('learned');
  expect(reported).toEqual([]);
  expect([body.estimator, body.provider]).toEqual(['learned', 'plain']);
  await body.dispose();
});

test('a program of Node makes files of motion by the learned method, which is the default', async () => {
  const frames = Array.from({ length: 30 }, (_, i) => actorFrame(2 + i / 60, defaultCalibration));
  const recording: Recording = { device: 'actor', rateHz: 60, calibration: defaultCalibration, frames };
  const { parts } = await exportMotion(recording, { format: 'bvh' });
  expect(parts.join('')).toMatch(/^HIERARCHY/);
});

test('another contract may lie on the disk of a program of Node, its weights beside it', async () => {
  const shares: number[] = [];
  const modelUrl = new URL('learned.json', models);
  const regressor = await loadLearned({ modelUrl, onProgress: (share) => shares.push(share) });
  expect(regressor.provider).toBe('plain');
  expect(shares.at(-1)).toBe(1);
});

test('a contract that is not on the disk is reported in a sentence', async () => {
  await expect(loadLearned({ modelUrl: new URL('gone.json', models) })).rejects.toThrow(
    /^gone\.json: could not be read \(ENOENT/,
  );
});

test('weights that could not be checked, as on pages without https, are refused in a sentence', async () => {
  vi.stubGlobal('crypto', {});
  await expect(loadLearned()).rejects.toThrow(/^learned\.bin: could not be checked: the page is not secure/);
});
