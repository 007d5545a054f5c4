import type { OwnFile } from './user-avatar';

/** The cache of the file, and the address of the file in it, which no server has. */
const cacheName = 'threepoint.avatar.1';
const address = '/own-avatar';
const nameHeader = 'x-file-name';

/** Stores the avatar of the user's own file on this device for later visits, in Cache Storage. */
export class AvatarStore {
  readonly #caches: CacheStorage | null;

  /** `caches`: null if the browser grants none. */
  constructor(caches: CacheStorage | null) {
    this.#caches = caches;
  }

  /** Stores a file in place of the one before. Returns whether the browser has stored it. */
  async store({ name, file }: OwnFile): Promise<boolean> {
    const headers = { [nameHeader]: encodeURIComponent(name) };
    const stored = await this.#use(async (caches) => {
      const cache = await caches.open(cacheName);
      await cache.put(address, new Response(file, { headers }));
      return true;
    });
    return stored ?? false;
  }

  /** Returns the stored file; null: there is none. */
  read(): Promise<File | null> {
    return this.#use(async (caches) => {
      const stored = await caches.match(address, { cacheName });
      const name = stored?.headers.get(nameHeader);
      return stored && name ? new File([await stored.blob()], decodeURIComponent(name)) : null;
    });
  }

  async forget(): Promise<void> {
    await this.#use((caches) => caches.delete(cacheName));
  }

  /** Returns null where the browser refuses: its storage is full or forbidden. */
  async #use<Result>(act: (caches: CacheStorage) => Promise<Result>): Promise<Result | null> {
    try {
      return this.#caches && (await act(this.#caches));
    } catch (error) {
      if (error instanceof DOMException) return null;
      throw error;
    }
  }
}
