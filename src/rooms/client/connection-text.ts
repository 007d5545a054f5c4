import type { ConnectionStatus } from './connection';

/** Why a connection has ended, in sentences. */
export const endings: Readonly<Record<NonNullable<ConnectionStatus['reason']>, string>> = {
  replaced: 'You opened this room somewhere else, where your seat is now.',
  yielded: 'A person took this seat.',
  left: 'You left the room.',
  misbehaved: 'The server closed the connection because of what this page sent. Reload the page to join again.',
  slow: 'This connection is too slow for the room. Reload the page to try again.',
  full: 'The server is full. Reload the page in a few minutes to try again.',
  closed: 'The room was closed.',
  stopping: 'The server is being restarted.',
  unreachable: 'The server cannot be reached.',
  forbidden: "The server does not accept requests from this page's address. Open the page at the server's own.",
  refused: 'The server does not let you into this room. Open the link again.',
  'old-page': 'This page and the server have different versions. Reload the page.',
};

/** Returns a sentence or two about the state of the connection; null: it is fine. `seated`: the user has a seat. */
export function bannerText({ phase, reason, retryIn }: ConnectionStatus, seated = true): string | null {
  if (phase === 'joined') return null;
  if (phase === 'ended') return reason && endings[reason];
  if (phase === 'connecting' && reason === null) return 'Joining the room …';
  const why = reason ? endings[reason] : 'The connection was lost.';
  if (retryIn === null) return `${why} Trying again now …`;
  const held = seated ? ' Your seat is held for 30 s.' : '';
  return `${why} Trying again in ${Math.max(1, Math.ceil(retryIn))} s.${held}`;
}

/** A delay above the first [s] is noticeable in the game; above the second it spoils the game. */
const fair = 0.12;
const poor = 0.3;

/** Returns the quality of the connection to a room in words. `delay`: response time [s]. */
export function connectionText(delay: number): string {
  const quality = delay < fair ? 'good' : delay < poor ? 'fair' : 'poor';
  const shown = delay < 1 ? `${Math.max(1, Math.round(delay * 1000))} ms` : `${delay.toFixed(0)} s`;
  return `Connection ${quality}, ${shown}`;
}
