import type { PlainKey } from '../phrases/phrases';

/** The reasons for refusals with their status over HTTP. Of reasons with one status, pages read the first. */
const statuses = {
  ...{ invalid: 400, unauthorised: 401, forbidden: 403, unknown: 404, conflict: 409, limited: 429, full: 507 },
  /** Participants have begun with the plan, hence it cannot change, but a new version can be added. */
  begun: 409,
  busy: 503,
  /** Another program writes to the database. */
  locked: 503,
  /** The database or its disk has failed or was replaced, which a person must check. */
  lost: 507,
  /** The server is another program. */
  elsewhere: 404,
} as const;

/** What a study refuses, in the page, in the store and over HTTP; the message is for the person who asked for it. */
export class Rejection extends Error {
  readonly reason: keyof typeof statuses;
  /** The invalid field of the request, as `records[1].body.age`; null: no single field is at fault. */
  readonly field: string | null = null;
  /** Details for the log that the message must not show, such as paths; null: none. */
  readonly detail: string | null = null;
  /** Set if the message is only the cause of a failure: whether it is known that nothing was done. */
  readonly failure: 'not done' | 'unknown' | null = null;
  /** The phrase for participants who can cause the refusal; null: they cannot. */
  readonly phrase: PlainKey | null = null;

  constructor(
    reason: Rejection['reason'],
    message: string,
    about: Partial<Pick<Rejection, 'field' | 'detail' | 'failure' | 'phrase'>> = {},
  ) {
    super(message);
    this.reason = reason;
    Object.assign(this, about);
  }

  get status(): number {
    return statuses[this.reason];
  }

  /** Returns the refusal in an answer of the server. */
  static from(status: number, message: string, field: string | null): Rejection {
    const reasons = Object.keys(statuses) as Rejection['reason'][];
    return new Rejection(reasons.find((reason) => statuses[reason] === status) ?? 'invalid', message, { field });
  }
}
