/**
 * Whether a server of ours is where the page came from: not known yet, being asked, there, not there (a host of files answered instead), or
 * silent (nothing answered now).
 */
export type ServerState = 'unknown' | 'asked' | 'here' | 'none' | 'silent';

/** Without an answer in this time [ms] the server counts as silent. */
const patienceMs = 4000;

function parsed(json: string): unknown {
  try {
    return JSON.parse(json);
  } catch {
    // reason: hosts of files answer with pages of their own, which are no JSON; that is what tells them apart
    return null;
  }
}

/** What an answer to the question for rooms says of who gave it; rejects where it breaks off. */
async function stateFrom(response: Response): Promise<ServerState> {
  // Proxies say these while the server behind them is away.
  if (response.status >= 500 || response.status === 429) return 'silent';
  const said = parsed(await response.text());
  if (typeof said !== 'object' || said === null) return 'none';
  return 'error' in said || ('rooms' in said && Array.isArray(said.rooms)) ? 'here' : 'none';
}

/**
 * Finds out whether rooms and studies can be had, by asking: a host says nothing by its name. A built page carries an answer of its own,
 * public/api/rooms, which a host of files gives; a server of ours never gives files below /api.
 */
export class ServerPresence {
  readonly #server: string;
  readonly #onChange: () => void;
  #state: ServerState = 'unknown';
  #answer: Promise<ServerState> | null = null;

  /** `server`: the folder of the page, no slash at its end. */
  constructor(server: string, onChange: () => void) {
    this.#server = server;
    this.#onChange = onChange;
  }

  get state(): ServerState {
    return this.#state;
  }

  /** What is known; asked for where nothing is. Never rejects. */
  known(): Promise<ServerState> {
    return this.#state === 'unknown' ? this.ask() : (this.#answer ?? Promise.resolve(this.#state));
  }

  /** Asks anew, unless a question is on its way. Never rejects. */
  ask(): Promise<ServerState> {
    this.#answer ??= this.#ask();
    return this.#answer;
  }

  async #ask(): Promise<ServerState> {
    this.#change('asked');
    try {
      const asked = { cache: 'no-store', signal: AbortSignal.timeout(patienceMs) } as const;
      this.#change(await stateFrom(await fetch(`${this.#server}/api/rooms`, asked)));
    } catch {
      // reason: why nothing answered is no matter; that it did not is the state
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
