import { checked, identifier, participantId } from 'threepoint/core/validation/validation';
import { HttpError } from 'threepoint-http/http-error';
import type { HttpResponse } from 'threepoint-http/response';
import { refusalOf as knownRefusalOf } from 'threepoint-http/router';
import { StoreRefusal } from '../storage/store-refusal';
import { type Concerned, createStudyGuard, type StudyGuardOptions } from './guard';
import { participantRoutes } from './participant-routes';
import type { StudyParts, StudyRequest, StudyRoute } from './route';
import { studyRoutes } from './study-routes';

/** The routes below /api/studies. A participant's token gives access to this participant only. */
export type StudyRoutes = ReturnType<typeof createStudyRoutes>;

const concerned = ({ token, address, names }: StudyRequest): Concerned => ({
  ...{ token, address },
  study: names.study === undefined ? '' : checked(identifier, names.study),
  participant: names.participant === undefined ? '' : checked(participantId, names.participant),
});

const statusOfRefusal = {
  ...{ unknown: 404, conflict: 409, begun: 409, forbidden: 403, locked: 503, busy: 503, full: 507, lost: 507 },
} as const satisfies Readonly<Record<StoreRefusal['reason'], number>>;

/** The time after which a page repeats its request if the database is locked or busy [s]. */
export const retryAfterSeconds = 5;

/** Returns the HTTP error for an error, or null for a fault of the server. */
export function refusalOf(error: unknown): HttpError | null {
  if (!(error instanceof StoreRefusal)) return knownRefusalOf(error);
  const { reason, message } = error;
  return new HttpError(statusOfRefusal[reason], message, {
    field: reason === 'begun' ? 'newVersion' : null,
    headers: statusOfRefusal[reason] === 503 ? { 'retry-after': String(retryAfterSeconds) } : {},
  });
}

/** Returns the routes of the studies. */
export function createStudyRoutes({
  experimenterToken,
  onWrongGuess,
  ...parts
}: Omit<StudyParts, 'guard'> & StudyGuardOptions) {
  const guard = createStudyGuard({ store: parts.store, experimenterToken, onWrongGuess });
  const serving = { ...parts, guard };
  return {
    routes: [...studyRoutes(serving), ...participantRoutes(serving)],
    /** Throws an HttpError if the request is not permitted; called before the body is read. */
    admit: async ({ access }: StudyRoute, request: StudyRequest): Promise<void> =>
      guard.admit(access, concerned(request)),
    handle: (
      { handle }: StudyRoute,
      request: StudyRequest,
      body: Uint8Array<ArrayBuffer>,
    ): HttpResponse | Promise<HttpResponse> =>
      handle({ ...concerned(request), at: request.at, query: new URLSearchParams(request.query), body }),
  };
}
