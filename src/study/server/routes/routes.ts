import { parseRecording } from 'threepoint/core/tracking/recording';
import {
  checked,
  identifier,
  integerBetween,
  participantId,
  text,
  ValidationError,
} from 'threepoint/core/validation/validation';
import { type Answer, done, HttpError, json } from 'threepoint-http/answer';
import type { ClientAddress } from 'threepoint-http/client-address';
import { jsonOf, refusalOf as knownRefusalOf, type Route, textOf } from 'threepoint-http/router';
import type { Software } from 'threepoint-http/software';
import * as v from 'valibot';
import { checkedPlan, languagesOf, type StudyPlan, studyTitle } from '../../model/plan/plan';
import { mostMotionBytes, type PlanVersion, type StudyInfo } from '../../model/progress/study-api';
import { profileFrom } from '../../model/records/participant-profile';
import { checkedRecord } from '../../model/records/study-record';
import { exportName } from '../export/export-zip';
import type { Exporter } from '../export/exporter';
import { StoreRefusal } from '../storage/database';
import type { StudyStore } from '../storage/store';
import { type Concerned, createStudyGuard, type StudyAccess, type StudyGuard, type StudyGuardOptions } from './guard';
import type { StudySeats } from './seats';

export interface StudyRoutesOptions extends StudyGuardOptions {
  /** Signs participants into the rooms of their trials. */
  readonly seats: StudySeats;
  /** The software that serves the studies, for exports. */
  readonly software: Software;
  readonly makeZip: Exporter;
}

/** The largest bodies [bytes]. */
export const bodyLimits = { json: 512 * 1024, motion: mostMotionBytes } as const;
export const mostRecordsAtOnce = 200;

const prefix = '/api/studies';

