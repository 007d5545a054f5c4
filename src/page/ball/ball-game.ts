import {
  type BallGame,
  BallPolicy,
  type BallRole,
  type BallTerms,
  ballClientPolicy,
  ballKind,
  ballRulesText,
  ballsLeft,
  catchesOf,
  defaultBallOptions,
  displayedSeconds,
  rotationForRound,
} from 'threepoint-games/ball';
import type { SeatedGame } from '../people/match/seated-game';
import { type DisplayedMatch, presentPlayers } from '../people/view/displayed-match';
import { waitingLine } from './view/match-texts';

/** How a player without a headset plays, by role. */
const hints: Readonly<Record<'mouse' | 'touch', Readonly<Record<BallRole, string>>>> = {
  mouse: {
    thrower:
      'Point at the basket and hold the button. The ring shows where the ball will land. Release the button when it is green. Esc cancels the throw.',
    holder: 'Point to where you want the basket. It turns towards the balls by itself.',
  },
  touch: {
    thrower:
      'Put a finger on the basket. The ring shows where the ball will land. Lift the finger when the ring is green. A second finger cancels the throw.',
    holder: 'Put a finger where you want the basket. It turns towards the balls by itself.',
  },
};

/** Returns which role a match lacks. Roles move on between two matches alone. */
function lackedRole(match: DisplayedMatch<BallGame['state']>): string | null {
  const { state } = match;
  const present = presentPlayers(match);
  const taken = present.flatMap((player) => state.players[player]?.station ?? []);
  const isFull = present.length === state.players.length || !state.options.everySeat;
  if (isFull && rotationForRound(taken, state.rotate && state.phase === 'over') !== null) return null;
  return waitingLine({ ...match, state: { ...state, phase: 'ready' } });
}

/** The ball game as rooms, boards and panels of the page know it. */
export const ballGame: SeatedGame<BallGame> = {
  name: ballKind,
  policy: ballClientPolicy,
  terms: ({ seconds, balls }): BallTerms => ({ ...(seconds && { seconds }), ...(balls && { balls }) }),
  matchPolicy: (terms, seed) => new BallPolicy({ ...terms, seed }),
  roles: ['Thrower 1', 'Thrower 2', 'Basket holder'],
  bots: true,
  stationOf: ({ players }, seat) => players[seat]?.station ?? seat,
  figures: ({ score, options, startedAt, end }) => ({
    ...{ score, of: options.balls },
    ...{ seconds: options.seconds, startedAt, end },
  }),
  secondsLeft: displayedSeconds,
  remainder: (state) => `${ballsLeft(state)} ${ballsLeft(state) === 1 ? 'ball' : 'balls'}`,
  lobby: ({ phase, end, options: { balls, seconds } }) => ({
    heading: phase !== 'over' ? 'Ball game' : end === 'time' ? 'Time is up' : 'All balls thrown',
    about: [
      'Two players throw, one catches with the basket.',
      `${balls} balls, ${Math.round(seconds)} seconds, a point per catch`,
    ],
    result: `of ${balls} caught`,
  }),
  resultOf: (state, seat) => (state.players[seat]?.role === 'thrower' ? `${catchesOf(state, seat)} caught` : null),
  lacks: lackedRole,
  rules(state) {
    const { balls, seconds } = state?.options ?? defaultBallOptions;
    return ballRulesText(balls, seconds);
  },
  hint: ({ players }, seat, touch) => hints[touch ? 'touch' : 'mouse'][players[seat]?.role ?? 'holder'],
  option: { label: 'Swap roles after each match', shortLabel: 'Swap roles', isOn: ({ rotate }) => rotate },
};
