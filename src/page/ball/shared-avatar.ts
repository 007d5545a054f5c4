import {
  type AvatarHash,
  mostAvatarBytes,
  type OwnAvatar,
  plainAvatar,
  type WornAvatar,
} from 'threepoint/core/body/worn-avatar';
import { reasonOf } from 'threepoint/core/errors/reasons';
import type { BallRoomView } from 'threepoint-games/ball/ball-client';
import type { AvatarExchange } from 'threepoint-rooms/client/avatar-exchange';

/** What the wearer has on: one of ours by name, or a file. */
export type OwnWear =
  | OwnAvatar
  | {
      readonly name: string;
      readonly file: Blob;
      /** null: this page cannot tell, as its connection is not secure. */
      readonly hash: AvatarHash | null;
    };

export interface SharedAvatarOptions {
  /** null: there is no server, or its rooms are a study's, where all look alike. */
  readonly exchange: AvatarExchange | null;
  /** What the others are to see, asked for in every frame, the same object for as long as it is worn; null: the wearer wants theirs seen by no one. */
  wear(): OwnWear | null;
  /** Says to the room what this player has on. */
  tell(avatar: WornAvatar): void;
  notify(level: 'info' | 'warning', text: string): void;
}

const megabytes = (bytes: number): string => `${Math.round(bytes / 2 ** 20)} MB`;

/** Into the room's store, unless it lies there. Rejects with a sentence where the server does not take it. */
async function bring(exchange: AvatarExchange, hash: AvatarHash, file: Blob): Promise<void> {
  const { mostBytes, yours } = await exchange.terms();
  if (yours === hash) return;
  if (mostBytes === 0) throw new Error('this server takes no avatars');
  if (file.size > mostBytes)
    throw new Error(`it has ${megabytes(file.size)}; this server takes ${megabytes(mostBytes)}`);
  await exchange.store(hash, file);
}

/** Shows the others what the wearer has on: brings a file to the room's store, then tells the room of it. */
export class SharedAvatar {
  readonly #options: SharedAvatarOptions;
  /** What was told last, and in which stay in the room. */
  #wear: OwnWear | null = null;
  #welcomes = 0;
  #turn = 0;

  constructor(options: SharedAvatarOptions) {
    this.#options = options;
  }

  /** Once a frame; `room`: null before the first welcome. */
  follow(room: BallRoomView | null): void {
    if (!room || room.mySeat === null) return;
    const wear = this.#options.wear();
    if (wear === this.#wear && room.welcomes === this.#welcomes) return;
    const returned = wear === this.#wear && this.#welcomes > 0;
    this.#wear = wear;
    this.#welcomes = room.welcomes;
    this.#turn += 1;
    if (wear === null || typeof wear === 'string') this.#options.tell(wear ?? plainAvatar);
    else void this.#share(wear, this.#turn, returned);
  }

  /** Never rejects. `quiet`: it was said before. */
  async #share({ name, file, hash }: Exclude<OwnWear, string>, turn: number, quiet: boolean): Promise<void> {
    const { exchange, tell, notify } = this.#options;
    if (!exchange) return;
    const isNewest = () => turn === this.#turn;
    // Until the file is there the others see the plain one, not what was worn before.
    if (!quiet) tell(plainAvatar);
    try {
      if (hash === null) throw new Error('this page is not on a secure connection (https)');
      if (file.size > mostAvatarBytes)
        throw new Error(`it has ${megabytes(file.size)}, of at most ${megabytes(mostAvatarBytes)}`);
      const kept = (await exchange.isStoredElsewhere(hash)) ? '' : ' The server keeps the file until you leave.';
      if (kept && isNewest()) await bring(exchange, hash, file);
      if (!isNewest()) return;
      tell(hash);
      if (!quiet) notify('info', `The others see you as ${name} now.${kept}`);
    } catch (error) {
      if (!isNewest()) return;
      tell(plainAvatar);
      if (!quiet) notify('warning', `The others see you as a mannequin, not as ${name}: ${reasonOf(error)}.`);
    }
  }
}
