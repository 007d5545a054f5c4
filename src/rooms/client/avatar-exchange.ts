import { type AvatarHash, avatarHashPattern } from 'threepoint/core';
import * as v from 'valibot';
import { fetchWithPass, type RoomPass } from './room-pass';

/** The limits of a server's avatar store, and this person's file in it. */
interface AvatarTerms {
  /** The largest file that it accepts [bytes]; 0: none. */
  readonly maxBytes: number;
  /** A folder on another server with avatars by hash; null: none. */
  readonly elsewhere: string | null;
  /** The stored file of this person; null: none. */
  readonly yours: AvatarHash | null;
}

/** The address of a file, with the headers of the request. */
interface AvatarAddress {
  readonly url: string;
  readonly headers: Readonly<Record<string, string>>;
}

/** Uploads and finds the avatars of one room, with a pass. */
export interface AvatarExchange {
  /** Fetches the terms of the store. Rejects with a sentence if the server does not answer. */
  terms(): Promise<AvatarTerms>;
  /** Resolves to whether the other server has this file, which then needs no upload. */
  isStoredElsewhere(hash: AvatarHash): Promise<boolean>;
  /**
   * Uploads a file; the server stores it while its owner uses it on a seat. Rejects with an Error if the server refuses
   * it.
   */
  store(hash: AvatarHash, file: Blob): Promise<void>;
  /** Resolves to the addresses at which this file may be, the likeliest first. */
  addressesOf(hash: AvatarHash): Promise<readonly AvatarAddress[]>;
}

const terms = v.object({
  maxBytes: v.pipe(v.number(), v.minValue(0)),
  elsewhere: v.nullable(v.pipe(v.string(), v.url(), v.startsWith('https://'), v.endsWith('/'))),
  yours: v.nullable(v.pipe(v.string(), v.regex(avatarHashPattern))),
});

/** Creates the exchange of a room. `base`: the address of the relay, without a trailing slash. */
export function createAvatarExchange(base: string, room: string, pass: RoomPass): AvatarExchange {
  const addressOf = (hash?: AvatarHash): string => `${base}/api/avatars${hash ? `/${hash}` : ''}?room=${room}`;
  async function rejectionOf(response: Response): Promise<Error> {
    const body = (await response.json().catch(() => null)) as { error?: unknown } | null;
    return new Error(
      typeof body?.error === 'string' ? body.error : `the server answered with status ${response.status}`,
    );
  }

  async function askTerms(): Promise<AvatarTerms> {
    const response = await fetchWithPass(pass, addressOf());
    if (!response.ok) throw await rejectionOf(response);
    const read = v.safeParse(terms, await response.json().catch(() => null));
    if (!read.success) throw new Error('the server has no avatar store');
    return read.output;
  }

  return {
    terms: askTerms,
    async isStoredElsewhere(hash) {
      const { elsewhere } = await askTerms();
      if (!elsewhere) return false;
      return fetch(`${elsewhere}${hash}`, { method: 'HEAD', cache: 'no-store' }).then(
        ({ ok }) => ok,
        () => false,
      );
    },
    async store(hash, file) {
      const headers = { 'content-type': 'model/gltf-binary' };
      const response = await fetchWithPass(pass, addressOf(hash), { method: 'PUT', body: file, headers });
      if (!response.ok) throw await rejectionOf(response);
    },
    async addressesOf(hash) {
      // This request also renews an expired pass.
      const { elsewhere } = await askTerms();
      const authorization = `Bearer ${await pass.token(false)}`;
      const here = { url: addressOf(hash), headers: { authorization } };
      // The other server does not receive the pass.
      return elsewhere ? [here, { url: `${elsewhere}${hash}`, headers: {} }] : [here];
    },
  };
}
