import { plainAvatar } from 'threepoint/core/body/avatar-ref';
import type { ActivityContext } from '../activity/activity-context';
import { CourtActivity } from './court-activity';
import { assignedSeat, type BallPlace, connectionsFor } from './match/ball-connections';

/** Returns the room to play in: the one that a study assigned, the one in the address, or one in this page. */
async function roomFor({ place, switches, clock, server, layout }: ActivityContext): Promise<BallPlace> {
  if (place) return assignedSeat(place.seat, clock);
  // A server that does not answer now may answer later. Without a server the match is in this page.
  const hosted = switches.room !== null && (await server.known()) !== 'none';
  return connectionsFor(hosted ? switches.room : null, {
    seed: layout.seed,
    clock,
    ...(switches.seconds && { seconds: switches.seconds }),
    ...(switches.balls && { balls: switches.balls }),
  });
}

/** Downloads the body of other players and connects to the room. Rejects with a reason. */
export async function openCourt(context: ActivityContext): Promise<CourtActivity> {
  const [mannequin, room] = await Promise.all([context.fetchBuiltInAvatar(plainAvatar), roomFor(context)]);
  return new CourtActivity(context, room, mannequin);
}
