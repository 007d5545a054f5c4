import { decoders } from 'threepoint/avatar/decoders/decoders';
import { checkInWorker } from 'threepoint/avatar/file/check-in-worker';
import { seenAvatarLimits } from 'threepoint/avatar/file/inspect-avatar';
import { type LoadedAvatar, parseAvatar, parseChecked } from 'threepoint/avatar/load-avatar';
import {
  type AvatarHash,
  type AvatarRef,
  type BuiltInBody,
  bodyOf,
  isBuiltInAvatar,
  plainAvatar,
} from 'threepoint/core/body/avatar-ref';
import { PassingFault } from 'threepoint/core/errors/passing-fault';
import { reasonOf } from 'threepoint/core/errors/reasons';
import type { AvatarExchange } from 'threepoint-rooms/client/avatar-exchange';
import { type FileKind, readLimited } from 'threepoint-ui/limited-files';

/** The file of another person. */
const seenFile: FileKind = { what: 'an avatar that others see', megabytes: seenAvatarLimits.megabytes };
interface SeenAvatarsOptions {
  /** A download that takes longer [ms] is cancelled: other avatars wait for it. */
  readonly patienceMs?: number;
}

/**
 * Loads the avatars of other players. A file comes only from the store of the room or from the server that the store
 * names. It is refused if its hash differs, and is checked in a worker before it is parsed here.
 */
export class SeenAvatars {
  /** The files of the built-in bodies that were needed. */
  readonly #builtIn = new Map<BuiltInBody, Promise<ArrayBuffer>>();
  readonly #fetchBuiltIn: (name: BuiltInBody) => Promise<ArrayBuffer>;
  readonly #exchange: AvatarExchange | null;
  readonly #patienceMs: number;
  readonly #leaving = new AbortController();

  /**
   * `mannequin`: the file of the plain avatar; `fetchBuiltIn`: downloads another built-in body. `exchange`: null
   * without a server, and in rooms of a study.
   */
  constructor(
    mannequin: ArrayBuffer,
    fetchBuiltIn: (name: BuiltInBody) => Promise<ArrayBuffer>,
    exchange: AvatarExchange | null,
    { patienceMs = 60_000 }: SeenAvatarsOptions = {},
  ) {
    this.#builtIn.set(plainAvatar, Promise.resolve(mannequin));
    this.#fetchBuiltIn = fetchBuiltIn;
    this.#exchange = exchange;
    this.#patienceMs = patienceMs;
  }

  /** Rejects with a PassingFault where it could not be fetched. */
  async load(avatar: AvatarRef): Promise<LoadedAvatar> {
    if (!isBuiltInAvatar(avatar)) return this.#loadFile(avatar);
    const body = bodyOf(avatar);
    const known = this.#builtIn.get(body);
    const file = known ?? this.#fetchBuiltIn(body);
    if (!known) {
      this.#builtIn.set(body, file);
      // What was lost on the way is fetched again when it is needed again.
      file.catch(() => this.#builtIn.delete(body));
    }
    return parseAvatar(await file, `${body}.vrm`);
  }

  /** Cancels all downloads. */
  leave(): void {
    this.#leaving.abort();
  }

  async #loadFile(hash: AvatarHash): Promise<LoadedAvatar> {
    const name = 'the avatar';
    const bytes = await this.#fetch(hash);
    const question = { name, unpacked: Object.keys(decoders), limits: seenAvatarLimits };
    const checked = await checkInWorker(bytes, question);
    if (checked.hash !== hash) throw new Error('the server sent a different file than the player announced');
    return parseChecked(checked, name, { decoders });
  }

  async #fetch(hash: AvatarHash): Promise<ArrayBuffer> {
    if (!this.#exchange) throw new Error('no server has the file');
    // Named, and asked below: Node forgets a timeout of which nothing but AbortSignal.any knows (nodejs/node#57736).
    const late = AbortSignal.timeout(this.#patienceMs);
    const signal = AbortSignal.any([this.#leaving.signal, late]);
    let reason = '';
    let passes = false;
    const addresses = await this.#exchange.addressesOf(hash).catch((error: unknown) => {
      throw new PassingFault(reasonOf(error));
    });
    for (const { url, headers } of addresses) {
      try {
        return await readLimited(url, seenFile, { headers, signal });
      } catch (error) {
        passes ||= error instanceof PassingFault;
        reason ||= reasonOf(error).replace(`${hash}: `, '');
        if (signal.aborted) break;
      }
    }
    if (late.aborted) throw new PassingFault('it did not arrive in time');
    throw passes ? new PassingFault(reason) : new Error(reason);
  }
}
