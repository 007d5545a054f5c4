import { MeshoptEncoder } from 'meshoptimizer';
import { glbOf, padded, partsOf } from './glb';

/**
 * Returns the file with the corners of its skin packed by meshopt, as exporters write it; `claimed`: their number in
 * the file.
 */
export async function packedSkin(file: ArrayBuffer, claimed?: number): Promise<ArrayBuffer> {
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
