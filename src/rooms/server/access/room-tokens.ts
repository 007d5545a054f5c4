import { randomBytes } from 'node:crypto';
import { errors, jwtVerify, SignJWT } from 'jose';
import * as v from 'valibot';
import { mostSeats, type RoomTerms, roomTerms } from '../../protocol/messages';

/** A place that is one person's own, by the name that it is known under; seat null: among those who watch. */
export interface AssignedPlace {
  readonly seat: number | null;
  readonly name: string;
}

/** What a token says: who a person is in which room. Known to the server alone; others know a seat and a name. */
export interface RoomPass {
  readonly identity: string;
  readonly room: string;
  /** The game that the room is for. */
  readonly kind: string;
  /** What the room is to be like if this person is the first in it. */
  readonly terms: RoomTerms;
  /** Of a room whose places are all assigned; null: a room where a person takes any place that is free. */
  readonly assigned: AssignedPlace | null;
}

/** Passes as signed text that expires. */
export interface RoomTokens {
  /** For a new person. */
  issue(room: string, kind: string, terms?: RoomTerms): Promise<string>;
  /** The same person for longer. */
  sign(pass: RoomPass): Promise<string>;
  /** As `verify`, for a token that has expired within the last hours: good for another one, not for coming in. */
  verifyRenewable(token: string): Promise<RoomPass | null>;
  /** null: not signed by us, changed, or expired. */
  verify(token: string): Promise<RoomPass | null>;
}

/** Names of rooms: what goes into an address and can be told over the telephone. */
export const roomName = /^[a-z0-9][a-z0-9-]{0,31}$/;
/** Names of rooms whose places are assigned: no other room can be called so. Proxies find a room by 32 characters at most. */
export const assignedRoomName = /^study\.[0-9a-f]{24}$/;

const lifeSeconds = 15 * 60;
/** A token may be renewed this long after it has expired [s]. */
const renewalSeconds = 12 * 3600;
const issuer = 'threepoint';
const algorithm = 'HS256';
const longestToken = 1024;

const assignedPlace = v.nullable(
  v.strictObject({
    seat: v.nullable(v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(mostSeats - 1))),
    name: v.string(),
  }),
);

/** `now`: seconds since 1970. */
export function createRoomTokens(secret: string, now: () => number): RoomTokens {
  const key = new TextEncoder().encode(secret);

  const sign = ({ identity, room, kind, terms, assigned }: RoomPass): Promise<string> =>
    new SignJWT({ room, kind, terms, ...(assigned && { assigned: { ...assigned } }) })
      .setProtectedHeader({ alg: algorithm })
      .setIssuer(issuer)
      .setSubject(identity)
      .setIssuedAt(Math.floor(now()))
      .setExpirationTime(Math.floor(now()) + lifeSeconds)
      .sign(key);

  async function read(token: string, tolerance: number): Promise<RoomPass | null> {
    if (token.length > longestToken) return null;
    try {
      const { payload } = await jwtVerify(token, key, {
        issuer,
        algorithms: [algorithm],
        currentDate: new Date(now() * 1000),
        clockTolerance: tolerance,
      });
      const { sub: identity, room, kind } = payload;
      const terms = v.safeParse(roomTerms, payload.terms ?? {});
      const assigned = v.safeParse(assignedPlace, payload.assigned ?? null);
      if (!identity || typeof room !== 'string' || typeof kind !== 'string' || !terms.success || !assigned.success)
        return null;
      // A room has assigned places or it has none: its name tells which.
      const named = assigned.output ? assignedRoomName : roomName;
      return named.test(room) ? { identity, room, kind, terms: terms.output, assigned: assigned.output } : null;
    } catch (error) {
      if (error instanceof errors.JOSEError) return null;
      throw error;
    }
  }

  return {
    issue: (room, kind, terms = {}) =>
      sign({ identity: randomBytes(12).toString('base64url'), room, kind, terms, assigned: null }),
    sign,
    verifyRenewable: (token) => read(token, renewalSeconds),
    verify: (token) => read(token, 5),
  };
}
