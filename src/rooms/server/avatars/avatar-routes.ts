import { createHash } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import { avatarHashPattern, maxAvatarBytes } from 'threepoint/core/body/avatar-ref';
import { clientAddressOf } from 'threepoint-http/client-address';
import { HttpError } from 'threepoint-http/http-error';
import { readBody } from 'threepoint-http/request-body';
import { type HttpResponse, jsonResponse, noContent } from 'threepoint-http/response';
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
  /** Returns whether a person has a seat in a room of this process, or one is held for them. */
  readonly isSeated: (room: string, identity: string) => boolean;
}

/** Uploads a minute of a person and of an address, and downloads of a person. */
const uploadsPerPerson = 4;
const uploadsPerAddress = 20;
const downloadsPerPerson = 60;

const glb = 'model/gltf-binary';
/** The header of a GLB file: "glTF" and version 2; the file's length follows. */
const glbHead = Buffer.from([0x67, 0x6c, 0x54, 0x46, 2, 0, 0, 0]);

const isGlb = (bytes: Buffer): boolean =>
  bytes.length >= 20 && bytes.subarray(0, 8).equals(glbHead) && bytes.readUInt32LE(8) === bytes.length;

/** Headers of a stored file: browsers save it, and never display it or run scripts in it. */
const asFile: Readonly<Record<string, string>> = {
  'content-type': glb,
  'content-disposition': 'attachment; filename="avatar.glb"',
  'content-security-policy': "default-src 'none'; sandbox",
};

const perMinute = (points: number): RateLimiterMemory => new RateLimiterMemory({ points, duration: 60 });

/**
 * The routes for uploading and downloading the avatars of a room's members. A proxy in front of several processes
 * routes by `?room=`.
 */
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
      // Uploads are not JSON: their handler reads them.
      bodyLimit: 0,
    });
    this.routes = [
      route('GET', '/api/avatars', (call) => this.#terms(call)),
      route('GET', '/api/avatars/:hash', (call) => this.#download(call)),
      route('PUT', '/api/avatars/:hash', (call) => this.#upload(call)),
    ];
  }

  /** Answers with the size limit, and with the hash of the person's stored file. */
  async #terms(call: Call): Promise<HttpResponse> {
    const { configuration, store } = this.#options;
    const { room, identity } = await requirePass(call, this.#options.tokens);
    const taken = Math.min(maxAvatarBytes, configuration.avatarMegabytes * 2 ** 20);
    return jsonResponse({
      maxBytes: taken,
      elsewhere: configuration.avatarsFrom,
      yours: store.hashOf(room, identity),
    });
  }

  async #download(call: Call): Promise<HttpResponse> {
    const { room, identity } = await requirePass(call, this.#options.tokens);
    await this.#spend(this.#downloads, identity, 'download');
    const bytes = this.#options.store.get(room, hashIn(call));
    if (!bytes) throw new HttpError(404, 'nobody in this room has uploaded this avatar');
    return { status: 200, headers: asFile, body: bytes };
  }

  async #upload(call: Call): Promise<HttpResponse> {
    const { request } = call;
    const { room, identity, assigned } = await requirePass(call, this.#options.tokens);
    const hash = hashIn(call);
    if (assigned) throw new HttpError(403, 'in the rooms of a study everybody has the same avatar');
    if (!this.#options.isSeated(room, identity))
      throw new HttpError(403, 'only people on a seat of the room may upload avatars');
    if ((request.headers['content-type'] ?? '').toLowerCase() !== glb) throw new HttpError(415, `send ${glb}`);
    const length = lengthOf(request);
    await this.#spend(this.#uploads, identity, 'upload');
    const { network } = clientAddressOf(request, this.#options.configuration.trustProxy);
    await this.#spend(this.#uploadsFrom, network, 'upload');
    const reserved = this.#reserve({ room, identity, address: network }, length);
    try {
      reserved.keep(hash, await this.#receive(request, length, hash));
      return noContent;
    } finally {
      reserved.cancel();
    }
  }

  #reserve(owner: AvatarOwner, length: number): Reservation {
    const reserved = this.#options.store.reserve(owner, length);
    if (typeof reserved === 'object') return reserved;
    this.#options.metrics.refused('avatar', reserved);
    if (reserved === 'busy')
      throw new HttpError(409, 'another upload of yours is under way; try again when it has ended');
    if (reserved === 'crowded')
      throw new HttpError(507, 'the avatars from your network use all their space on this server; try again later');
    throw new HttpError(507, 'this server has no space for another avatar; try again later');
  }

  /** Reads the file and hashes each chunk as it arrives, so that rooms are never blocked for long. */
  async #receive(request: IncomingMessage, length: number, expected: string): Promise<Buffer> {
    const bytes = Buffer.allocUnsafeSlow(length);
    const hash = createHash('sha256');
    let at = 0;
    await readBody(request, length, (chunk) => {
      at += chunk.copy(bytes, at);
      hash.update(chunk);
    });
    if (at < length) throw new HttpError(400, 'the body has no end');
    if (hash.digest('base64url') !== expected)
      throw new HttpError(422, 'the SHA-256 of the file differs from its name');
    if (!isGlb(bytes)) throw new HttpError(422, 'this is not a VRM or GLB file');
    return bytes;
  }

  async #spend(limiter: RateLimiterMemory, key: string, what: string): Promise<void> {
    try {
      await limiter.consume(key);
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
  if (!avatarHashPattern.test(hash))
    throw new HttpError(400, 'the name of an avatar must be its SHA-256 as base64url, 43 characters');
  return hash;
}

/** Returns the length of the file [bytes]. Throws an HttpError 411 without one, because space must be reserved. */
function lengthOf({ headers }: IncomingMessage): number {
  const text = headers['content-length'];
  if (text === undefined || headers['transfer-encoding'] !== undefined) {
    throw new HttpError(411, 'the upload needs a Content-Length');
  }
  const length = Number(text);
  if (length > maxAvatarBytes) throw new HttpError(413, `the avatar is larger than ${maxAvatarBytes} bytes`);
  return length;
}
