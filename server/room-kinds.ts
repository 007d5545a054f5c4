import { type GameDescription, games } from 'threepoint-games/all';
import { numberFrom } from 'threepoint-http';
import type { RoomKind, RoomKinds } from 'threepoint-rooms/room';

/**
 * Returns the games of this project that have rooms; THREEPOINT_NAME_SECONDS is the length of a round. Rejects with a
 * ConfigurationError.
 */
export async function shippedRoomKinds(environment: NodeJS.ProcessEnv): Promise<RoomKinds> {
  const kinds = new Map<string, RoomKind>();
  for (const [name, { rooms }] of Object.entries<GameDescription>(games)) {
    if (!rooms) continue;
    const seconds = numberFrom(environment, `THREEPOINT_${name.toUpperCase()}_SECONDS`, rooms.seconds, 1, 3600);
    kinds.set(name, await rooms.createKind(seconds));
  }
  return kinds;
}
