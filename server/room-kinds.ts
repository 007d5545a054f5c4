import { BallPolicy } from '../src/core/match-policies/ball-policy';
import { ballKind } from '../src/core/protocol/ball-messages';
import type { RoomTerms } from '../src/core/protocol/messages';
import type { HostedGame, MatchPolicy } from '../src/core/room/match-policy';

/**
 * The games that rooms of a server may be for, by the name that pages ask for: the policy of a room with these terms. `assigned`: every
 * seat is one person's own, without whom no match begins.
 */
export type RoomKinds = ReadonlyMap<string, (terms: RoomTerms, assigned: boolean) => MatchPolicy<HostedGame>>;

/** The games of this project. `ballSeconds`: length of a round of the ball game where the terms name none. */
export const shippedRoomKinds = ({ ballSeconds }: { readonly ballSeconds: number }): RoomKinds =>
  new Map([
    [
      ballKind,
      ({ pausable: _, ...ball }, assigned) => new BallPolicy({ seconds: ballSeconds, ...ball, everySeat: assigned }),
    ],
  ]);
