import { ballKind } from 'threepoint-games/ball/ball-messages';
import { BallPolicy } from 'threepoint-games/ball/ball-policy';
import type { RoomKinds } from 'threepoint-rooms/server/hosting/room-kinds';

/** Returns the games of this project. `ballSeconds`: length of a round of the ball game whose room has no terms. */
export const shippedRoomKinds = ({ ballSeconds }: { readonly ballSeconds: number }): RoomKinds =>
  new Map([
    [
      ballKind,
      ({ pausable: _, ...ball }, assigned) => new BallPolicy({ seconds: ballSeconds, ...ball, everySeat: assigned }),
    ],
  ]);
