import type { PhraseKey } from '../phrases/english';

/** A game that studies can use as a task. */
interface StudiedGame {
  /** The number of participants who play together. A game of several is played in a room of the server. */
  readonly players: number;
  /** The reason for the number of players, as a message gives it. */
  readonly because: string;
  /** The phrase with the rules, which participants read before a round. */
  readonly ready: PhraseKey;
  /** The remark for experimenters whose conditions need a mirror that the game does not have; null: it has one. */
  readonly unmirrored: string | null;
  /** The figure of the paper that shows the scores; null: the paper has none. */
  readonly paperFigure: number | null;
}

/**
 * The games of studies by their names in plans. A score of archery would count for all of a group, and a ball game of a
 * study waits for every seat.
 */
export const studiedGames = {
  archery: {
    players: 1,
    because: 'archery is played alone',
    ready: 'ready.archery',
    unmirrored: null,
    paperFigure: 12,
  },
  ball: {
    players: 3,
    because: 'the ball game is played by three',
    ready: 'ready.ball',
    unmirrored: 'the ball game has no mirror',
    paperFigure: 14,
  },
} as const satisfies Readonly<Record<string, StudiedGame>>;

export type GameName = keyof typeof studiedGames;

export const gameNames = Object.keys(studiedGames) as readonly GameName[];
