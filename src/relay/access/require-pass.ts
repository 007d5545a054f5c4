import { type Call, HttpError } from 'threepoint-http';
import type { PassClaims, RoomTokens } from './room-tokens';

/**
 * Returns the pass of a request to the room in its address (`?room=`). Throws an HttpError 401 without a valid pass,
 * 403 for another room.
 */
export async function requirePass({ request, query }: Call, tokens: Pick<RoomTokens, 'verify'>): Promise<PassClaims> {
  const token = /^Bearer (\S{1,1024})$/.exec(request.headers.authorization ?? '')?.[1];
  const pass = token === undefined ? null : await tokens.verify(token);
  if (!pass) throw new HttpError(401, 'this needs a valid pass to the room');
  if (query.get('room') !== pass.room) throw new HttpError(403, 'this pass is for another room');
  return pass;
}
