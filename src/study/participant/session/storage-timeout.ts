/** The error of a request that the storage neither carries out nor refuses. */
export const silentStorage = 'the storage of this browser does not answer';

/** The default time limit of a request [ms]: the strict write of a long recording takes a second on a slow device. */
const defaultLimitMs = 5000;

/**
 * Limits the time of requests to a browser's storage, which does not answer while its disk hangs or another page
 * occupies it. While a request that timed out is still open, further ones reject at once: they would wait behind it.
 */
export class StorageTimeout {
  /** The number of open requests that timed out. */
  #open = 0;
  readonly #limitMs: number;

  constructor(limitMs = defaultLimitMs) {
    this.#limitMs = limitMs;
  }

  /**
   * Returns the answer of a request, or rejects with `silentStorage` after the time limit. A request that timed out may
   * still be carried out.
   */
  async limit<Answer>(request: () => Promise<Answer>): Promise<Answer> {
    if (this.#open > 0) throw new Error(silentStorage);
    const answer = request();
    let timer: ReturnType<typeof setTimeout> | undefined;
    const silence = new Promise<never>((_, reject) => {
      timer = setTimeout(() => {
        this.#open += 1;
        const answered = () => {
          this.#open -= 1;
        };
        answer.then(answered, answered);
        reject(new Error(silentStorage));
      }, this.#limitMs);
    });
    try {
      return await Promise.race([answer, silence]);
    } finally {
      clearTimeout(timer);
    }
  }
}
