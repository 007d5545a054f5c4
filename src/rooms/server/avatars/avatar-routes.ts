import { createHash } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import { avatarHash, mostAvatarBytes } from 'threepoint/core/body/worn-avatar';
import { type Answer, done, HttpError, json } from 'threepoint-http/answer';
import { readBody } from 'threepoint-http/body';
import { clientAddressOf } from 'threepoint-http/client-address';
import type { Call, Route } from 'threepoint-http/router';
import { requirePass } from '../access/request-pass';
import type { RoomTokens } from '../access/room-tokens';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { RelayMetrics } from '../settings/relay-metrics';
import type { AvatarOwner, AvatarStore, Reservation } from './avatar-store';

export interface AvatarRoutesOptions {
  readonly configuration: Pick<RelayConfiguration, 'avatarMegabytes' | 'avatarsFrom' | 'trustProxy'>;
  readonly store: AvatarStore;
  readonly tokens: Pick<RoomTokens, 'verify'>;
  readonly metrics: Pick<RelayMetrics, 'refused'>;
  /** Whether a person has a seat in a room of this process, or one is held for them. */
  readonly isSeated: (room: string, identity: string) => boolean;
}

/** Files a minute: of a person, and of all people of one address. */
const uploadsPerPerson = 4;
const uploadsPerAddress = 20;
const downloadsPerPerson = 60;

const glb = 'model/gltf-binary';
/** "glTF", version 2; then the length of the whole. */
const glbHead = Buffer.from([0x67, 0x6c, 0x54, 0x46, 2, 0, 0, 0]);

const isGlb = (bytes: Buffer): boolean =>
  bytes.length >= 20 && bytes.subarray(0, 8).equals(glbHead) && bytes.readUInt32LE(8) === bytes.length;

/** What is stored is shown by no browser, text and scripts included: it is a file to be saved, without scripts, of the type that it was checked for. */
const asFile: Readonly<Record<string, string>> = {
  'content-type': glb,
  'content-disposition': 'attachment; filename="avatar.glb"',
  'content-security-policy': "default-src 'none'; sandbox",
};

const perMinute = (points: number): RateLimiterMemory => new RateLimiterMemory({ points, duration: 60 });

/** Uploads and downloads of the avatars that the people of a room see each other in. `?room=` is for the proxy of a fleet. */
export class AvatarRoutes {
  readonly routes: readonly Route<'client'>[];
  readonly #options: AvatarRoutesOptions;
  readonly #uploads = perMinute(uploadsPerPerson);
  readonly #uploadsFrom = perMinute(uploadsPerAddress);
  readonly #downloads = perMinute(downloadsPerPerson);

  constructor(options: AvatarRoutesOptions) {
    this.#options = options;
    const route = (method: 'GET' | 'PUT', path: string, handle: Route['handle']): Route<'client'> => ({
      ...{ method, path, access: 'client', handle },
      // What is uploaded is no JSON: its handler reads it.
      bodyLimit: 0,
    });
    this.routes = [
      route('GET', '/api/avatars', (call) => this.#terms(call)),
      route('GET', '/api/avatars/:hash', (call) => this.#download(call)),
      route('PUT', '/api/avatars/:hash', (call) => this.#upload(call)),
    ];
  }

  /** What may be stored, and what of the person who asks is. */
  async #terms(call: Call): Promise<Answer> {
    const { configuration, store } = this.#options;
    const { room, identity } = await requirePass(call, this.#options.tokens);
    const taken = Math.min(mostAvatarBytes, configuration.avatarMegabytes * 2 ** 20);
    return json({ mostBytes: taken, elsewhere: configuration.avatarsFrom, yours: store.keptOf(room, identity) });
  }

  async #download(call: Call): Promise<Answer> {
    const { room, identity } = await requirePass(call, this.#options.tokens);
    await this.#spend(this.#downloads, identity, 'download');
    const bytes = this.#options.store.get(room, hashIn(call));
    if (!bytes) throw new HttpError(404, 'no one in this room has stored such an avatar');
    return { status: 200, headers: asFile, body: bytes };
  }

  async #upload(call: Call): Promise<Answer> {
    const { request } = call;
    const { room, identity, assigned } = await requirePass(call, this.#options.tokens);
    const hash = hashIn(call);
    if (assigned) throw new HttpError(403, 'in the rooms of a study all wear the same avatar');
    if (!this.#options.isSeated(room, identity)) throw new HttpError(403, 'this is for people on a seat of the room');
    if ((request.headers['content-type'] ?? '').toLowerCase() !== glb) throw new HttpError(415, `send ${glb}`);
    const length = lengthOf(request);
    await this.#spend(this.#uploads, identity, 'upload');
    const { network } = clientAddressOf(request, this.#options.configuration.trustProxy);
    await this.#spend(this.#uploadsFrom, network, 'upload');
    const reserved = this.#reserve({ room, identity, address: network }, length);
    try {
      reserved.keep(hash, await this.#receive(request, length, hash));
      return done;
    } finally {
      reserved.cancel();
    }
  }

  #reserve(owner: AvatarOwner, length: number): Reservation {
    const reserved = this.#options.store.reserve(owner, length);
    if (typeof reserved === 'object') return reserved;
    this.#options.metrics.refused('avatar', reserved);
    if (reserved === 'busy') throw new HttpError(409, 'another avatar of yours is on its way');
    if (reserved === 'crowded')
      throw new HttpError(507, 'the people of your network have no place for another avatar here now');
    throw new HttpError(507, 'there is no place for another avatar on this server now');
  }

  /** The file, hashed as it comes: a room never waits for more than one chunk. */
  async #receive(request: IncomingMessage, length: number, expected: string): Promise<Buffer> {
    const bytes = Buffer.allocUnsafeSlow(length);
    const hash = createHash('sha256');
    let at = 0;
    await readBody(request, length, (chunk) => {
      at += chunk.copy(bytes, at);
      hash.update(chunk);
    });
    if (at < length) throw new HttpError(400, 'the body has no end');
    if (hash.digest('base64url') !== expected) throw new HttpError(422, 'the file is not the one that its name says');
    if (!isGlb(bytes)) throw new HttpError(422, 'this is no VRM or GLB file');
    return bytes;
  }

  async #spend(limiter: RateLimiterMemory, who: string, what: string): Promise<void> {
    try {
      await limiter.consume(who);
    } catch (error) {
      if (!(error instanceof RateLimiterRes)) throw error;
      this.#options.metrics.refused('avatar', what);
      const wait = Math.ceil(error.msBeforeNext / 1000);
      throw new HttpError(429, `too many avatars; try again in ${wait} s`, {
        headers: { 'retry-after': String(wait) },
      });
    }
  }
}

function hashIn({ names }: Call): string {
  const hash = names.hash ?? '';
  if (!avatarHash.test(hash)) throw new HttpError(400, 'an avatar’s name is its SHA-256 as base64url, 43 characters');
  return hash;
}

/** How long the file will be [bytes]: what does not say so beforehand is not taken, as no place could be kept for it. */
function lengthOf({ headers }: IncomingMessage): number {
  const said = headers['content-length'];
  if (said === undefined || headers['transfer-encoding'] !== undefined) {
    throw new HttpError(411, 'say how long the file is');
  }
  const length = Number(said);
  if (length > mostAvatarBytes) throw new HttpError(413, `an avatar has at most ${mostAvatarBytes} bytes`);
  return length;
}