/** A request to a route of the studies, as it is sent from the thread of the sockets to that of the database. */
export interface StudyRequest {
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
interface StudyCall extends Concerned {
  readonly at: number;
  readonly query: URLSearchParams;
  readonly body: Uint8Array<ArrayBuffer>;
}

export interface StudyRoute extends Omit<Route<StudyAccess>, 'handle'> {
  /** Whether the answer waits until the change is on the disk. */
  readonly changes: boolean;
  /** Whether the answer has no time limit. */
  readonly isPatient: boolean;
  handle(call: StudyCall): Answer | Promise<Answer>;
}

/** All routes below /api/studies. A participant's token gives access to this participant only. */
export interface StudyRoutes {
  readonly routes: readonly StudyRoute[];
  /** Throws an HttpError if the request is not permitted; called before the body is read. */
  admit(route: StudyRoute, request: StudyRequest): Promise<void>;
  handle(route: StudyRoute, request: StudyRequest, body: Uint8Array<ArrayBuffer>): Answer | Promise<Answer>;
}

const concerned = ({ token, address, names }: StudyRequest): Concerned => ({
  ...{ token, address },
  study: names.study === undefined ? '' : checked(identifier, names.study),
  participant: names.participant === undefined ? '' : checked(participantId, names.participant),
});

type Handle = StudyRoute['handle'];

/** Returns a route with a path below the prefix and a limit of its JSON body [bytes]. */
const route = (
  method: Route['method'],
  path: string,
  access: StudyAccess,
  bodyLimit: number,
  handle: Handle,
): StudyRoute => ({
  ...{ method, path: `${prefix}${path}`, access, bodyLimit, handle },
  changes: method !== 'GET',
  isPatient: false,
});

const batchSchema = v.object({
  records: v.pipe(
    v.array(v.unknown(), 'expected a list'),
    v.minLength(1, 'expected at least one record'),
    v.maxLength(mostRecordsAtOnce, `expected at most ${mostRecordsAtOnce} records`),
  ),
});

const commandSchema = v.variant('type', [
  v.strictObject({ type: v.literal('start') }),
  v.strictObject({ type: v.literal('pause') }),
  v.strictObject({ type: v.literal('resume') }),
  v.strictObject({ type: v.literal('stop'), by: v.literal('experimenter'), reason: text(500) }),
  v.strictObject({
    type: v.literal('void-block'),
    reason: text(500),
    repeat: v.boolean('expected true or false'),
    of: v.exactOptional(v.strictObject({ task: identifier, block: integerBetween(1, 1000) })),
  }),
]);

const newStudySchema = v.strictObject({
  plan: v.unknown(),
  simulated: v.boolean('expected true or false'),
  newVersion: v.optional(v.boolean('expected true or false')),
});
const versionSchema = v.object({ version: v.optional(integerBetween(1, 10_000)) });
const withdrawalSchema = v.object({ code: text(60) });
/** `consent` is the version of the text that the participant has read. */
const claimSchema = v.strictObject({ invitation: v.optional(text(60)), consent: v.optional(text(40)) });
const seatSchema = v.strictObject({ step: text(120), run: integerBetween(1, 99) });
const remarkSchema = v.strictObject({ text: text(2000) });
const sinceSchema = v.object({ after: integerBetween(0, 2 ** 53 - 1) });
const notATrial = 'expected the id of a trial record';
const motionSchema = v.object({
  trial: v.pipe(v.string(notATrial), v.regex(/^[a-z0-9][a-z0-9/@.:-]{0,119}$/, notATrial)),
});

/** Returns the public part of a plan. Participants get the order and names of conditions only with their schedule. */
const publicPlan = (plan: StudyPlan, simulated: boolean) => {
  const { id, title, consent, remote, phrases = {} } = plan;
  return { id, title, consent, languages: languagesOf(plan), phrases, simulated, contact: remote?.contact ?? null };
};

const statusOfRefusal = {
  ...{ unknown: 404, conflict: 409, begun: 409, forbidden: 403, locked: 503, busy: 503, full: 507, lost: 507 },
} as const satisfies Readonly<Record<StoreRefusal['reason'], number>>;

/** The time after which a page repeats its request if the database is locked or busy [s]. */
export const retryAfterSeconds = 5;

interface TableOptions {
  readonly store: StudyStore;
  readonly guard: StudyGuard;
  readonly seats: StudySeats;
  readonly software: Software;
  readonly makeZip: Exporter;
}

type Exporting = Pick<TableOptions, 'store' | 'software' | 'makeZip'>;

/** Returns the requested version of the plan, or undefined for the newest. */
function versionIn(query: URLSearchParams): number | undefined {
  const asked = query.get('version');
  return checked(versionSchema, asked === null ? {} : { version: Number(asked) }).version;
}

/** Returns a study with the records of participants who follow the version of its plan that `info` shows. */
function recordsOf(store: StudyStore, info: StudyInfo): Answer {
  const { participants } = info.versions.find(({ version }) => version === info.version) as PlanVersion;
  const head = `${JSON.stringify(info).slice(0, -1)},"records":`;
  const records = store.records.listed(info.plan.id, new Set(participants));
  const body = Buffer.concat([Buffer.from(head), ...records, Buffer.from('}\n')]);
  return { ...json(null), body };
}

/** Returns the HTTP error for an error, or null for a fault of the server. */
export function refusalOf(error: unknown): HttpError | null {
  if (!(error instanceof StoreRefusal)) return knownRefusalOf(error);
  const { reason, message } = error;
  return new HttpError(statusOfRefusal[reason], message, {
    field: reason === 'begun' ? 'newVersion' : null,
    headers: statusOfRefusal[reason] === 503 ? { 'retry-after': String(retryAfterSeconds) } : {},
  });
}

interface ExportAsked {
  readonly at: number;
  readonly study: string;
  readonly participant?: string;
  readonly version?: number | undefined;
}

async function exportOf({ store, software, makeZip }: Exporting, asked: ExportAsked): Promise<Answer> {
  const { participant } = asked;
  const info = store.plans.get(asked.study, asked.version);
  const plan = participant === undefined ? info.plan : store.plans.planFor(asked.study, participant);
  if (participant !== undefined) store.places.get(asked.study, participant);
  const planVersion = participant === undefined && info.versions.length > 1 ? info.version : undefined;
  const name = exportName({ plan, simulated: info.simulated, ...(planVersion && { planVersion }) }, participant);
  return {
    status: 200,
    headers: { 'content-type': 'application/zip', 'content-disposition': `attachment; filename="${name}.zip"` },
    body: await makeZip({ ...asked, version: info.version, software }),
  };
}

/** Returns a route whose answer is an export. */
const exporting = (path: string, access: StudyAccess, handle: Handle): StudyRoute => ({
  ...route('GET', path, access, 0, handle),
  isPatient: true,
});

/** Returns the routes of the server and of one study. */
function studyTable({ store, guard, software, makeZip }: TableOptions): StudyRoute[] {
  return [
    route('GET', '', 'experimenter', 0, () =>
      json({
        studies: store.plans.all().map(({ plan, versions: _, ...rest }) => {
          const { id, participants } = plan;
          return { id, title: studyTitle(plan), participants, ...rest };
        }),
      }),
    ),
    route('POST', '', 'experimenter', bodyLimits.json, (call) => {
      const { plan, simulated, newVersion = false } = checked(newStudySchema, jsonOf(call));
      return json(store.plans.add(checkedPlan(plan), { simulated, newVersion, at: call.at }), 201);
    }),
    // Participants who have begun read the text of their version.
    route('GET', '/:study', 'anyone', 0, ({ study, query }) => {
      const { plan, simulated } = store.plans.get(study);
      const participant = query.get('participant');
      const read = participant === null ? plan : store.plans.planFor(study, checked(participantId, participant));
      return json(publicPlan(read, simulated));
    }),
    route('DELETE', '/:study', 'experimenter', 0, ({ study }) => {
      store.deletion.deleteSimulated(study);
      return done;
    }),
    route('GET', '/:study/records', 'experimenter', 0, ({ study, query }) => {
      return recordsOf(store, store.plans.get(study, versionIn(query)));
    }),
    route('GET', '/:study/receipts', 'experimenter', 0, ({ study }) => {
      store.plans.get(study);
      return json({ receipts: store.deletion.receipts(study) });
    }),
    exporting('/:study/export', 'experimenter', ({ study, at, query }) =>
      exportOf({ store, software, makeZip }, { at, study, version: versionIn(query) }),
    ),
    route('GET', '/:study/participants', 'experimenter', 0, ({ study, at }) =>
      json({ participants: store.overview(study, at) }),
    ),
    route('POST', '/:study/withdraw', 'withdrawing', bodyLimits.json, async (call) => {
      const { code } = checked(withdrawalSchema, jsonOf(call));
      return json(await guard.withdrawing(call, code, () => store.deletion.withdraw(call.study, code, call.at)));
    }),
  ];
}

/** Returns the state for a device that has taken a participant's place; a session of another device is continued. */
const sessionOf = ({ store }: Pick<TableOptions, 'store'>, { study, participant, at }: StudyCall) => ({
  plan: store.plans.planFor(study, participant),
  simulated: store.plans.get(study).simulated,
  progress: store.places.progress(study, participant, at),
  ...profileFrom(store.records.all(study, participant)),
});

/** Throws if a stored plan is no longer valid for a new study, because nothing can be recorded by its rules. */
function refuseOutdated(plan: StudyPlan): void {
  try {
    checkedPlan(plan);
  } catch (error) {
    if (!(error instanceof ValidationError)) throw error;
    throw new HttpError(
      409,
      `the plan of this study is of an older version of the program and no longer valid: ${error.message}. ` +
        'Its records can be exported and deleted. Give a study with another plan another id',
    );
  }
}

/**
 * Takes a place. `read` is the version of the text that was consented to, if it was sent. Throws if the plan has
 * another one; the place stays free.
 */
function takePlace(
  { store }: Pick<TableOptions, 'store'>,
  { study, participant, at }: StudyCall,
  read: string | undefined,
) {
  const plan = store.plans.planFor(study, participant);
  refuseOutdated(plan);
  const { version } = plan.consent;
  if (read !== undefined && read !== version) {
    throw new HttpError(409, `consent was given to text ${read}, but the study shows ${version}`, { field: 'consent' });
  }
  return store.places.claim(study, participant, at);
}

/** Returns a route that signs: it takes a body and changes nothing. */
const signing = (path: string, handle: Handle): StudyRoute => ({
  ...route('POST', path, 'participant', bodyLimits.json, handle),
  changes: false,
});

/** Returns the routes of one participant. */
function participantTable({ store, guard, seats, software, makeZip }: TableOptions): StudyRoute[] {
  const own = '/:study/participants/:participant';
  return [
    route('POST', `${own}/claim`, 'invited', bodyLimits.json, async (call) => {
      const { invitation, consent } = checked(claimSchema, jsonOf(call));
      const claim = () => takePlace({ store }, call, consent);
      const { token, withdrawalCode } = await guard.claiming(call, invitation, claim);
      return json({ token, withdrawalCode, ...sessionOf({ store }, call) }, 201);
    }),
    route('POST', `${own}/invitation`, 'experimenter', 0, ({ study, participant }) => {
      store.places.reinvite(study, participant);
      return done;
    }),
    route('POST', `${own}/release`, 'experimenter', 0, ({ study, participant }) => {
      store.places.release(study, participant);
      return done;
    }),
    route('POST', `${own}/records`, 'participant', bodyLimits.json, (call) => {
      const { records } = checked(batchSchema, jsonOf(call));
      const plan = store.plans.planFor(call.study, call.participant);
      const valid = records.map((record, index) => {
        try {
          return checkedRecord(record, plan);
        } catch (error) {
          if (!(error instanceof ValidationError)) throw error;
          throw new ValidationError(`records[${index}]${error.field && `.${error.field}`}`, error.complaint);
        }
      });
      return json({ acknowledged: store.records.store(call.study, call.participant, valid, call.at) });
    }),
    route('GET', `${own}/records`, 'participant', 0, ({ study, participant }) =>
      json({ records: store.records.all(study, participant) }),
    ),
    route('PUT', `${own}/progress`, 'participant', bodyLimits.json, (call) => {
      store.places.saveProgress(call.study, call.participant, jsonOf(call), call.at);
      return done;
    }),
    route('GET', `${own}/progress`, 'participant', 0, ({ study, participant, at }) =>
      json({ progress: store.places.progress(study, participant, at) }),
    ),
    route('GET', `${own}/commands`, 'participant', 0, ({ study, participant, query }) => {
      const { after } = checked(sinceSchema, { after: Number(query.get('after') ?? 0) });
      return json({ commands: store.commands.after(study, participant, after) });
    }),
    route('POST', `${own}/commands`, 'experimenter', bodyLimits.json, (call) => {
      const command = checked(commandSchema, jsonOf(call));
      return json({ number: store.commands.add(call.study, call.participant, command, call.at) }, 201);
    }),
    route('POST', `${own}/remarks`, 'experimenter', bodyLimits.json, (call) => {
      const remark = checked(remarkSchema, jsonOf(call));
      return json({ id: store.records.addRemark(call.study, call.participant, remark.text, call.at) }, 201);
    }),
    route('PUT', `${own}/motion`, 'participant', bodyLimits.motion, ({ study, participant, at, query, body }) => {
      const { trial } = checked(motionSchema, { trial: query.get('trial') });
      const recording = textOf({ body });
      try {
        parseRecording(recording);
      } catch (error) {
        throw new HttpError(400, (error as Error).message);
      }
      store.motion.store(study, participant, trial, recording, at);
      return done;
    }),
    signing(`${own}/seat`, async (call) => {
      const trial = checked(seatSchema, jsonOf(call));
      const plan = store.plans.planFor(call.study, call.participant);
      // A request that is admitted without the participant's token is from an experimenter, who watches.
      return json(await seats.sign(plan, call.participant, trial, !guard.isParticipant(call)));
    }),
    exporting(`${own}/export`, 'participant', ({ study, participant, at }) =>
      exportOf({ store, software, makeZip }, { at, study, participant }),
    ),
    route('DELETE', own, 'experimenter', 0, ({ study, participant, at }) =>
      json(store.deletion.delete(study, participant, 'experimenter', at)),
    ),
  ];
}

export function createStudyRoutes({ seats, software, makeZip, ...guarded }: StudyRoutesOptions): StudyRoutes {
  const guard = createStudyGuard(guarded);
  const table = { store: guarded.store, guard, seats, software, makeZip };
  return {
    routes: [...studyTable(table), ...participantTable(table)],
    admit: async ({ access }, request) => guard.admit(access, concerned(request)),
    handle: ({ handle }, request, body) =>
      handle({ ...concerned(request), at: request.at, query: new URLSearchParams(request.query), body }),
  };
}
