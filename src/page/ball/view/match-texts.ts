import { type BallEvent, rotationForRound } from 'threepoint-games/ball';
import { type DisplayedMatch, type DisplayedPlayer, markedName } from '../../people/view/displayed-match';

/** Returns the line of the board for an event; null: none. */
export function eventLine(event: BallEvent, people: readonly (DisplayedPlayer | null)[]): string | null {
  const player = 'player' in event ? people[event.player] : null;
  const name = player?.me ? 'you' : player ? markedName(player) : 'A player';
  switch (event.type) {
    case 'started':
      return 'Go!';
    case 'caught':
      return `In! Thrown by ${name}`;
    case 'missed':
      return player?.me ? 'Your ball is on the floor' : `${name}’s ball is on the floor`;
    case 'bounced':
      return event.off === 'basket' ? 'Off the rim' : null;
    case 'left':
      return player?.me ? null : `${name} has left`;
    case 'joined':
      return player?.me ? null : `${name} has joined`;
    default:
      return null;
  }
}

/** Returns the line of the board while nothing happens. */
export function waitingLine({ state, players }: DisplayedMatch): string {
  if (state.phase === 'running') return 'Catch them in the basket';
  if (state.phase === 'over') return state.end === 'time' ? 'Time is up' : 'All balls thrown';
  const there = players.flatMap((person, player) => (person ? [player] : []));
  const roles = new Set(there.map((player) => state.players[player]?.role));
  if (!roles.has('thrower')) return 'Waiting for a thrower';
  if (!roles.has('holder')) return 'Waiting for a basket holder';
  const waiting = there.filter((player) => !state.players[player]?.ready).length;
  return waiting === 1 ? 'Waiting for one player' : `Waiting for ${waiting} players`;
}

const listed = (names: readonly string[]): string =>
  names.length < 2 ? (names[0] ?? '') : `${names.slice(0, -1).join(', ')} and ${names.at(-1)}`;

/** Describes what a match waits for; null: it is running. */
export function waitingSentence(match: DisplayedMatch): string | null {
  const { state, players, me, acting } = match;
  if (state.phase === 'running') return null;
  const there = players.flatMap((person, player) => (person ? [player] : []));
  const taken = there.flatMap((player) => state.players[player]?.station ?? []);
  // Roles move on between two matches alone.
  const canPlay = rotationForRound(taken, state.rotate && state.phase === 'over') !== null;
  if (!canPlay) return `${waitingLine({ ...match, state: { ...state, phase: 'ready' } })}.`;
  const idle = there.filter((player) => !state.players[player]?.ready);
  const names = idle.flatMap((player) => (player !== me && players[player] ? [markedName(players[player])] : []));
  const press = state.phase === 'over' ? 'Play again' : 'Ready';
  if (me !== null && !acting && idle.includes(me)) return `Waiting for ${listed(['you', ...names])}: press ${press}.`;
  return names.length > 0 ? `Waiting for ${listed(names)}.` : 'The match starts in a moment.';
}
