/** Flushes for many at once: those who ask while one is under way share the next. */
export class SharedFlush {
  readonly #flush: () => Promise<void>;
  #last: Promise<void> = Promise.resolve();
  #next: Promise<void> | null = null;

  /** `flush` writes everything so far through to the disk. */
  constructor(flush: () => Promise<void>) {
    this.#flush = flush;
  }

  /**
   * Resolves when a flush is through that began after this call: one under way may have missed what the caller has just written. Rejects
   * when it fails, and ever after: the system forgets which pages it could not write, and a later flush that succeeds says nothing of them.
   */
  flushed(): Promise<void> {
    this.#next ??= this.#last.then(() => {
      this.#next = null;
      return this.#flush();
    });
    this.#last = this.#next;
    return this.#next;
  }
}
