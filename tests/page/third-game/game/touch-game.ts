import type { SeatedGame } from '../../../../src/page/people/match/seated-game';
import { type TouchGame, touchClientPolicy, touchPolicy } from './touch-rooms';
import { score, touchRules } from './touch-rules';

const left = (seconds: number, tick: number, startedAt: number | null) =>
  startedAt === null ? seconds : Math.max(0, startedAt + seconds - tick * touchRules.tickSeconds);

/** “Touch the lit targets” as rooms, boards and panels of the page know it. */
export const touchGame: SeatedGame<TouchGame> = {
  name: 'touch',
  policy: touchClientPolicy,
  terms: ({ seconds }) => ({ ...(seconds && { seconds }) }),
  matchPolicy: touchPolicy,
  roles: ['Left player', 'Right player'],
  bots: false,
  stationOf: (_state, seat) => seat,
  figures: (state) => ({ ...state, score: score(state), of: state.goal, end: state.end as 'time' | null }),
  secondsLeft: ({ phase, seconds, tick, startedAt }, last) =>
    phase === 'over' ? last : left(seconds, tick, startedAt),
  remainder: (state) => `${state.goal - score(state)} touches`,
  lobby: ({ phase, goal, seconds }) => ({
    heading: phase === 'over' ? 'Over' : 'Touch',
    about: ['Touch the lit targets.', `${goal} targets, ${seconds} seconds`],
    result: `of ${goal} touched`,
  }),
  resultOf: ({ players }, seat) => `${players[seat]?.touched ?? 0} touched`,
  lacks: () => null,
  rules: (state) => [`Touch the lit targets: ${state?.goal ?? 12} in ${state?.seconds ?? 30} seconds.`],
  hint: () => null,
};
