import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { actorFrame, defaultCalibration, type PaperMethod } from 'threepoint/core';
import { expect, test } from 'vitest';
import { Body } from '../../../src/threepoint/api/body';
import { loadLearned } from '../../../src/threepoint/api/load-learned';
import { onnxNetworks } from '../../../src/threepoint/api/onnx';
import { answeringHost } from '../../rooms/client/answering-host';

/** Serves the networks until the test is over; returns their folder. */
async function servedModels(): Promise<string> {
  const { folder } = await answeringHost(({ url = '' }, response) => {
    const { pathname } = new URL(url, 'http://localhost');
    response.end(readFileSync(new URL(`../../../public/models/${basename(pathname)}`, import.meta.url)));
  });
  return folder;
}

test.each(['paper', 'learned'] as const)(
  'the runtime brings the %s network, whose answer a later frame draws',
  async (name) => {
    const models = await servedModels();
    const reported: string[] = [];
    const body = new Body({
      estimator: name,
      calibration: defaultCalibration,
      networks: onnxNetworks({ modelUrl: (network) => `${models}/${network}.json` }),
    });
    body.addEventListener('fallback', ({ reason }) => reported.push(reason));
    await body.setEstimator(name);
    expect(body.estimator).toBe(name);
    const ik = new Body({ estimator: 'ik', calibration: defaultCalibration });
    await ik.setEstimator('ik');
    const first = actorFrame(1, defaultCalibration);
    const chestOf = (drawn: Body | Body<PaperMethod>, time: number) => ({
      ...drawn.update({ ...first, time })!.body!.localRotations.chest,
    });
    expect(chestOf(body, 0)).toEqual(chestOf(ik, 0));
    let time = 0;
    // Frames go on until one differs from inverse kinematics: then the network has answered.
    await expect
      .poll(() => {
        time += 1 / 60;
        return JSON.stringify(chestOf(body, time)) === JSON.stringify(chestOf(ik, time));
      })
      .toBe(false);
    expect(reported).toEqual([]);
    body.dispose();
  },
);

test('another contract’s weights are taken from beside it', async () => {
  const regressor = await loadLearned({ modelUrl: `${await servedModels()}/learned.json?version=2` });
  expect(regressor.runNow?.(new Float32Array(regressor.contract.inputs[0]!.shape.at(-1)!))).toHaveLength(18);
});

test('unknown options, and an address in place of a function, are refused in a sentence', () => {
  // reason: what a page without types may pass
  const create = (options: object) => () => onnxNetworks(options as Parameters<typeof onnxNetworks>[0]);
  expect(() => onnxNetworks(undefined as never)).toThrow('onnxNetworks needs an object of options. Use modelUrl, ');
  expect(create({ modelURL: () => '/models/learned.json' })).toThrow('“modelURL” is not an option of onnxNetworks');
  expect(create({ modelUrl: '/models/' })).toThrow(
    "modelUrl is not a function. Pass one that returns a contract's address",
  );
});
