import { readFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { actorFrame, defaultCalibration } from 'threepoint/core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { Body } from '../../../src/threepoint/api/body';
import { loadLearned } from '../../../src/threepoint/api/load-learned';
import { onnxNetworks } from '../../../src/threepoint/api/onnx';

let server: Server;
let models = '';

beforeAll(async () => {
  server = createServer((request, response) => {
    const name = request.url?.split('/').at(-1) ?? '';
    response.end(readFileSync(new URL(`../../../public/models/${name}`, import.meta.url)));
  });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  models = `http://127.0.0.1:${(server.address() as AddressInfo).port}/any/folder`;
});

afterAll(async () => {
  await new Promise((resolve) => server.close(resolve));
});

test.each(['paper', 'learned'] as const)(
  'the runtime brings the %s network, whose answer a later frame draws',
  async (name) => {
    const reported: string[] = [];
    const body = new Body({
      estimator: name,
      calibration: defaultCalibration,
      networks: onnxNetworks({ modelUrl: (network) => `${models}/${network}.json` }),
      events: { fallback: ({ reason }) => reported.push(reason) },
    });
    await body.setEstimator(name);
    expect(body.estimator).toBe(name);
    const ik = new Body({ estimator: 'ik', calibration: defaultCalibration });
    await ik.setEstimator('ik');
    const first = actorFrame(1, defaultCalibration);
    const chestOf = (drawn: Body, time: number) => ({
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
  const regressor = await loadLearned({ modelUrl: `${models}/learned.json?version=2` });
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
