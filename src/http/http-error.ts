/** A refusal that the client receives: a status and a sentence. */
export class HttpError extends Error {
  readonly status: number;
  /** The invalid field of the body, as `records[1].body.age`; null: no single field is at fault. */
  readonly field: string | null;
  readonly headers: Readonly<Record<string, string>>;

  constructor(
    status: number,
    message: string,
    { field = null, headers = {} }: { field?: string | null; headers?: Readonly<Record<string, string>> } = {},
  ) {
    super(message);
    this.status = status;
    this.field = field;
    this.headers = headers;
  }
}

/** Returns what a client receives for an unexpected error; the log has `errorLine`. */
export const internalError = (): HttpError => new HttpError(500, 'the server failed; try again');

/** Returns the line of the log about an unexpected error, with its stack. */
export const errorLine = (error: unknown): string =>
  `unexpected error: ${error instanceof Error ? (error.stack ?? error.message) : String(error)}`;
