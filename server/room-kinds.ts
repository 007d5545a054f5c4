import { ballKind, ballRoomKind } from 'threepoint-games/ball';
import { numberFrom } from 'threepoint-http';
import type { RoomKinds } from 'threepoint-rooms/room';

/** Returns the games of this project. Throws a ConfigurationError. */
export const shippedRoomKinds = (environment: NodeJS.ProcessEnv): RoomKinds =>
  new Map([[ballKind, ballRoomKind(numberFrom(environment, 'THREEPOINT_BALL_SECONDS', 90, 1, 3600))]]);
