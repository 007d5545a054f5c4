import type { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { type Avatar, createAvatar } from '../avatar/avatar';
import { createWorkerCheck } from '../avatar/file/avatar-check-client';
import { type Decoders, parseAvatar } from '../avatar/load-avatar';
import { loadUntrustedAvatar } from '../avatar/load-untrusted-avatar';
import { reasonOf } from '../core/errors/reasons';
import { nameOfAddress } from '../core/files';
import type { BoneMap } from '../core/humanoid/bones';
import { assertOptions } from './assert-options';
import { readBundledMannequin } from './bundled/mannequin';
import { startValidator } from './bundled/validator';
import type { MotionWriter } from './motion-file';
import { warnOfThreadCheck } from './warnings';

export interface LoadAvatarOptions {
  /**
   * The name of the file's node for each bone (by VRM's bone names), instead of the bones that a VRM states or that are
   * matched in another humanoid. For a VRM the map must contain the legs.
   */
  readonly bones?: BoneMap;
  /**
   * Whether the file comes from another person. It is validated in a worker before it is decoded, and has lower limits:
   * 20 MB, 100,000 triangles, 64 million pixels. Default: false.
   */
  readonly untrusted?: boolean;
  /**
   * A GLTFLoader with the page's decoders, which read compressed files: `setDRACOLoader`, `setKTX2Loader`,
   * `setMeshoptDecoder`. Its plugins are not used. Default: compressed files are rejected.
   */
  readonly loader?: DecodingLoader;
}

/** The decoders of a GLTFLoader of three.js. */
export type DecodingLoader = Pick<GLTFLoader, 'dracoLoader' | 'ktx2Loader' | 'meshoptDecoder'>;

export type AvatarMotionOptions = Omit<LoadAvatarOptions, 'untrusted'>;

/** The URL of an avatar's file, the file, or its bytes. */
export type AvatarSource = string | URL | Blob | ArrayBuffer | ArrayBufferView;

/**
 * Loads an avatar from a URL, a file or its bytes: VRM 0.x or 1.0, or a humanoid GLB or FBX. Rejects with an Error that
 * names the file if it cannot be fetched or read, exceeds a limit, or lacks a needed bone. Pass `untrusted` for a file
 * that comes from another person.
 *
 * @example
 * const avatar = await loadAvatar('/avatars/robot.glb', { bones: { hips: 'Hips', head: 'Head' } });
 */
export async function loadAvatar(source: AvatarSource, options: LoadAvatarOptions = {}): Promise<Avatar> {
  assertOptions('loadAvatar', options, ['bones', 'untrusted', 'loader']);
  const { bones, untrusted = false, loader } = options;
  const decoders = decodersOf(loader);
  const { name, bytes } = await read(source);
  if (!untrusted) return createAvatar(await parseAvatar(bytes, name, { bones, decoders }));
  return loadUntrustedAvatar(bytes, name, { check: checkUntrusted, bones, decoders });
}

/** Returns the decoders that a page has set on its loader. */
function decodersOf(loader: DecodingLoader | undefined): Decoders {
  const { dracoLoader = null, ktx2Loader = null, meshoptDecoder = null } = loader ?? {};
  const draco = async (own: GLTFLoader) => void own.setDRACOLoader(dracoLoader);
  const basis = async (own: GLTFLoader) => void own.setKTX2Loader(ktx2Loader);
  const meshopt = async (own: GLTFLoader) => void own.setMeshoptDecoder(meshoptDecoder);
  return {
    ...(dracoLoader && { KHR_draco_mesh_compression: draco }),
    ...(ktx2Loader && { KHR_texture_basisu: basis }),
    ...(meshoptDecoder && { EXT_meshopt_compression: meshopt, KHR_meshopt_compression: meshopt }),
  };
}

/** Checks a file in a worker, or on the calling thread if no worker starts. */
const checkUntrusted = /* @__PURE__ */ createWorkerCheck(startValidator, async (...file) => {
  if ('document' in globalThis) warnOfThreadCheck();
  const { checkAvatar } = await import('../avatar/file/check-avatar');
  return checkAvatar(...file);
});

/**
 * Loads the mannequin in this package; each call returns a new one.
 *
 * @example
 * const tracker = new BodyTracker(renderer, { avatar: await loadMannequin() });
 */
export async function loadMannequin(): Promise<Avatar> {
  return createAvatar(await parseAvatar(await readBundledMannequin(), 'mannequin.vrm', {}));
}

/**
 * Returns a writer of animated GLB files for the option `format` of `exportMotion`. The file contains the avatar and
 * the motion as an animation, with steps scaled to the avatar's legs. Rejects as `loadAvatar` does.
 *
 * @example
 * const { parts, type } = await exportMotion(recording, { format: await avatarMotionWriter('/avatars/me.vrm') });
 */
export async function avatarMotionWriter(
  source: AvatarSource,
  options: AvatarMotionOptions = {},
): Promise<MotionWriter> {
  assertOptions('avatarMotionWriter', options, ['bones', 'loader']);
  const { bones, loader } = options;
  const [{ createAvatarMotionWriter }, { name, bytes }] = await Promise.all([
    import('../avatar/avatar-motion-writer'),
    read(source),
  ]);
  return createAvatarMotionWriter(bytes, name, { bones, decoders: decodersOf(loader) });
}

async function read(source: AvatarSource): Promise<{ name: string; bytes: ArrayBuffer }> {
  if (source instanceof ArrayBuffer) return { name: 'the avatar', bytes: source };
  if (ArrayBuffer.isView(source) || source instanceof Blob) {
    const name = source instanceof File ? source.name : 'the avatar';
    return { name, bytes: await new Blob([source as BlobPart]).arrayBuffer() };
  }
  if (typeof source !== 'string' && !(source instanceof URL)) {
    const what = source === undefined || source === null ? 'missing' : 'neither an address nor a file nor bytes';
    throw new TypeError(
      `The avatar's source is ${what}. Pass its address, file or bytes: loadAvatar('/avatars/me.vrm').`,
    );
  }
  const address = String(source);
  const name = nameOfAddress(address);
  const response = await fetch(address).catch((error: unknown) => {
    const advice = 'Is it there, and does its server allow this page (CORS)?';
    throw new Error(`${name}: could not be fetched (${reasonOf(error)}). ${advice}`);
  });
  if (!response.ok) throw new Error(`${name}: the server answers ${response.status} ${response.statusText}`.trim());
  return { name, bytes: await response.arrayBuffer() };
}
