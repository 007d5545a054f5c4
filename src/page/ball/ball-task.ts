import type { BallGame } from 'threepoint-games/ball';
import type { MatchTask } from '../people/match/match-runner';
import { ballGame } from './ball-game';

/** The ball game as a task of studies. */
export const ballTask: MatchTask<BallGame> = {
  name: 'ball',
  figures: ballGame.figures,
  taskEvents(event, me, at) {
    if (event.type === 'thrown' && event.player === me) return [{ type: 'shot' }];
    if (event.type === 'missed' && event.player === me) return [{ type: 'miss', time: at, points: 0 }];
    // A point is the group's: it is a hit of the thrower, and a catch for the others.
    if (event.type === 'caught') return [{ type: event.player === me ? 'hit' : 'catch', time: at, points: 1 }];
    return [];
  },
};
