import { hashOf } from 'threepoint/avatar/file/file-hash';
import { type AvatarHash, isAvatarHash, mostAvatarBytes } from 'threepoint/core/body/avatar-ref';
import { type Avatar, loadAvatar, loadMannequin } from 'threepoint/three';
import type { AvatarExchange } from '../client/avatar-exchange';

/**
 * Uploads the file of the wearer's avatar to the memory of the room's server, and returns its hash. Rejects with a
 * sentence where the server does not accept it.
 */
export async function uploadAvatar(exchange: AvatarExchange, file: Blob): Promise<AvatarHash> {
  const { mostBytes, yours } = await exchange.terms();
  const most = Math.min(mostBytes, mostAvatarBytes);
  if (file.size > most) throw new Error(`the avatar has ${file.size} bytes; this server accepts ${most}`);
  const hash = await hashOf(await file.arrayBuffer());
  if (hash === null) throw new Error('browsers hash files on https pages only');
  if (hash !== yours) await exchange.store(hash, file);
  return hash;
}

/** Returns the avatar of another person in a room: the file that they uploaded, or else the mannequin. */
export async function loadRoomAvatar(exchange: AvatarExchange, reference: string | null): Promise<Avatar> {
  if (reference === null || !isAvatarHash(reference)) return loadMannequin();
  for (const { url, headers } of await exchange.addressesOf(reference)) {
    const response = await fetch(url, { headers });
    if (!response.ok) continue;
    const file = await response.arrayBuffer();
    if ((await hashOf(file)) === reference) return loadAvatar(file);
  }
  throw new Error('no server has the file');
}
