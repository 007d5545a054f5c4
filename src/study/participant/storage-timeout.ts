/** Why a request is given up: the storage neither carries it out nor refuses it. */
export const silentStorage = 'the storage of this browser does not answer';

/**
 * A request that takes longer than this [ms] is given up; the strict write of a long recording takes a second on a slow
 * device.
 */
const patienceMs = 5000;

/**
 * Gives up requests that a browser's storage does not answer, as where its disk hangs or another page occupies it.
 * While one that was given up is under way, others are refused at once: they would wait behind it.
 */
export class StoragePatience {
  #silent = 0;

  /**
   * The answer of a request; rejects with the sentence where there is none in time. What is given up may still be
   * carried out.
   */
  async answer<Answer>(request: () => Promise<Answer>): Promise<Answer> {
    if (this.#silent > 0) throw new Error(silentStorage);
    const answer = request();
    let timer: ReturnType<typeof setTimeout> | undefined;
    const silence = new Promise<never>((_, reject) => {
      timer = setTimeout(() => {
        this.#silent += 1;
        const answered = () => {
          this.#silent -= 1;
        };
        answer.then(answered, answered);
        reject(new Error(silentStorage));
      }, patienceMs);
    });
    try {
      return await Promise.race([answer, silence]);
    } finally {
      clearTimeout(timer);
    }
  }
}
