import {
  type AvatarHash,
  type AvatarRef,
  type BuiltInBody,
  bodyOf,
  isBuiltInAvatar,
  reasonOf,
  TransientError,
} from 'threepoint/core';
import { downloadLimited, type FileKind, sha256Base64Url, untrustedAvatarLimits } from 'threepoint/internal';
import type { Avatar } from 'threepoint/three';
import type { AvatarExchange } from '../client/avatar-exchange';

/** The file of another person. */
const seenFile: FileKind = { what: 'an avatar that others see', megabytes: untrustedAvatarLimits.megabytes };

export interface RoomAvatarLoaderOptions {
  /** null: without a server, and in rooms of a study; then no file can be loaded. */
  readonly exchange: AvatarExchange | null;
  /** Loads a copy of a built-in body. */
  loadBuiltIn(name: BuiltInBody): Promise<Avatar>;
  /** Loads an untrusted file that has the announced hash; `loadAvatar` with `untrusted` refuses the same files. */
  loadFile(bytes: ArrayBuffer): Promise<Avatar>;
  /** The timeout of a download [ms], because other avatars wait for it. */
  readonly timeoutMs?: number;
}

/**
 * Loads the avatars of other people. A file comes only from the store of the room or from the server that the store
 * names. It is refused if its hash differs from the announced one, or if it exceeds a limit of untrusted files.
 */
export class RoomAvatarLoader {
  readonly #options: RoomAvatarLoaderOptions;
  readonly #leaving = new AbortController();

  constructor(options: RoomAvatarLoaderOptions) {
    this.#options = options;
  }

  /** Loads an avatar. Rejects with an Error, with a TransientError if the file could not be fetched. */
  async load(avatar: AvatarRef): Promise<Avatar> {
    if (isBuiltInAvatar(avatar)) return this.#options.loadBuiltIn(bodyOf(avatar));
    return this.#options.loadFile(await this.#fetch(avatar));
  }

  /** Cancels all downloads. */
  dispose(): void {
    this.#leaving.abort();
  }

  async #fetch(hash: AvatarHash): Promise<ArrayBuffer> {
    const bytes = await this.#download(hash);
    if ((await sha256Base64Url(bytes)) === hash) return bytes;
    throw new Error('the server sent a different file than the player announced');
  }

  async #download(hash: AvatarHash): Promise<ArrayBuffer> {
    const { exchange, timeoutMs = 60_000 } = this.#options;
    if (!exchange) throw new Error('no server has the file');
    // Kept in a variable: Node collects a timeout that only AbortSignal.any refers to (nodejs/node#57736).
    const late = AbortSignal.timeout(timeoutMs);
    const signal = AbortSignal.any([this.#leaving.signal, late]);
    let reason = '';
    let passes = false;
    const addresses = await exchange.addressesOf(hash).catch((error: unknown) => {
      throw new TransientError(reasonOf(error));
    });
    for (const { url, headers } of addresses) {
      try {
        return await downloadLimited(url, seenFile, { headers, signal });
      } catch (error) {
        passes ||= error instanceof TransientError;
        reason ||= reasonOf(error).replace(`${hash}: `, '');
        if (signal.aborted) break;
      }
    }
    if (late.aborted) throw new TransientError('it did not arrive in time');
    throw passes ? new TransientError(reason) : new Error(reason);
  }
}
