import { type VRM, VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { avatarLimits, inspectAvatar } from './inspect-avatar';

/** Bones without which there is no upper body to move. */
const neededBones = [
  'hips',
  'spine',
  'head',
  'leftUpperArm',
  'leftLowerArm',
  'leftHand',
  'rightUpperArm',
  'rightLowerArm',
  'rightHand',
] as const;

/** A VRM (0.x or 1.0) ready to be fitted, and what to call it. */
export interface LoadedAvatar {
  readonly name: string;
  readonly vrm: VRM;
}

export interface LoadAvatarOptions {
  /** Gets the share [0, 1] that has arrived. */
  readonly onProgress?: (share: number) => void;
  /** Finds faults in a file that is not our own. */
  readonly validate?: (bytes: Uint8Array) => Promise<readonly string[]>;
}

/**
 * Loads a VRM from our own server, another address or a local file, within `avatarLimits`. Rejects with a sentence that names the
 * file.
 */
export async function loadAvatar(
  source: string | File,
  { onProgress, validate }: LoadAvatarOptions = {},
): Promise<LoadedAvatar> {
  const name = typeof source === 'string' ? (source.split(/[?#]/)[0]?.split('/').at(-1) ?? source) : source.name;
  if (typeof source !== 'string' && source.size > avatarLimits.megabytes * 2 ** 20) throw tooLarge(name);
  const bytes = typeof source === 'string' ? await download(source, name, onProgress) : await source.arrayBuffer();
  onProgress?.(1);
  const file = new Uint8Array(bytes);
  inspectAvatar(file, name);
  if (validate) {
    const faults = await validate(file).catch((error: unknown) => {
      throw new Error(`${name}: ${error instanceof Error ? error.message : error}`);
    });
    if (faults.length > 0) throw new Error(`${name}: not valid glTF (${faults[0]})`);
  }
  return parseAvatar(bytes, name);
}

/** The same from bytes already here. */
export async function parseAvatar(bytes: ArrayBuffer, name: string): Promise<LoadedAvatar> {
  inspectAvatar(new Uint8Array(bytes), name);
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const gltf = await loader.parseAsync(bytes, '').catch((error: unknown) => {
    throw new Error(`${name}: no VRM or GLB file (${error instanceof Error ? error.message : error})`);
  });
  const vrm = gltf.userData.vrm as VRM | undefined;
  if (!vrm?.humanoid) throw new Error(`${name}: no humanoid in it; a VRM 0.x or 1.0 avatar is needed`);
  const missing = neededBones.filter((bone) => !vrm.humanoid.getRawBoneNode(bone));
  if (missing.length > 0) throw new Error(`${name}: its humanoid has no ${missing.join(', ')}`);
  // VRM 0.x looks along −Z at rest, 1.0 along +Z: from here on all look along +Z.
  VRMUtils.rotateVRM0(vrm);
  return { name, vrm };
}

const tooLarge = (name: string): Error =>
  new Error(`${name}: more than ${avatarLimits.megabytes} MB; an avatar may have that at most`);

async function download(url: string, name: string, onProgress?: (share: number) => void): Promise<ArrayBuffer> {
  const response = await fetch(url).catch((error: unknown) => {
    throw new Error(`${name}: could not be fetched (${error instanceof Error ? error.message : error})`);
  });
  if (!response.ok || !response.body)
    throw new Error(`${name}: the server answers ${response.status} ${response.statusText}`.trim());
  const total = Number(response.headers.get('content-length')) || 0;
  const pieces: Uint8Array[] = [];
  let received = 0;
  const reader = response.body.getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    pieces.push(value);
    received += value.length;
    if (received > avatarLimits.megabytes * 2 ** 20) {
      await reader.cancel();
      throw tooLarge(name);
    }
    if (total > 0) onProgress?.(Math.min(1, received / total));
  }
  const whole = new Uint8Array(received);
  let offset = 0;
  for (const piece of pieces) {
    whole.set(piece, offset);
    offset += piece.length;
  }
  return whole.buffer;
}
