import { HttpError } from 'threepoint-http/answer';
import type { Call } from 'threepoint-http/router';
import type { RoomPass, RoomTokens } from './room-tokens';

/** The pass that a request bears to the room that its address names (`?room=`); throws the refusal where it bears none. */
export async function requirePass({ request, query }: Call, tokens: Pick<RoomTokens, 'verify'>): Promise<RoomPass> {
  const token = /^Bearer (\S{1,1024})$/.exec(request.headers.authorization ?? '')?.[1];
  const pass = token === undefined ? null : await tokens.verify(token);
  if (!pass) throw new HttpError(401, 'this needs a pass to the room');
  if (query.get('room') !== pass.room) throw new HttpError(403, 'this pass is to another room');
  return pass;
}
