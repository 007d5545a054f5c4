import { ballKind } from 'threepoint-games/ball/ball-messages';
import { ballRoomKind } from 'threepoint-games/ball/ball-room-kind';
import type { RoomKinds } from 'threepoint-rooms/room/room-kind';
import { type Environment, numberFrom } from 'threepoint-rooms/server/settings/environment';

/** Returns the games of this project. Throws a ConfigurationError. */
export const shippedRoomKinds = (environment: Environment): RoomKinds =>
  new Map([[ballKind, ballRoomKind(numberFrom(environment, 'THREEPOINT_BALL_SECONDS', 90, 1, 3600))]]);
