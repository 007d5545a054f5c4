// "threepoint-games/all": the games of this project, as servers and studies know them.
import { archery } from './archery/description';
import { ball } from './ball/description';
import type { GameDescription } from './game-description';

export type { GameDescription, SimulatedGame } from './game-description';

/** The games by their names in plans and rooms. A new game is a line here and one in the page's activities. */
export const games = {
  archery,
  ball,
} as const satisfies Readonly<Record<string, GameDescription>>;

export type GameName = keyof typeof games;
/** Why a round of a game ends before its time. */
export type GameEnd = (typeof games)[GameName]['ends'][number];

export const gameNames = Object.keys(games) as readonly GameName[];
