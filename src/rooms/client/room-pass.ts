import type { RoomTerms } from '../protocol/messages';

/** The signed pass that lets a page into a room. */
export interface RoomPass {
  /** The newest one; `afresh`: a renewed one, because this one was refused. Rejects with a sentence where the server gives none. */
  token(afresh: boolean): Promise<string>;
}

/** Where a page keeps something for as long as its tab lives: `sessionStorage` has this shape. */
export interface Keep {
  getItem(key: string): string | null;
  setItem(key: string, value: string): void;
}

/** Asks the relay at `base` for a pass; the same person after a reload, in the same tab. `kind`: the game. `terms`: of the room, for the first person in it. */
export function createRoomPass(base: string, room: string, kind: string, keep?: Keep, terms: RoomTerms = {}): RoomPass {
  const key = `threepoint pass ${kind} ${room}`;
  let token = keep?.getItem(key) ?? null;
  let verified = false;
  return {
    async token(afresh) {
      if (token !== null && verified && !afresh) return token;
      const response = await fetch(`${base}/api/rooms/token`, {
        method: 'POST',
        headers: { 'content-type': 'application/json' },
        body: JSON.stringify({
          room,
          kind,
          ...(token !== null && { token }),
          ...(Object.keys(terms).length > 0 && { terms }),
        }),
      });
      const answer = (await response.json()) as { token?: unknown; error?: unknown };
      if (!response.ok || typeof answer.token !== 'string') {
        throw new Error(`no pass for this room: ${typeof answer.error === 'string' ? answer.error : response.status}`);
      }
      token = answer.token;
      verified = true;
      keep?.setItem(key, token);
      return token;
    },
  };
}
