import { type GameDescription, games } from 'threepoint-games/all';
import { numberFrom } from 'threepoint-http';
import type { RoomKinds } from 'threepoint-rooms/room';

/** The games of this project that have rooms, and the variable of the environment for the length of a round. */
export const gamesWithRooms = Object.entries<GameDescription>(games).flatMap(([name, { rooms }]) =>
  rooms ? [{ name, rooms, variable: `THREEPOINT_${name.toUpperCase()}_SECONDS` }] : [],
);

/** Returns the rooms of the games of this project. Rejects with a ConfigurationError. */
export async function shippedRoomKinds(environment: NodeJS.ProcessEnv): Promise<RoomKinds> {
  const kinds = gamesWithRooms.map(async ({ name, rooms, variable }) => {
    const seconds = numberFrom(environment, variable, rooms.seconds, 1, 3600);
    return [name, await rooms.createKind(seconds)] as const;
  });
  return new Map(await Promise.all(kinds));
}
