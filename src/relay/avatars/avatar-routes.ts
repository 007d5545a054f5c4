import { createHash } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import { RateLimiterMemory } from 'rate-limiter-flexible';
import { avatarHashPattern, maxAvatarBytes } from 'threepoint/core';
import {
  type Call,
  clientAddressOf,
  consumePoint,
  HttpError,
  type HttpResponse,
  jsonResponse,
  noContent,
  type Route,
  readBody,
  tooManyRequests,
} from 'threepoint-http';
import { requirePass } from '../access/require-pass';
import type { RelayContext } from '../relay-context';
import type { AvatarOwner, AvatarStore, Reservation } from './avatar-store';

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
 * Returns the routes for uploading and downloading the avatars of a room's members. A proxy in front of several
 * processes routes by `?room=`. `isSeated`: whether a person has a seat in a room of this process, or one is held for
 * them.
 */
export function avatarRoutes(
  { configuration, tokens, metrics }: Pick<RelayContext, 'configuration' | 'tokens' | 'metrics'>,
  store: AvatarStore,
  isSeated: (room: string, identity: string) => boolean,
): readonly Route<'client'>[] {
  const uploads = perMinute(uploadsPerPerson);
  const uploadsFrom = perMinute(uploadsPerAddress);
  const downloads = perMinute(downloadsPerPerson);

  async function spend(limiter: RateLimiterMemory, key: string, what: string): Promise<void> {
    const wait = await consumePoint(limiter, key);
    if (wait === null) return;
    metrics.refused('avatar', what);
    throw tooManyRequests(`too many avatars; try again in ${wait} s`, wait);
  }

  /** Answers with the size limit, and with the hash of the person's stored file. */
  async function answerTerms(call: Call): Promise<HttpResponse> {
    const { room, identity } = await requirePass(call, tokens);
    return jsonResponse({
      maxBytes: Math.min(maxAvatarBytes, configuration.avatarMegabytes * 2 ** 20),
      elsewhere: configuration.avatarsFrom,
      yours: store.hashOf(room, identity),
    });
  }

  async function download(call: Call): Promise<HttpResponse> {
    const { room, identity } = await requirePass(call, tokens);
    await spend(downloads, identity, 'download');
    const bytes = store.get(room, hashIn(call));
    if (!bytes) throw new HttpError(404, 'nobody in this room has uploaded this avatar');
    return { status: 200, headers: asFile, body: bytes };
  }

  function reserve(owner: AvatarOwner, length: number): Reservation {
    const reserved = store.reserve(owner, length);
    if (typeof reserved === 'object') return reserved;
    metrics.refused('avatar', reserved);
    if (reserved === 'busy')
      throw new HttpError(409, 'another upload of yours is under way; try again when it has ended');
    if (reserved === 'crowded')
      throw new HttpError(507, 'the avatars from your network use all their space on this server; try again later');
    throw new HttpError(507, 'this server has no space for another avatar; try again later');
  }

  async function upload(call: Call): Promise<HttpResponse> {
    const { request } = call;
    const { room, identity, assigned } = await requirePass(call, tokens);
    const hash = hashIn(call);
    if (assigned) throw new HttpError(403, 'in the rooms of a study everybody has the same avatar');
    if (!isSeated(room, identity)) throw new HttpError(403, 'only people on a seat of the room may upload avatars');
    if ((request.headers['content-type'] ?? '').toLowerCase() !== glb) throw new HttpError(415, `send ${glb}`);
    const length = lengthOf(request);
    await spend(uploads, identity, 'upload');
    const { network } = clientAddressOf(request, configuration.trustProxy);
    await spend(uploadsFrom, network, 'upload');
    const reserved = reserve({ room, identity, address: network }, length);
    try {
      reserved.store(hash, await receiveFile(request, length, hash));
      return noContent;
    } finally {
      reserved.cancel();
    }
  }

  // Uploads are not JSON: their handler reads them.
  const common = { access: 'client', bodyLimit: 0 } as const;
  return [
    { ...common, method: 'GET', path: '/api/avatars', handle: answerTerms },
    { ...common, method: 'GET', path: '/api/avatars/:hash', handle: download },
    { ...common, method: 'PUT', path: '/api/avatars/:hash', handle: upload },
  ];
}

/** Reads the file and hashes each chunk as it arrives, so that rooms are never blocked for long. */
async function receiveFile(request: IncomingMessage, length: number, expected: string): Promise<Buffer> {
  const bytes = Buffer.allocUnsafeSlow(length);
  const hash = createHash('sha256');
  let at = 0;
  await readBody(request, length, (chunk) => {
    at += chunk.copy(bytes, at);
    hash.update(chunk);
  });
  if (at < length) throw new HttpError(400, 'the body has no end');
  if (hash.digest('base64url') !== expected) throw new HttpError(422, 'the SHA-256 of the file differs from its name');
  if (!isGlb(bytes)) throw new HttpError(422, 'this is not a VRM or GLB file');
  return bytes;
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
