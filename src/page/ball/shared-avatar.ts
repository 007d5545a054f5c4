import { type AvatarHash, mostAvatarBytes, plainAvatar, type WornAvatar } from 'threepoint/core/body/worn-avatar';
import { reasonOf } from 'threepoint/core/errors/reasons';
import type { AvatarExchange } from 'threepoint-rooms/client/avatar-exchange';
import type { RoomView } from 'threepoint-rooms/client/connection';
import type { UserAvatar } from '../activity/activity-context';

export interface SharedAvatarOptions {
  /** null: there is no server, or its rooms are a study's, where all look alike. */
  readonly exchange: AvatarExchange | null;
  /** What the others are to see, asked for in every frame, the same object for as long as it is worn; null: the wearer wants theirs seen by no one. */
  wear(): UserAvatar | null;
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

/** Shows the user's avatar to other players: uploads a file to the room's store, then sends its reference to the room. */
export class SharedAvatar {
  readonly #options: SharedAvatarOptions;
  /** The avatar that was sent last, and the stay in the room in which it was sent. */
  #wear: UserAvatar | null = null;
  #welcomes = 0;
  #turn = 0;

  constructor(options: SharedAvatarOptions) {
    this.#options = options;
  }

  /** Once a frame; `room`: null before the first welcome. */
  follow(room: RoomView | null): void {
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
  async #share({ name, file, hash }: Exclude<UserAvatar, string>, turn: number, quiet: boolean): Promise<void> {
    const { exchange, tell, notify } = this.#options;
    if (!exchange) return;
    const isNewest = () => turn === this.#turn;
    // Until the file is there the others see the plain one, not what was worn before.
    if (!quiet) tell(plainAvatar);
    try {
      if (hash === null) throw new Error('this page is not on a secure connection (https)');
      if (file.size > mostAvatarBytes)
        throw new Error(`it has ${megabytes(file.size)}, of at most ${megabytes(mostAvatarBytes)}`);
      const kept = (await exchange.liesElsewhere(hash)) ? '' : ' The server keeps the file until you leave.';
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
