import type { ConnectionStatus } from './connection';

const endings: Readonly<Record<NonNullable<ConnectionStatus['reason']>, string>> = {
  replaced: 'You opened this room somewhere else, where your seat is now.',
  yielded: 'The seat went to a person.',
  left: 'You left the room.',
  misbehaved: 'The server closed the connection because of what this page sent. Reload the page to join again.',
  slow: 'This connection is too slow for the room. Reload the page to try again.',
  closed: 'The room was closed.',
  stopping: 'The server is being restarted.',
  unreachable: 'The server cannot be reached.',
  refused: 'The server does not let you into this room. Open the link again.',
  'old-page': 'This page and the server are of different versions. Reload the page.',
};

/** What a person should know of their connection, in a sentence or two; null: nothing. */
export function bannerText({ phase, reason, retryIn }: ConnectionStatus): string | null {
  if (phase === 'joined') return null;
  if (phase === 'ended') return reason && endings[reason];
  if (phase === 'connecting' && reason === null) return 'Joining the room …';
  const why = reason ? endings[reason] : 'The connection was lost.';
  const then =
    retryIn === null
      ? 'Trying again now …'
      : `Trying again in ${Math.max(1, Math.ceil(retryIn))} s. Your seat is kept for 30 s.`;
  return `${why} ${then}`;
}

/** Answers that take longer than this [s] are felt in the game, and longer than this spoil it. */
const fair = 0.12;
const poor = 0.3;

/** How good the connection to a room is, in words; `delay` [s]: until it answers. */
export function connectionText(delay: number): string {
  const quality = delay < fair ? 'good' : delay < poor ? 'fair' : 'poor';
  const shown = delay < 1 ? `${Math.max(1, Math.round(delay * 1000))} ms` : `${delay.toFixed(0)} s`;
  return `Connection ${quality}, ${shown}`;
}
