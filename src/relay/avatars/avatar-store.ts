import { type AvatarHash, type AvatarRef, maxAvatarBytes } from 'threepoint/core';

interface AvatarStoreOptions {
  /** The most bytes of all files, uploads under way included; 0: no file is accepted. */
  readonly maxBytes: number;
  /** Returns the avatar of a person in a room of this process; null: they have no seat there. */
  readonly avatarOf: (room: string, identity: string) => AvatarRef | null;
  /** Seconds, monotonic. */
  readonly now: () => number;
}

/** Space that is reserved for an upload. */
export interface Reservation {
  /** Stores the uploaded file; it replaces the owner's previous file in the room. */
  store(hash: AvatarHash, bytes: Uint8Array): void;
  /** Releases the space of a failed upload; does nothing after `store`. */
  cancel(): void;
}

export interface AvatarOwner {
  readonly room: string;
  readonly identity: string;
  /** The network of the person's address. */
  readonly address: string;
}

interface StoredAvatar extends AvatarOwner {
  readonly hash: AvatarHash;
  readonly bytes: Uint8Array;
  readonly storedAt: number;
  /** Whether the owner has worn it since the upload. */
  wasWorn: boolean;
}

/** A file is stored this long [s] until its owner wears it. */
const graceSeconds = 30;

/** The share of all space that one address may use, at least one file: a person can have seats in many rooms. */
const shareOfAddress = 1 / 4;

const ownerOf = (room: string, identity: string): string => `${room} ${identity}`;

/**
 * Stores the avatar files of people on seats, in memory alone: one for each person and room, by the hash of its
 * content. A file is deleted with its owner's seat, with the room, or when the owner wears another avatar.
 */
export class AvatarStore {
  readonly #options: AvatarStoreOptions;
  readonly #files = new Map<string, StoredAvatar>();
  /** Uploads under way, by owner. */
  readonly #uploads = new Map<string, { readonly address: string; readonly length: number }>();

  constructor(options: AvatarStoreOptions) {
    this.#options = options;
  }

  /** Bytes of all files and uploads under way; equal files count separately. */
  get bytes(): number {
    return this.#bytesFrom(null);
  }

  /** Returns the bytes of files and uploads from an address; null: from all. */
  #bytesFrom(asked: string | null): number {
    const isAsked = ({ address }: { readonly address: string }) => asked === null || address === asked;
    let sum = 0;
    for (const file of this.#files.values()) if (isAsked(file)) sum += file.bytes.length;
    for (const upload of this.#uploads.values()) if (isAsked(upload)) sum += upload.length;
    return sum;
  }

  get count(): number {
    return this.#files.size;
  }

  /**
   * Reserves space for a file. full: the store is full. crowded: this address has used its share. busy: another upload
   * of this person is under way.
   */
  reserve({ room, identity, address }: AvatarOwner, length: number): Reservation | 'full' | 'crowded' | 'busy' {
    const { maxBytes } = this.#options;
    const owner = ownerOf(room, identity);
    if (this.#uploads.has(owner)) return 'busy';
    const before = this.#files.get(owner);
    const freed = before?.bytes.length ?? 0;
    if (this.bytes - freed + length > maxBytes) return 'full';
    const freedHere = before?.address === address ? freed : 0;
    const maxOfAddress = Math.max(maxAvatarBytes, shareOfAddress * maxBytes);
    if (this.#bytesFrom(address) - freedHere + length > maxOfAddress) return 'crowded';
    this.#uploads.set(owner, { address, length });
    return {
      store: (hash, bytes) => {
        this.#uploads.delete(owner);
        this.#files.set(owner, { room, identity, address, hash, bytes, storedAt: this.#options.now(), wasWorn: false });
      },
      cancel: () => this.#uploads.delete(owner),
    };
  }

  /** Returns the file with this hash; null: nobody in the room has uploaded it. */
  get(room: string, hash: AvatarHash): Uint8Array | null {
    for (const file of this.#files.values()) if (file.room === room && file.hash === hash) return file.bytes;
    return null;
  }

  /** Returns the hash of a person's stored file; null: none. */
  hashOf(room: string, identity: string): AvatarHash | null {
    return this.#files.get(ownerOf(room, identity))?.hash ?? null;
  }

  /** Deletes files that nobody wears any more; called periodically. */
  sweep(): void {
    const now = this.#options.now();
    for (const [owner, file] of this.#files) {
      const worn = this.#options.avatarOf(file.room, file.identity);
      if (worn === file.hash) file.wasWorn = true;
      // The 'wear' message follows the upload; until it arrives, the owner still wears another avatar.
      const waiting = worn !== null && !file.wasWorn && now - file.storedAt < graceSeconds;
      if (worn !== file.hash && !waiting) this.#files.delete(owner);
    }
  }

  clear(): void {
    this.#files.clear();
  }
}
