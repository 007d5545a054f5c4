import type { RoomKind } from 'threepoint-rooms/room';

/** What participants of a study read about a game. */
interface GamePhrases {
  /** The rules, before a round. */
  readonly ready: string;
  /** The message when the game could not be opened. */
  readonly round: string;
}

/** How a simulated study draws the result of a trial. */
export type SimulatedGame =
  /** One player aims at the best target that is not hit yet; each target counts once. */
  | { readonly points: readonly number[]; readonly attempts: number }
  /** The first players of the group try in turn; a hit is a point for all. */
  | { readonly attempts: number; readonly triers: number };

/** What servers and studies need to know of a game. */
export interface GameDescription {
  /** The number of participants who play together. A game of several is played in a room of the server. */
  readonly players: number;
  /** The reason for the number of players, as a message gives it. */
  readonly because: string;
  /** The remark for experimenters whose conditions need a mirror that the game does not have; null: it has one. */
  readonly unmirrored: string | null;
  /** A questionnaire that plans use by the name of the game, in the format of plans; null: there is none. */
  readonly questionnaire: Readonly<Record<string, unknown>> | null;
  /** The figures of the paper that show the answers and the scores; null: the paper does not have the game. */
  readonly paperFigures: { readonly answers: number; readonly scores: number } | null;
  /** The reasons for which a round ends before its time. */
  readonly ends: readonly string[];
  readonly phrases: Readonly<Record<'en' | 'de', GamePhrases>>;
  readonly simulated: SimulatedGame;
  /** Rooms of the game on a server; null: it is played without others. */
  readonly rooms: {
    /** The length of a round whose room has no terms [s]. */
    readonly seconds: number;
    createKind(seconds: number): Promise<RoomKind>;
  } | null;
}
