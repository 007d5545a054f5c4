import type { BallEvent, BallState } from 'threepoint-games/ball';
import {
  type DisplayedMatch,
  type DisplayedPlayer,
  markedName,
  presentPlayers,
} from '../../people/view/displayed-match';

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
export function waitingLine(match: DisplayedMatch<BallState>): string {
  const { state } = match;
  if (state.phase === 'running') return 'Catch them in the basket';
  if (state.phase === 'over') return state.end === 'time' ? 'Time is up' : 'All balls thrown';
  const there = presentPlayers(match);
  if (state.options.everySeat && there.length < state.players.length) return 'Waiting for all players';
  const roles = new Set(there.map((player) => state.players[player]?.role));
  if (!roles.has('thrower')) return 'Waiting for a thrower';
  if (!roles.has('holder')) return 'Waiting for a basket holder';
  const waiting = there.filter((player) => !state.players[player]?.ready).length;
  return waiting === 1 ? 'Waiting for one player' : `Waiting for ${waiting} players`;
}
