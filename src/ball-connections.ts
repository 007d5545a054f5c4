import type { RoomTerms } from './core/protocol/messages';
import type { Connection, Visitor } from './net/connection';
import { createLoopbackHost } from './net/loopback-connection';

/** Makes one visitor's place in a room; `time`: the page's clock [s]. */
export type Connect = (visitor: Visitor, time: number) => Connection;

/** Where a browser keeps what lasts as long as a tab; undefined where it keeps nothing. */
function tabStorage(): Storage | undefined {
  try {
    return window.sessionStorage;
  } catch (error) {
    if (error instanceof DOMException) return undefined;
    throw error;
  }
}

/**
 * Places in a room of this name on the server that the page came from; null: in a Room of this page's own. `terms`: of the match, on a
 * server those of whoever is the first in the room; a room of one's own may be paused in any case.
 */
export async function connectionsFor(
  room: string | null,
  { seed, ...terms }: RoomTerms & { readonly seed: number },
): Promise<Connect> {
  if (room === null) {
    const { pausable: _, ...ball } = terms;
    return createLoopbackHost({ kind: 'ball', seed, ball }).connect;
  }
  const [{ createSocketConnection }, { createRoomPass }] = await Promise.all([
    import('./net/socket-connection'),
    import('./net/room-pass'),
  ]);
  const person = createRoomPass('', room, 'ball', tabStorage(), terms);
  return (visitor) =>
    createSocketConnection({
      url: location.origin,
      room,
      visitor,
      // Each bot is somebody of its own.
      pass: visitor.bot ? createRoomPass('', room, 'ball') : person,
    });
}
