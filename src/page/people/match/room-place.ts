import { type BallConnection, type BallTerms, ballClientPolicy, createBallLoopbackHost } from 'threepoint-games/ball';
import { type AvatarExchange, fetchVoiceSettings, type VoiceSettings } from 'threepoint-rooms';
import type { LocalClock, Visitor } from 'threepoint-rooms/room';
import type { SignedSeat } from 'threepoint-study';
import { pageFolder } from 'threepoint-ui';

/** Makes one visitor's place in a room; `time`: the page's clock [s]. */
export type Connect = (visitor: Visitor, time: number) => BallConnection;

/** A room to play in. */
export interface BallPlace {
  readonly connect: Connect;
  /** The exchange of the players' avatar files; null: avatars are not exchanged. */
  readonly avatars: AvatarExchange | null;
  /** Asks whether its people can talk; null: they cannot. */
  readonly voiceTerms: (() => Promise<VoiceSettings>) | null;
}

/**
 * Connects to the seat that a server assigns by a signed pass. An expired pass is requested again. All players wear the
 * same avatar there.
 */
export async function assignedSeat(seat: () => Promise<SignedSeat>, clock: LocalClock): Promise<BallPlace> {
  const [{ RoomAddress }, first] = await Promise.all([import('threepoint-rooms/socket'), seat()]);
  const pass = { token: async (afresh: boolean) => (afresh ? await seat() : first).token };
  const address = new RoomAddress(ballClientPolicy, { url: pageFolder(), room: first.room, clock, pass });
  return { connect: (visitor) => address.connect(visitor), avatars: null, voiceTerms: null };
}

/**
 * Places in a room of this name on the server that the page came from; null: in a Room of this page's own. `terms`: of
 * the match, on a server those of the first page in the room; a room of one's own may be paused in any case.
 */
export async function connectionsFor(
  room: string | null,
  { seed, clock, ...terms }: BallTerms & { readonly seed: number; readonly clock: LocalClock },
): Promise<BallPlace> {
  if (room === null) {
    const host = createBallLoopbackHost({ seed, ball: terms });
    return { connect: (visitor, time) => host.connect(visitor, time), avatars: null, voiceTerms: null };
  }
  const { RoomAddress, tabStorage } = await import('threepoint-rooms/socket');
  const storage = tabStorage();
  const address = new RoomAddress(ballClientPolicy, {
    ...{ url: pageFolder(), room, clock, terms },
    ...(storage && { storage }),
  });
  return {
    connect: (visitor) => address.connect(visitor),
    avatars: address.avatars,
    voiceTerms: () => fetchVoiceSettings(pageFolder(), room, address.pass),
  };
}
