import { BallPolicy, ballKind } from 'threepoint-games/ball';
import type { RoomKinds } from 'threepoint-rooms/server';

/** Returns the games of this project. `ballSeconds`: length of a round of the ball game whose room has no terms. */
export const shippedRoomKinds = ({ ballSeconds }: { readonly ballSeconds: number }): RoomKinds =>
  new Map([
    [
      ballKind,
      ({ pausable: _, ...ball }, assigned) => new BallPolicy({ seconds: ballSeconds, ...ball, everySeat: assigned }),
    ],
  ]);
