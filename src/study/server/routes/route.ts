import type { ClientAddress, HttpResponse, Route, Software } from 'threepoint-http';
import { maxMotionBytes } from '../../model/progress/study-api';
import type { Exporter } from '../export/exporter';
import type { StudyStorage } from '../study-storage';
import type { Effect } from './effect';
import type { RouteAccess, Sender, StudyGuard } from './guard';
import type { StudySeats } from './seats';

/** The largest bodies [bytes]. */
export const bodyLimits = { json: 512 * 1024, motion: maxMotionBytes } as const;

const prefix = '/api/studies';

/** A route without its function, which stays in the thread of the database. */
export type RouteHead = Omit<StudyRoute, 'handle'>;

/** A request to a route of the studies, as it is sent from the thread of the sockets to that of the database. */
export interface StudyRequest {
  readonly route: RouteHead;
  /** The time of the request in seconds since 1970. */
  readonly at: number;
  readonly token: string | null;
  readonly address: ClientAddress | null;
  /** The values of the ":names" of the route, not checked yet. */
  readonly names: Readonly<Record<string, string>>;
  /** The query of the address, without "?". */
  readonly query: string;
}

/** A request with checked names of study and participant; empty if the route has none. */
export interface StudyCall extends Sender {
  readonly at: number;
  readonly query: URLSearchParams;
  readonly body: Uint8Array<ArrayBuffer>;
}

export interface StudyRoute extends Omit<Route<RouteAccess>, 'handle'> {
  /** If it is not "reads", the answer waits until the change is on the disk. */
  readonly effect: Effect;
  /** Whether the answer has no time limit. */
  readonly isPatient: boolean;
  handle(call: StudyCall): HttpResponse | Promise<HttpResponse>;
}

/** The parts of the server that routes use. */
export interface StudyParts {
  readonly store: StudyStorage;
  readonly guard: StudyGuard;
  /** Signs participants into the rooms of their trials. */
  readonly seats: StudySeats;
  /** The software that serves the studies, for exports. */
  readonly software: Software;
  readonly makeZip: Exporter;
}

/** Returns a route with a path below the prefix and a limit of its JSON body [bytes]. */
export const route = (
  method: Route['method'],
  path: string,
  access: RouteAccess,
  bodyLimit: number,
  handle: StudyRoute['handle'],
): StudyRoute => ({
  ...{ method, path: `${prefix}${path}`, access, bodyLimit, handle },
  effect: ({ GET: 'reads', POST: 'stores', PUT: 'stores', DELETE: 'deletes' } as const)[method],
  isPatient: false,
});
