import type { RoomTerms } from '../../protocol/messages';
import type { HostedGame, MatchPolicy } from '../../room/match-policy';

/**
 * The games of a server, by name: each creates the policy of a room with these terms. `assigned`: every seat is
 * assigned to one person, and a match starts only when all are present.
 */
export type RoomKinds = ReadonlyMap<string, (terms: RoomTerms, assigned: boolean) => MatchPolicy<HostedGame>>;
