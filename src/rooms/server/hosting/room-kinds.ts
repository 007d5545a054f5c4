import type { RoomTerms } from '../../protocol/messages';
import type { HostedGame, MatchPolicy } from '../../room/match-policy';

/**
 * The games that rooms of a server may be for, by the name that pages ask for: the policy of a room with these terms. `assigned`: every
 * seat is one person's own, without whom no match begins.
 */
export type RoomKinds = ReadonlyMap<string, (terms: RoomTerms, assigned: boolean) => MatchPolicy<HostedGame>>;
