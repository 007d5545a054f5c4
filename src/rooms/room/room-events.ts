import type { HostedGame, MatchPolicy } from './match-policy';
import type { RoomHost } from './room-host';
import type { Seats } from './seats';

/** The sink for the events of a match. */
export interface EventRecipients<Game extends HostedGame> {
  readonly policy: Pick<MatchPolicy<Game>, 'refusalOf'>;
  readonly seats: Pick<Seats, 'at'>;
  readonly host: Pick<RoomHost<Game>, 'broadcast' | 'send' | 'refused'>;
}

/** Sends what happened to all, and each refusal to the player whose action it refuses. */
export function sendEvents<Game extends HostedGame>(
  events: readonly Game['event'][],
  { policy, seats, host }: EventRecipients<Game>,
): void {
  const shared = events.filter((event) => !policy.refusalOf(event));
  if (shared.length > 0) host.broadcast({ type: 'events', events: shared });
  for (const event of events) {
    const refusal = policy.refusalOf(event);
    const client = refusal && seats.at(refusal.player)?.client;
    if (!refusal || !client) continue;
    host.send(client, { type: 'events', events: [event] });
    host.refused({ client, seat: refusal.player, what: 'action', reason: refusal.reason });
  }
}
