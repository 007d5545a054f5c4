import { integerWithin, type RoomKind } from 'threepoint-rooms/room';
import * as v from 'valibot';
import { BallPolicy } from './ball-policy';

const seconds = v.exactOptional(v.pipe(v.number(), v.finite(), v.minValue(1), v.maxValue(3600)));
const openTerms = v.strictObject({ seconds, balls: v.exactOptional(integerWithin(1, 20)) });

/**
 * The terms of a room of the ball game: length of a round [s] and number of balls; with assigned seats also the longest
 * wait for a player who is away [s].
 */
export type BallTerms = v.InferOutput<typeof openTerms> & { readonly waitSeconds?: number };

/** Returns the ball game for a server. `defaultSeconds`: length of a round whose room has no terms. */
export const ballRoomKind = (defaultSeconds: number): RoomKind<BallTerms> => ({
  openTerms,
  assignedTerms: v.strictObject({ seconds, waitSeconds: seconds }),
  createPolicy: (terms, assigned) => new BallPolicy({ seconds: defaultSeconds, ...terms, everySeat: assigned }),
});
