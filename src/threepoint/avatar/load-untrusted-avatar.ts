import { type Avatar, createAvatarBetweenFrames } from './avatar';
import { untrustedAvatarLimits } from './file/avatar-limits';
import type { AvatarCheck } from './file/check-avatar';
import { type ParseOptions, parseChecked } from './load-avatar';

interface LoadUntrustedAvatarOptions extends ParseOptions {
  readonly check: AvatarCheck;
}

/**
 * Loads the file of another person's avatar between frames. If the file exceeds `untrustedAvatarLimits` or is not valid
 * glTF, rejects with an Error that names it before anything is decoded. The given buffer is empty afterwards.
 */
export async function loadUntrustedAvatar(
  bytes: ArrayBuffer,
  name: string,
  { check, bones, decoders = {} }: LoadUntrustedAvatarOptions,
): Promise<Avatar> {
  const checked = await check(bytes, {
    name,
    supportedCompressions: Object.keys(decoders),
    limits: untrustedAvatarLimits,
  });
  return createAvatarBetweenFrames(await parseChecked(checked, { bones, decoders }));
}
