/** Combines the flushes of many callers: all calls during a flush share the next one. */
export class GroupCommit {
  readonly #flush: () => Promise<void>;
  #last: Promise<void> = Promise.resolve();
  #next: Promise<void> | null = null;

  /** `flush` writes everything so far to the disk. */
  constructor(flush: () => Promise<void>) {
    this.#flush = flush;
  }

  /**
   * Resolves when a flush has ended that began after this call: one under way may have missed what the caller has just
   * written. Rejects when it fails, and every time after that: the system drops the pages that it could not write, and
   * a later flush does not report them.
   */
  flush(): Promise<void> {
    this.#next ??= this.#last.then(() => {
      this.#next = null;
      return this.#flush();
    });
    this.#last = this.#next;
    return this.#next;
  }
}
