import { type AvatarHash, mostAvatarBytes, type WornAvatar } from 'threepoint/core/body/worn-avatar';

export interface AvatarStoreOptions {
  /** All files together, those on their way included [bytes]; 0: none is taken. */
  readonly mostBytes: number;
  /** What a person has on in a room of this process; null: they have no seat there. */
  readonly avatarOf: (room: string, identity: string) => WornAvatar | null;
  /** Seconds, monotonic. */
  readonly now: () => number;
}

/** Room for a file that is on its way. */
export interface Reservation {
  /** The file has arrived: it is its owner's one file in the room from now on. */
  keep(hash: AvatarHash, bytes: Uint8Array): void;
  /** It has not; once more does nothing. */
  cancel(): void;
}

/** Whose file it is. */
export interface AvatarOwner {
  readonly room: string;
  readonly identity: string;
  /** The network that the person comes from. */
  readonly address: string;
}

interface StoredAvatar extends AvatarOwner {
  readonly hash: AvatarHash;
  readonly bytes: Uint8Array;
  readonly storedAt: number;
  /** Its owner was seen with it on. */
  wasWorn: boolean;
}

/** A file may lie here for so long [s] before its owner has said that they have it on. */
const graceSeconds = 30;

/** So much of all may come from one address, as a person can have seats in many rooms; at least one file. */
const shareOfAddress = 1 / 4;

const ownerOf = (room: string, identity: string): string => `${room} ${identity}`;

/**
 * The files of avatars that people on seats have on, in the memory of this process and nowhere else: one of each person and room, by the hash of
 * its content. A file goes with its owner's seat, with the room, or when they have another avatar on.
 */
export class AvatarStore {
  readonly #options: AvatarStoreOptions;
  readonly #files = new Map<string, StoredAvatar>();
  /** Files on their way, by owner. */
  readonly #coming = new Map<string, { readonly address: string; readonly length: number }>();

  constructor(options: AvatarStoreOptions) {
    this.#options = options;
  }

  /** All that is stored or on its way [bytes]; two files of one content count twice. */
  get bytes(): number {
    let sum = 0;
    for (const { bytes } of this.#files.values()) sum += bytes.length;
    for (const { length } of this.#coming.values()) sum += length;
    return sum;
  }

  #bytesFrom(asked: string): number {
    let sum = 0;
    for (const { address, bytes } of this.#files.values()) if (address === asked) sum += bytes.length;
    for (const { address, length } of this.#coming.values()) if (address === asked) sum += length;
    return sum;
  }

  get count(): number {
    return this.#files.size;
  }

  /** Room for a file of this length; full: there is none, or (crowded) none for this address. busy: the person's last one is still on its way. */
  reserve({ room, identity, address }: AvatarOwner, length: number): Reservation | 'full' | 'crowded' | 'busy' {
    const { mostBytes } = this.#options;
    const owner = ownerOf(room, identity);
    if (this.#coming.has(owner)) return 'busy';
    const before = this.#files.get(owner);
    const freed = before?.bytes.length ?? 0;
    if (this.bytes - freed + length > mostBytes) return 'full';
    const freedHere = before?.address === address ? freed : 0;
    const mostHere = Math.max(mostAvatarBytes, shareOfAddress * mostBytes);
    if (this.#bytesFrom(address) - freedHere + length > mostHere) return 'crowded';
    this.#coming.set(owner, { address, length });
    return {
      keep: (hash, bytes) => {
        this.#coming.delete(owner);
        this.#files.set(owner, { room, identity, address, hash, bytes, storedAt: this.#options.now(), wasWorn: false });
      },
      cancel: () => this.#coming.delete(owner),
    };
  }

  /** The file of this content, where a person in the room has stored it; null: no one has. */
  get(room: string, hash: AvatarHash): Uint8Array | null {
    for (const file of this.#files.values()) if (file.room === room && file.hash === hash) return file.bytes;
    return null;
  }

  /** Which file of this person is stored; null: none. */
  keptOf(room: string, identity: string): AvatarHash | null {
    return this.#files.get(ownerOf(room, identity))?.hash ?? null;
  }

  /** Forgets what no one has on any more; asked again and again. */
  sweep(): void {
    const now = this.#options.now();
    for (const [owner, file] of this.#files) {
      const worn = this.#options.avatarOf(file.room, file.identity);
      if (worn === file.hash) file.wasWorn = true;
      // Word of a file comes after it: until then its owner has on what they had before, another file perhaps.
      const waiting = worn !== null && !file.wasWorn && now - file.storedAt < graceSeconds;
      if (worn !== file.hash && !waiting) this.#files.delete(owner);
    }
  }

  clear(): void {
    this.#files.clear();
  }
}
