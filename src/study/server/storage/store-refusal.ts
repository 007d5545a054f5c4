/** An operation that the store refuses; the message is for the person who asked for it. */
export class StoreRefusal extends Error {
  /**
   * `begun`: participants have begun with the plan, hence it cannot change, but a new version can be added. `locked`:
   * another program writes to the database. `busy`: too many requests. `lost`: the database or its disk has failed or
   * was replaced, which a person must check.
   */
  readonly reason: 'unknown' | 'conflict' | 'begun' | 'forbidden' | 'full' | 'locked' | 'busy' | 'lost';
  /** Details for the log that the message must not show, such as paths; null: none. */
  readonly detail: string | null;

  constructor(reason: StoreRefusal['reason'], message: string, detail: string | null = null) {
    super(message);
    this.reason = reason;
    this.detail = detail;
  }
}
