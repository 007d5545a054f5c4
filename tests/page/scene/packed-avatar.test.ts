import { MeshoptEncoder } from 'meshoptimizer';
import { parseAvatar } from 'threepoint/files';
import { describe, expect, test } from 'vitest';
import { decoders } from '../../../src/page/scene/decoders';
import { builtRig } from '../../threepoint/avatar/built-rig';
import { glbOf, padded, partsOf } from '../../threepoint/avatar/glb';
import { vroid } from '../../threepoint/avatar/rig-namings';
import { expectBody, wear } from '../../threepoint/avatar/worn-body';

/**
 * Returns the file with the corners of its skin packed by meshopt, as exporters write it; `claimed`: their number in
 * the file.
 */
async function packed(file: ArrayBuffer, claimed?: number): Promise<ArrayBuffer> {
  await MeshoptEncoder.ready;
  const { json, binary } = partsOf(new Uint8Array(file));
  const view = json.bufferViews[0]!;
  const [count, byteStride] = [view.byteLength / 12, 12];
  const raw = new Uint8Array(binary.subarray(0, view.byteLength));
  const small = MeshoptEncoder.encodeGltfBuffer(raw, count, byteStride, 'ATTRIBUTES');
  const extension = {
    buffer: 0,
    byteOffset: binary.length,
    byteLength: small.length,
    byteStride,
    count: claimed ?? count,
    mode: 'ATTRIBUTES',
  };
  Object.assign(view, { extensions: { EXT_meshopt_compression: extension } });
  json.buffers[0]!.byteLength = binary.length + padded(small.length);
  json.extensionsUsed = json.extensionsRequired = ['EXT_meshopt_compression'];
  return glbOf(json, Buffer.concat([binary.fill(0, 0, view.byteLength), small]));
}

describe('a rig whose skin is packed by meshopt', () => {
  test('is worn where the page has the means to unpack it, and refused elsewhere', async () => {
    const file = await packed(builtRig({ nameOf: vroid }));
    await expect(parseAvatar(file, 'packed.glb')).rejects.toThrow(
      'packed.glb: is compressed (EXT_meshopt_compression)',
    );
    expectBody(wear(await parseAvatar(file, 'packed.glb', { decoders })));
  });

  test('is refused where it would unpack to more than an avatar may have', async () => {
    const bomb = await packed(builtRig({ nameOf: vroid }), 5e8);
    await expect(parseAvatar(bomb, 'bomb.glb', { decoders })).rejects.toThrow(
      /^bomb\.glb: 6000 million unpacked bytes/,
    );
  });
});
