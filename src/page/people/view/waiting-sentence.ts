import type { HostedGame } from 'threepoint-rooms/room';
import type { SeatedGame } from '../match/seated-game';
import { type DisplayedMatch, markedName, presentPlayers } from './displayed-match';

const listed = (names: readonly string[]): string =>
  names.length < 2 ? (names[0] ?? '') : `${names.slice(0, -1).join(', ')} and ${names.at(-1)}`;

/** Describes what a match waits for; null: it is running. */
export function waitingSentence<Game extends HostedGame>(
  game: Pick<SeatedGame<Game>, 'lacks'>,
  match: DisplayedMatch<Game['state']>,
): string | null {
  const { state, players, me, readyByItself } = match;
  if (state.phase === 'running') return null;
  const lack = game.lacks(match);
  if (lack !== null) return `${lack}.`;
  const idle = presentPlayers(match).filter((player) => !state.players[player]?.ready);
  const names = idle.flatMap((player) => (player !== me && players[player] ? [markedName(players[player])] : []));
  const press = state.phase === 'over' ? 'Play again' : 'Ready';
  if (me !== null && !readyByItself && idle.includes(me))
    return `Waiting for ${listed(['you', ...names])}: press ${press}.`;
  return names.length > 0 ? `Waiting for ${listed(names)}.` : 'The match starts in a moment.';
}
