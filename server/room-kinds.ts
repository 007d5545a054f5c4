import { ballKind, ballRoomKind } from 'threepoint-games/ball';
import type { RoomKinds } from 'threepoint-rooms/room';
import { type Environment, numberFrom } from 'threepoint-rooms/settings';

/** Returns the games of this project. Throws a ConfigurationError. */
export const shippedRoomKinds = (environment: Environment): RoomKinds =>
  new Map([[ballKind, ballRoomKind(numberFrom(environment, 'THREEPOINT_BALL_SECONDS', 90, 1, 3600))]]);
