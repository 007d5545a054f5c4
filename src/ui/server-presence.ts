/**
 * Whether the page's host is a threepoint server: not known yet, requested, present, absent (a static host responded),
 * or silent (no response).
 */
export type ServerState = 'unknown' | 'asked' | 'here' | 'none' | 'silent';

/** Timeout of the request [ms]; then the server counts as silent. */
const patienceMs = 4000;

function parsed(json: string): unknown {
  try {
    return JSON.parse(json);
  } catch {
    // reason: static hosts answer with an HTML page; not being JSON is the result, not a fault
    return null;
  }
}

/** Returns the state that the answer to /api/rooms implies. Rejects if the answer is cut off. */
async function stateFrom(response: Response): Promise<ServerState> {
  // Proxies answer with these while the server behind them is down.
  if (response.status >= 500 || response.status === 429) return 'silent';
  const said = parsed(await response.text());
  if (typeof said !== 'object' || said === null) return 'none';
  return 'error' in said || ('rooms' in said && Array.isArray(said.rooms)) ? 'here' : 'none';
}

/**
 * Detects by a request whether the page's host has rooms and studies. The built page includes a file public/api/rooms,
 * which a static host serves; a threepoint server never serves files below /api.
 */
export class ServerPresence {
  readonly #server: string;
  readonly #onChange: () => void;
  #state: ServerState = 'unknown';
  #answer: Promise<ServerState> | null = null;

  /** `server`: the folder of the page, without a trailing slash. */
  constructor(server: string, onChange: () => void) {
    this.#server = server;
    this.#onChange = onChange;
  }

  get state(): ServerState {
    return this.#state;
  }

  /** Resolves to the state, after a request if it is unknown. Never rejects. */
  whenKnown(): Promise<ServerState> {
    return this.#state === 'unknown' ? this.refresh() : (this.#answer ?? Promise.resolve(this.#state));
  }

  /** Sends the request again, unless one is pending. Never rejects. */
  refresh(): Promise<ServerState> {
    this.#answer ??= this.#ask();
    return this.#answer;
  }

  async #ask(): Promise<ServerState> {
    this.#change('asked');
    try {
      const asked = { cache: 'no-store', signal: AbortSignal.timeout(patienceMs) } as const;
      this.#change(await stateFrom(await fetch(`${this.#server}/api/rooms`, asked)));
    } catch {
      // reason: no answer is a state, whatever its cause
      this.#change('silent');
    }
    this.#answer = null;
    return this.#state;
  }

  #change(state: ServerState): void {
    this.#state = state;
    this.#onChange();
  }
}
