import { randomBytes } from 'node:crypto';
import { errors, jwtVerify, SignJWT } from 'jose';
import { isObject } from 'threepoint/core';
import { maxSeats } from 'threepoint-rooms/host';
import type { RoomKinds } from 'threepoint-rooms/room';
import * as v from 'valibot';

/** The seat and name that a study assigns to a participant; seat null: a spectator. */
export interface AssignedSeat {
  readonly seat: number | null;
  readonly name: string;
}

/** The claims of a token: the person and the room. Only the server reads them; other players see a seat and a name. */
export interface PassClaims {
  readonly identity: string;
  readonly room: string;
  /** The name of the game. */
  readonly kind: string;
  /** The terms of the room, if this person is the first in it. Not checked: see `allowedTerms`. */
  readonly terms: object;
  /** The assigned seat; null: a room with free choice of seats. */
  readonly assigned: AssignedSeat | null;
}

/** Returns the terms of a pass; null: its game does not allow them, or the server does not have the game. */
export function allowedTerms(kinds: RoomKinds, { kind, terms, assigned }: Omit<PassClaims, 'identity'>): object | null {
  const game = kinds.get(kind);
  const checked = game && v.safeParse(assigned ? game.assignedTerms : game.openTerms, terms);
  return checked?.success ? checked.output : null;
}

/** Names of rooms: short, valid in an address and easy to spell out. */
export const roomName = /^[a-z0-9][a-z0-9-]{0,31}$/;
/** Names of rooms with assigned seats; other rooms cannot have such a name. Proxies route by 32 characters at most. */
export const assignedRoomName = /^study\.[0-9a-f]{24}$/;

const lifeSeconds = 15 * 60;
/** A token may be renewed this long after it has expired [s]. */
const renewalSeconds = 12 * 3600;
const issuer = 'threepoint';
const algorithm = 'HS256';
const longestToken = 1024;

const assignedSeat = v.nullable(
  v.strictObject({
    seat: v.nullable(v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(maxSeats - 1))),
    name: v.string(),
  }),
);

/** Signs and verifies room passes as JSON Web Tokens that expire. */
export class RoomTokens {
  readonly #key: Uint8Array;
  readonly #now: () => number;

  /** `now`: seconds since 1970. */
  constructor(secret: string, now: () => number) {
    this.#key = new TextEncoder().encode(secret);
    this.#now = now;
  }

  /** Returns a token for a new person. */
  issue(room: string, kind: string, terms: object = {}): Promise<string> {
    return this.sign({ identity: randomBytes(12).toString('base64url'), room, kind, terms, assigned: null });
  }

  /** Returns a new token for the same person. */
  sign({ identity, room, kind, terms, assigned }: PassClaims): Promise<string> {
    const now = Math.floor(this.#now());
    return new SignJWT({ room, kind, terms, ...(assigned && { assigned: { ...assigned } }) })
      .setProtectedHeader({ alg: algorithm })
      .setIssuer(issuer)
      .setSubject(identity)
      .setIssuedAt(now)
      .setExpirationTime(now + lifeSeconds)
      .sign(this.#key);
  }

  /** Verifies a token that may have expired within the last 12 hours; it permits renewal, not entry. */
  verifyRenewable(token: string): Promise<PassClaims | null> {
    return this.#read(token, renewalSeconds);
  }

  /** Returns the claims of a token; null: not signed by this server, modified, or expired. */
  verify(token: string): Promise<PassClaims | null> {
    return this.#read(token, 5);
  }

  async #read(token: string, tolerance: number): Promise<PassClaims | null> {
    if (token.length > longestToken) return null;
    try {
      const { payload } = await jwtVerify(token, this.#key, {
        issuer,
        algorithms: [algorithm],
        currentDate: new Date(this.#now() * 1000),
        clockTolerance: tolerance,
      });
      const { sub: identity, room, kind, terms = {} } = payload;
      const assigned = v.safeParse(assignedSeat, payload.assigned ?? null);
      if (!identity || typeof room !== 'string' || typeof kind !== 'string' || !isObject(terms) || !assigned.success)
        return null;
      // The name shows whether a room has assigned seats.
      const named = assigned.output ? assignedRoomName : roomName;
      return named.test(room) ? { identity, room, kind, terms, assigned: assigned.output } : null;
    } catch (error) {
      if (error instanceof errors.JOSEError) return null;
      throw error;
    }
  }
}
