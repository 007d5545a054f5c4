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
  /** What serves the studies: exports say it. */
  readonly software: Software;
  readonly makeZip: Exporter;
}

/** Longest bodies [bytes]. */
export const bodyLimits = { json: 512 * 1024, motion: mostMotionBytes } as const;
export const mostRecordsAtOnce = 200;

const prefix = '/api/studies';

/** A request to a route of the studies, as it crosses from the thread of the sockets to that of the database. */
export interface StudyRequest {
  /** When it came: seconds since 1970. */
  readonly at: number;
  readonly token: string | null;
  readonly address: ClientAddress | null;
  /** What the address has for the route's ":names"; not yet checked. */
  readonly names: Readonly<Record<string, string>>;
  /** What follows the "?". */
  readonly query: string;
}

/** A request whose names are checked: the study and, where the route has one, the participant; else empty. */
interface StudyCall extends Concerned {
  readonly at: number;
  readonly query: URLSearchParams;
  readonly body: Uint8Array<ArrayBuffer>;
}

export interface StudyRoute extends Omit<Route<StudyAccess>, 'handle'> {
  /** Its answer waits until what it changed is on the disk. */
  readonly changes: boolean;
  /** Its answer takes as long as it takes. */
  readonly isPatient: boolean;
  handle(call: StudyCall): Answer | Promise<Answer>;
}

/** All below /api/studies. A participant's token opens nothing but that participant. */
export interface StudyRoutes {
  readonly routes: readonly StudyRoute[];
  /** Throws an HttpError where this request may not; asked before the body is read. */
  admit(route: StudyRoute, request: StudyRequest): Promise<void>;
  handle(route: StudyRoute, request: StudyRequest, body: Uint8Array<ArrayBuffer>): Answer | Promise<Answer>;
}

const concerned = ({ token, address, names }: StudyRequest): Concerned => ({
  ...{ token, address },
  study: names.study === undefined ? '' : checked(identifier, names.study),
  participant: names.participant === undefined ? '' : checked(participantId, names.participant),
});

type Handle = StudyRoute['handle'];

/** One line of the table: its path is below the prefix, its body JSON of at most so many bytes. */
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
/** `consent`: version of the text that the participant has read. */
const claimSchema = v.strictObject({ invitation: v.optional(text(60)), consent: v.optional(text(40)) });
const seatSchema = v.strictObject({ step: text(120), run: integerBetween(1, 99) });
const remarkSchema = v.strictObject({ text: text(2000) });
const sinceSchema = v.object({ after: integerBetween(0, 2 ** 53 - 1) });
const notATrial = 'expected the id of a trial record';
const motionSchema = v.object({
  trial: v.pipe(v.string(notATrial), v.regex(/^[a-z0-9][a-z0-9/@.:-]{0,119}$/, notATrial)),
});

/** What a participant may know of a plan: the order and names of conditions come only with their own schedule. */
const publicPlan = (plan: StudyPlan, simulated: boolean) => {
  const { id, title, consent, remote, phrases = {} } = plan;
  return { id, title, consent, languages: languagesOf(plan), phrases, simulated, contact: remote?.contact ?? null };
};

const statusOfRefusal = {
  ...{ unknown: 404, conflict: 409, begun: 409, forbidden: 403, locked: 503, busy: 503, full: 507, lost: 507 },
} as const satisfies Readonly<Record<StoreRefusal['reason'], number>>;

/** What a page waits before it asks again where the database is locked or busy [s]. */
export const retryAfterSeconds = 5;

interface TableOptions {
  readonly store: StudyStore;
  readonly guard: StudyGuard;
  readonly seats: StudySeats;
  readonly software: Software;
  readonly makeZip: Exporter;
}

type Exporting = Pick<TableOptions, 'store' | 'software' | 'makeZip'>;

/** The version of the plan that is asked for; undefined: the newest. */
function versionIn(query: URLSearchParams): number | undefined {
  const asked = query.get('version');
  return checked(versionSchema, asked === null ? {} : { version: Number(asked) }).version;
}

/** A study with what was recorded of those who follow the version of its plan that `info` shows. */
function recordsOf(store: StudyStore, info: StudyInfo): Answer {
  const { participants } = info.versions.find(({ version }) => version === info.version) as PlanVersion;
  const head = `${JSON.stringify(info).slice(0, -1)},"records":`;
  const records = store.records.listed(info.plan.id, new Set(participants));
  const body = Buffer.concat([Buffer.from(head), ...records, Buffer.from('}\n')]);
  return { ...json(null), body };
}

/** What an error is to the other side; null: a fault of the server. */
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

/** A route whose answer is an export. */
const exporting = (path: string, access: StudyAccess, handle: Handle): StudyRoute => ({
  ...route('GET', path, access, 0, handle),
  isPatient: true,
});

/** What is of one study, and of the server as a whole. */
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
    // A participant who has begun reads the text of the version that is theirs.
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

/** What a device goes by that has taken a participant's place: a session that another device began goes on where that one was. */
const sessionOf = ({ store }: Pick<TableOptions, 'store'>, { study, participant, at }: StudyCall) => ({
  plan: store.plans.planFor(study, participant),
  simulated: store.plans.get(study).simulated,
  progress: store.places.progress(study, participant, at),
  ...profileFrom(store.records.all(study, participant)),
});

/** Throws where a plan that was stored could not be a new study's any more: nothing can be recorded by its rules. */
function refuseOutdated(plan: StudyPlan): void {
  try {
    checkedPlan(plan);
  } catch (error) {
    if (!(error instanceof ValidationError)) throw error;
    throw new HttpError(
      409,
      `the plan of this study is of an older version of the program, and today it is refused: ${error.message}. ` +
        'What was recorded can be exported and deleted; a study with another plan needs another id',
    );
  }
}

/** `read`: version of the text that was consented to; undefined: not told. Throws where the plan shows another one, and the place stays free. */
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

/** A route that signs: it takes a body and changes nothing. */
const signing = (path: string, handle: Handle): StudyRoute => ({
  ...route('POST', path, 'participant', bodyLimits.json, handle),
  changes: false,
});

/** What is of one participant. */
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
      // Let in without being this participant: an experimenter, who watches.
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
