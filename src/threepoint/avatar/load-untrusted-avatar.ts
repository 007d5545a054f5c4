import { type Avatar, createAvatarBetweenFrames } from './avatar';
import { seenAvatarLimits } from './file/avatar-limits';
import type { AvatarCheck } from './file/check-avatar';
import { type ParseOptions, parseChecked } from './load-avatar';

export interface LoadSeenAvatarOptions extends ParseOptions {
  readonly check: AvatarCheck;
}

/**
 * Loads the file of another person's avatar between frames. Rejects with a sentence that names the file, before
 * anything of it is decoded, where it exceeds `seenAvatarLimits` or is not valid glTF. The bytes are empty afterwards.
 */
export async function loadSeenAvatar(
  bytes: ArrayBuffer,
  name: string,
  { check, bones, decoders = {} }: LoadSeenAvatarOptions,
): Promise<Avatar> {
  const checked = await check(bytes, { name, unpacked: Object.keys(decoders), limits: seenAvatarLimits });
  return createAvatarBetweenFrames(await parseChecked(checked, name, { bones, decoders }));
}
