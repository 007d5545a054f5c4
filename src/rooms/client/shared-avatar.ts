import {
  type AvatarHash,
  type AvatarRef,
  type BuiltInAvatar,
  defaultAvatar,
  maxAvatarBytes,
  reasonOf,
} from 'threepoint/core';
import type { HostedGame } from '../room/match-policy';
import type { AvatarExchange } from './avatar-exchange';
import type { RoomView } from './connection';

/** The user's avatar: a built-in one, or a file. */
export type OwnAvatar =
  | BuiltInAvatar
  | {
      readonly name: string;
      readonly file: Blob;
      /** null: unknown, because the connection is not secure. */
      readonly hash: AvatarHash | null;
    };

interface SharedAvatarOptions {
  /** null: there is no server, or the room belongs to a study, where all avatars are alike. */
  readonly exchange: AvatarExchange | null;
  /**
   * Returns the avatar to show to others: the same object for as long as it is worn; null: the user does not share it.
   * Called in every frame.
   */
  wear(): OwnAvatar | null;
  /** Sends the reference of the user's avatar to the room. */
  send(avatar: AvatarRef): void;
  notify(level: 'info' | 'warning', text: string): void;
}

const megabytes = (bytes: number): string => `${Math.round(bytes / 2 ** 20)} MB`;

/** Uploads a file to the room's store unless it is there. Rejects with a reason if the server refuses it. */
async function upload(exchange: AvatarExchange, hash: AvatarHash, file: Blob): Promise<void> {
  const { maxBytes, yours } = await exchange.terms();
  if (yours === hash) return;
  if (maxBytes === 0) throw new Error('this server accepts no avatars');
  if (file.size > maxBytes)
    throw new Error(`it has ${megabytes(file.size)}; this server accepts up to ${megabytes(maxBytes)}`);
  await exchange.store(hash, file);
}

/**
 * Shows the user's avatar to other players: uploads a file to the room's store, then sends its reference to the room.
 */
export class SharedAvatar {
  readonly #options: SharedAvatarOptions;
  /** The avatar that was sent last, and the welcome count at that time. */
  #wear: OwnAvatar | null = null;
  #welcomes = 0;
  #turn = 0;

  constructor(options: SharedAvatarOptions) {
    this.#options = options;
  }

  /** Shares a changed avatar; called once per frame. `room`: null before the first welcome. */
  update(room: RoomView<HostedGame> | null): void {
    if (!room || room.mySeat === null) return;
    const wear = this.#options.wear();
    if (wear === this.#wear && room.welcomeCount === this.#welcomes) return;
    const returned = wear === this.#wear && this.#welcomes > 0;
    this.#wear = wear;
    this.#welcomes = room.welcomeCount;
    this.#turn += 1;
    if (wear === null || typeof wear === 'string') this.#options.send(wear ?? defaultAvatar);
    else void this.#share(wear, this.#turn, returned);
  }

  /** Uploads a file and sends its reference. Never rejects. `quiet`: the user was notified before. */
  async #share({ name, file, hash }: Exclude<OwnAvatar, string>, turn: number, quiet: boolean): Promise<void> {
    const { exchange, send, notify } = this.#options;
    if (!exchange) return;
    const isNewest = () => turn === this.#turn;
    // Until the file is uploaded the others see the plain avatar, not the previous one.
    if (!quiet) send(defaultAvatar);
    try {
      if (hash === null) throw new Error('this page is not on a secure connection (https)');
      if (file.size > maxAvatarBytes)
        throw new Error(`it has ${megabytes(file.size)}; the limit is ${megabytes(maxAvatarBytes)}`);
      const kept = (await exchange.isStoredElsewhere(hash)) ? '' : ' The server stores the file until you leave.';
      if (kept && isNewest()) await upload(exchange, hash, file);
      if (!isNewest()) return;
      send(hash);
      if (!quiet) notify('info', `The other players see you as ${name} now.${kept}`);
    } catch (error) {
      if (!isNewest()) return;
      send(defaultAvatar);
      if (!quiet)
        notify('warning', `The other players see you as a mannequin, not as ${name}. Reason: ${reasonOf(error)}.`);
    }
  }
}
