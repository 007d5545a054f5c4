import { type AvatarHash, avatarHash } from 'threepoint/core/body/worn-avatar';
import * as v from 'valibot';
import type { RoomPass } from './room-pass';

/** What a server says of the store of its rooms. */
export interface AvatarTerms {
  /** Longest file that it takes [bytes]; 0: none. */
  readonly mostBytes: number;
  /** The folder of another server that has avatars by the same names; null: none. */
  readonly elsewhere: string | null;
  /** The file that it has of this person. */
  readonly yours: AvatarHash | null;
}

/** Where a file can be had, and what to say there. */
export interface AvatarAddress {
  readonly url: string;
  readonly headers: Readonly<Record<string, string>>;
}

/** The store of avatars of one room, for the holder of a pass. */
export interface AvatarExchange {
  /** Rejects with a sentence where the server does not say. */
  terms(): Promise<AvatarTerms>;
  /** Whether the other server that is named has this file: it need not be stored then. */
  isStoredElsewhere(hash: AvatarHash): Promise<boolean>;
  /** Stores the own file; kept for as long as its owner has it on, on a seat. Rejects with a sentence where the server does not take it. */
  store(hash: AvatarHash, file: Blob): Promise<void>;
  /** Where this file may be, the likeliest first. */
  addressesOf(hash: AvatarHash): Promise<readonly AvatarAddress[]>;
}

const terms = v.object({
  mostBytes: v.pipe(v.number(), v.minValue(0)),
  elsewhere: v.nullable(v.pipe(v.string(), v.url(), v.startsWith('https://'), v.endsWith('/'))),
  yours: v.nullable(v.pipe(v.string(), v.regex(avatarHash))),
});

/** At the relay at `base`, no slash at its end. */
export function createAvatarExchange(base: string, room: string, pass: RoomPass): AvatarExchange {
  const addressOf = (hash?: AvatarHash): string => `${base}/api/avatars${hash ? `/${hash}` : ''}?room=${room}`;
  const bearing = (token: string) => ({ authorization: `Bearer ${token}` });

  /** Once more with a renewed pass where this one has expired. */
  async function ask(hash: AvatarHash | undefined, file?: Blob): Promise<Response> {
    for (const afresh of [false, true]) {
      const headers = bearing(await pass.token(afresh));
      const response = await fetch(addressOf(hash), {
        ...(file && { method: 'PUT', body: file }),
        headers: file ? { ...headers, 'content-type': 'model/gltf-binary' } : headers,
        cache: 'no-store',
      });
      if (response.status !== 401 || afresh) return response;
    }
    throw new Error('the server let no one in');
  }

  async function refusalOf(response: Response): Promise<Error> {
    const said = (await response.json().catch(() => null)) as { error?: unknown } | null;
    return new Error(typeof said?.error === 'string' ? said.error : `the server answers ${response.status}`);
  }

  async function askTerms(): Promise<AvatarTerms> {
    const response = await ask(undefined);
    if (!response.ok) throw await refusalOf(response);
    const read = v.safeParse(terms, await response.json().catch(() => null));
    if (!read.success) throw new Error('the server says nothing of avatars');
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
      const response = await ask(hash, file);
      if (!response.ok) throw await refusalOf(response);
    },
    async addressesOf(hash) {
      // By the way a pass that has expired is renewed.
      const { elsewhere } = await askTerms();
      const here = { url: addressOf(hash), headers: bearing(await pass.token(false)) };
      // Another server learns nothing of the room.
      return elsewhere ? [here, { url: `${elsewhere}${hash}`, headers: {} }] : [here];
    },
  };
}
