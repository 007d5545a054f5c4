import {
  type AvatarExchange,
  fetchVoiceSettings,
  type LocalClock,
  type VoiceSettings,
} from 'threepoint-rooms/internal';
import { type ClientPolicy, type Connection, type HostedGame, LoopbackHost, type Visitor } from 'threepoint-rooms/room';
import type { SignedSeat } from 'threepoint-study';
import { pageFolder } from 'threepoint-ui';
import type { ActivityContext } from '../../activity/activity-context';
import type { SeatedGame } from './seated-game';

/** A room to play in. */
export interface PlayRoom<Game extends HostedGame> {
  /** Connects a visitor to the room; `time`: the page's clock [s]. */
  connect(visitor: Visitor, time: number): Connection<Game>;
  /** The exchange of the players' avatar files; null: avatars are not exchanged. */
  readonly avatars: AvatarExchange | null;
  /** Asks whether its people can talk; null: they cannot. */
  readonly voiceTerms: (() => Promise<VoiceSettings>) | null;
  /** Other people can be in it. */
  readonly shared: boolean;
}

/**
 * Connects to the seat that a server assigns by a signed pass. An expired pass is requested again. All players wear the
 * same avatar there.
 */
export async function assignedSeat<Game extends HostedGame>(
  policy: ClientPolicy<Game>,
  seat: () => Promise<SignedSeat>,
  clock: LocalClock,
): Promise<PlayRoom<Game>> {
  const [{ RoomAddress }, first] = await Promise.all([import('threepoint-rooms/socket'), seat()]);
  const pass = { token: async (afresh: boolean) => (afresh ? await seat() : first).token };
  const address = new RoomAddress(policy, { url: pageFolder(), room: first.room, clock, pass });
  return { connect: (visitor) => address.connect(visitor), avatars: null, voiceTerms: null, shared: true };
}

/** Connects to the room of this name on the page's server. The first page in it sets its terms. */
async function sharedRoom<Game extends HostedGame>(
  policy: ClientPolicy<Game>,
  room: string,
  terms: object,
  clock: LocalClock,
): Promise<PlayRoom<Game>> {
  const { RoomAddress, tabStorage } = await import('threepoint-rooms/socket');
  const storage = tabStorage();
  const url = pageFolder();
  const address = new RoomAddress(policy, { ...{ url, room, clock, terms }, ...(storage && { storage }) });
  return {
    connect: (visitor) => address.connect(visitor),
    avatars: address.avatars,
    voiceTerms: () => fetchVoiceSettings(url, room, address.pass),
    shared: true,
  };
}

/** Returns the room to play in: the one that a study assigned, the one in the address, or one in this page. */
export async function roomFor<Game extends HostedGame>(
  game: SeatedGame<Game>,
  { place, switches, clock, server, layout }: ActivityContext,
): Promise<PlayRoom<Game>> {
  if (place) return assignedSeat(game.policy, place.seat, clock);
  // A server that does not answer now may answer later. Without a server the match is in this page.
  const terms = game.terms(switches);
  if (switches.room !== null && (await server.whenKnown()) !== 'none') {
    return sharedRoom(game.policy, switches.room, terms, clock);
  }
  const host = new LoopbackHost(game.matchPolicy(terms, layout.seed), game.policy);
  return { connect: (visitor, time) => host.connect(visitor, time), avatars: null, voiceTerms: null, shared: false };
}
