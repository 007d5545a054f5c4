import { fromAxisAngle, identity, up } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { RoomLight } from '../../../src/page/passthrough/room-light';

const floor = {} as XRReferenceSpace;

async function estimated(direction: readonly number[], turned = 0, strength = 1) {
  const light = new RoomLight();
  const session = { requestLightProbe: async () => ({ probeSpace: {} }) };
  await light.start(session as unknown as XRSession);
  const [x, y, z] = direction;
  const frame = {
    getPose: () => ({ transform: { orientation: turned ? fromAxisAngle(up, turned) : identity } }),
    getLightEstimate: () => ({
      primaryLightDirection: { x, y, z },
      primaryLightIntensity: { x: strength, y: strength / 2, z: Number.NaN },
      sphericalHarmonicsCoefficients: Float32Array.of(1, 0.5, 9, ...new Array(24).fill(0)),
    }),
  };
  return light.read(frame as unknown as XRFrame, floor);
}

describe('the light of a room', () => {
  test('comes from where the device says, in the floor frame, with a direction of length 1', async () => {
    const light = await estimated([0, 3, 0]);
    expect(light?.from).toEqual([0, 1, 0]);
    const turned = await estimated([0, 0, -2], Math.PI / 2);
    expect(turned?.from[0]).toBeCloseTo(-1, 6);
    expect(turned?.from[2]).toBeCloseTo(0, 6);
  });

  test('is bounded: the brightest lamp leaves colours, and what is no number is dark', async () => {
    const light = await estimated([0, 1, 0], 0, 40);
    expect(light?.key).toEqual([1.5, 1.5, 0]);
    expect(light?.fill[0]).toBeCloseTo(0.886, 3);
    expect(light?.fill[2]).toBe(1.5);
  });

  test('is unknown without a direction, and on a device that refuses or lacks the estimate', async () => {
    expect(await estimated([0, 0, 0])).toBeNull();
    for (const session of [
      {},
      { requestLightProbe: () => Promise.reject(new DOMException('no', 'NotSupportedError')) },
    ]) {
      const light = new RoomLight();
      await light.start(session as unknown as XRSession);
      expect(light.read({} as XRFrame, floor)).toBeNull();
    }
  });
});
