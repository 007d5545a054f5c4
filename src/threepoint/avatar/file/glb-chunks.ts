import { binaryChunk, glbMagic, jsonChunk } from '../../core/motion/gltf';

/** Returns the two chunks of a GLB file; null: it is no GLB file, or it is truncated. */
export function readGlbChunks(bytes: Uint8Array): { readonly json: string; readonly binary: Uint8Array } | null {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 20 || view.getUint32(0, true) !== glbMagic || view.getUint32(4, true) !== 2) return null;
  const at = 20 + view.getUint32(12, true);
  if (view.getUint32(16, true) !== jsonChunk || Math.max(at, view.getUint32(8, true)) > bytes.length) return null;
  const json = new TextDecoder().decode(bytes.subarray(20, at));
  if (at + 8 > bytes.length || view.getUint32(at + 4, true) !== binaryChunk) return { json, binary: new Uint8Array() };
  const end = at + 8 + view.getUint32(at, true);
  return end > bytes.length ? null : { json, binary: bytes.subarray(at + 8, end) };
}
