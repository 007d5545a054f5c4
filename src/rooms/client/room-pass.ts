/** The signed pass that lets a page into a room. */
export interface RoomPass {
  /**
   * Resolves to the newest token; `afresh`: a renewed one, after a refusal. Rejects with a sentence if the server
   * issues none, and with the HTTP status as its cause.
   */
  token(afresh: boolean): Promise<string>;
}

/** Storage for the lifetime of a tab; `sessionStorage` has this shape. */
export interface PassStorage {
  getItem(key: string): string | null;
  setItem(key: string, value: string): void;
}

/** Returns the storage of this tab; undefined: there is none, or the browser denies it. */
export function tabStorage(): PassStorage | undefined {
  try {
    return globalThis.sessionStorage;
  } catch (error) {
    if (error instanceof DOMException) return undefined;
    throw error;
  }
}

/**
 * Creates the pass to a room of the relay at `base`. A reload in the same tab keeps the person. `kind`: the name of the
 * game; `terms`: the terms of the room, if this person is the first in it.
 */
export function createRoomPass(
  base: string,
  room: string,
  kind: string,
  storage?: PassStorage,
  terms: object = {},
): RoomPass {
  const key = `threepoint pass ${kind} ${room}`;
  let token = storage?.getItem(key) ?? null;
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
        throw new Error(
          `the server issued no pass for this room: ${typeof answer.error === 'string' ? answer.error : response.status}`,
          { cause: response.status },
        );
      }
      token = answer.token;
      verified = true;
      storage?.setItem(key, token);
      return token;
    },
  };
}

/** Sends a request with a pass, and repeats it with a renewed pass if the server refuses this one with 401. */
export async function fetchWithPass(pass: RoomPass, url: string, request: RequestInit = {}): Promise<Response> {
  const send = async (afresh: boolean) => {
    const headers = { ...request.headers, authorization: `Bearer ${await pass.token(afresh)}` };
    return fetch(url, { ...request, headers, cache: 'no-store' });
  };
  const response = await send(false);
  return response.status === 401 ? send(true) : response;
}
