import type { IncomingMessage } from 'node:http';
import * as v from 'valibot';
import { wearerIn } from '../src/core/study/known-wearer';
import { checkedPlan, languagesOf, type StudyPlan, studyTitle } from '../src/core/study/plan';
import { mostMotionBytes, type PlanVersion, type StudyInfo } from '../src/core/study/study-api';
import { checkedRecord } from '../src/core/study/study-record';
import {
  checked,
  identifier,
  integerBetween,
  participantId,
  text,
  ValidationError,
} from '../src/core/study/validation';
import { parseRecording } from '../src/core/tracking/recording';
import { type Answer, done, HttpError, json } from './http/answer';
import { type Call, jsonOf, type Route, type Service } from './http/router';
import type { Software } from './software';
import { StoreRefusal } from './study-database';
import { exportName } from './study-export';
import { createExporter } from './study-export-thread';
import { createStudyGuard, type StudyAccess, type StudyGuard, type StudyGuardOptions } from './study-guard';
import type { StudySeats } from './study-seats';
import type { StudyStore } from './study-store';

export interface StudyRoutesOptions extends StudyGuardOptions {
  /** Signs participants into the rooms of their trials. */
  readonly seats: StudySeats;
  /** What serves the studies: exports say it. */
  readonly software: Software;
  /** Seconds since 1970. */
  readonly now: () => number;
  /** Told of faults of ours; the participant hears only that there was one. */
  readonly onFault: (error: unknown) => void;
}

/** Longest bodies [bytes]. */
export const bodyLimits = { json: 512 * 1024, motion: mostMotionBytes } as const;
export const mostRecordsAtOnce = 200;

const prefix = '/api/studies';

interface StudyCall extends Call {
  /** From the address: the study and, where the route has one, the participant; else empty. */
  readonly study: string;
  readonly participant: string;
}

const namesOf = ({ names }: Pick<Call, 'names'>) => ({
  study: names.study === undefined ? '' : checked(identifier, names.study),
  participant: names.participant === undefined ? '' : checked(participantId, names.participant),
});

/** One line of the table: its path is below the prefix, its body JSON of at most so many bytes. */
const route = (
  method: Route['method'],
  path: string,
  access: StudyAccess,
  bodyLimit: number,
  handle: (call: StudyCall) => Answer | Promise<Answer>,
): Route<StudyAccess> => ({
  method,
  path: `${prefix}${path}`,
  access,
  bodyLimit,
  handle: (call) => handle({ ...call, ...namesOf(call) }),
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

const statusOfRefusal = { unknown: 404, conflict: 409, begun: 409, forbidden: 403, full: 507 } as const;

interface TableOptions {
  readonly store: StudyStore;
  readonly now: () => number;
  readonly guard: StudyGuard;
  readonly seats: StudySeats;
  readonly software: Software;
  readonly makeZip: ReturnType<typeof createExporter>;
}

type Exporting = Pick<TableOptions, 'store' | 'now' | 'software' | 'makeZip'>;

/** The version of the plan that is asked for; undefined: the newest. */
function versionIn(query: URLSearchParams): number | undefined {
  const asked = query.get('version');
  return checked(versionSchema, asked === null ? {} : { version: Number(asked) }).version;
}

/** What was recorded of those who follow this version of the plan. */
const ofVersion = <Row extends { readonly participant: string }>(rows: readonly Row[], info: StudyInfo) => {
  const { participants } = info.versions.find(({ version }) => version === info.version) as PlanVersion;
  return rows.filter(({ participant }) => participants.includes(participant));
};

function refusalOf({ reason, message }: StoreRefusal): HttpError {
  return new HttpError(statusOfRefusal[reason], message, { field: reason === 'begun' ? 'newVersion' : null });
}

interface ExportAsked {
  readonly study: string;
  readonly participant?: string;
  readonly version?: number | undefined;
}

/** Resolves with what the other side waits for. Nothing moves on its connection meanwhile, which would be ended as a silent one. */
async function awaited<T>({ socket }: IncomingMessage, answer: Promise<T>): Promise<T> {
  const silenceMs = socket.timeout ?? 0;
  socket.setTimeout(0);
  try {
    return await answer;
  } finally {
    socket.setTimeout(silenceMs);
  }
}

async function exportOf(
  { store, now, software: exportedBy, makeZip }: Exporting,
  { request }: StudyCall,
  { study, participant, version: asked }: ExportAsked,
): Promise<Answer> {
  const info = store.study(study, asked);
  const plan = participant === undefined ? info.plan : store.planFor(study, participant);
  const { simulated, createdAt, retentionUntil, versions, version } = info;
  const software = { exportedBy, served: store.softwareSince(createdAt) };
  const about = {
    ...{ plan, simulated, at: now(), retentionUntil, software },
    ...(participant === undefined && versions.length > 1 && { planVersion: version }),
  };
  const zip = makeZip(() => {
    const records = store.records(study, participant);
    const motion = store.motion(study, participant);
    if (participant !== undefined) return { content: { ...about, records, motion }, participant };
    return { content: { ...about, records: ofVersion(records, info), motion: ofVersion(motion, info) } };
  });
  const name = exportName(about, participant);
  return {
    status: 200,
    headers: { 'content-type': 'application/zip', 'content-disposition': `attachment; filename="${name}.zip"` },
    body: await awaited(request, zip),
  };
}

/** What is of one study, and of the server as a whole. */
function studyTable({ store, now, guard, software, makeZip }: TableOptions): Route<StudyAccess>[] {
  return [
    route('GET', '', 'experimenter', 0, () =>
      json({
        studies: store.studies().map(({ plan, versions: _, ...rest }) => {
          const { id, participants } = plan;
          return { id, title: studyTitle(plan), participants, ...rest };
        }),
      }),
    ),
    route('POST', '', 'experimenter', bodyLimits.json, (call) => {
      const { plan, simulated, newVersion = false } = checked(newStudySchema, jsonOf(call));
      return json(store.addStudy(checkedPlan(plan), { simulated, newVersion, at: now() }), 201);
    }),
    // A participant who has begun reads the text of the version that is theirs.
    route('GET', '/:study', 'anyone', 0, ({ study, query }) => {
      const { plan, simulated } = store.study(study);
      const participant = query.get('participant');
      const read = participant === null ? plan : store.planFor(study, checked(participantId, participant));
      return json(publicPlan(read, simulated));
    }),
    route('DELETE', '/:study', 'experimenter', 0, ({ study }) => {
      store.deleteSimulated(study);
      return done;
    }),
    route('GET', '/:study/records', 'experimenter', 0, ({ study, query }) => {
      const info = store.study(study, versionIn(query));
      return json({ ...info, records: ofVersion(store.records(study), info) });
    }),
    route('GET', '/:study/receipts', 'experimenter', 0, ({ study }) => {
      store.study(study);
      return json({ receipts: store.receipts(study) });
    }),
    route('GET', '/:study/export', 'experimenter', 0, (call) =>
      exportOf({ store, now, software, makeZip }, call, { study: call.study, version: versionIn(call.query) }),
    ),
    route('GET', '/:study/participants', 'experimenter', 0, ({ study }) =>
      json({ participants: store.overview(study, now()) }),
    ),
    route('POST', '/:study/withdraw', 'withdrawing', bodyLimits.json, async (call) => {
      const { code } = checked(withdrawalSchema, jsonOf(call));
      return json(await guard.withdrawing(call, code, () => store.withdraw(call.study, code, now())));
    }),
  ];
}

/** What a device goes by that has taken a participant's place: a session that another device began goes on where that one was. */
const sessionOf = ({ store, now }: Pick<TableOptions, 'store' | 'now'>, study: string, participant: string) => ({
  plan: store.planFor(study, participant),
  simulated: store.study(study).simulated,
  progress: store.progress(study, participant, now()),
  ...wearerIn(store.records(study, participant)),
});

/** `read`: version of the text that was consented to; undefined: not told. Throws where the plan shows another one, and the place stays free. */
function takePlace(
  { store, now }: Pick<TableOptions, 'store' | 'now'>,
  { study, participant }: StudyCall,
  read: string | undefined,
) {
  const { version } = store.planFor(study, participant).consent;
  if (read !== undefined && read !== version) {
    throw new HttpError(409, `consent was given to text ${read}, but the study shows ${version}`, { field: 'consent' });
  }
  return store.claim(study, participant, now());
}

/** What is of one participant. */
function participantTable({ store, now, guard, seats, software, makeZip }: TableOptions): Route<StudyAccess>[] {
  const own = '/:study/participants/:participant';
  return [
    route('POST', `${own}/claim`, 'invited', bodyLimits.json, async (call) => {
      const { study, participant } = call;
      const { invitation, consent } = checked(claimSchema, jsonOf(call));
      const claim = () => takePlace({ store, now }, call, consent);
      const { token, withdrawalCode } = await guard.claiming(call, invitation, claim);
      return json({ token, withdrawalCode, ...sessionOf({ store, now }, study, participant) }, 201);
    }),
    route('POST', `${own}/invitation`, 'experimenter', 0, ({ study, participant }) => {
      store.reinvite(study, participant);
      return done;
    }),
    route('POST', `${own}/release`, 'experimenter', 0, ({ study, participant }) => {
      store.release(study, participant);
      return done;
    }),
    route('POST', `${own}/records`, 'participant', bodyLimits.json, (call) => {
      const { records } = checked(batchSchema, jsonOf(call));
      const plan = store.planFor(call.study, call.participant);
      const valid = records.map((record, index) => {
        try {
          return checkedRecord(record, plan);
        } catch (error) {
          if (!(error instanceof ValidationError)) throw error;
          throw new ValidationError(`records[${index}]${error.field && `.${error.field}`}`, error.complaint);
        }
      });
      return json({ acknowledged: store.storeRecords(call.study, call.participant, valid, now()) });
    }),
    route('GET', `${own}/records`, 'participant', 0, ({ study, participant }) =>
      json({ records: store.records(study, participant) }),
    ),
    route('PUT', `${own}/progress`, 'participant', bodyLimits.json, (call) => {
      store.saveProgress(call.study, call.participant, jsonOf(call), now());
      return done;
    }),
    route('GET', `${own}/progress`, 'participant', 0, ({ study, participant }) =>
      json({ progress: store.progress(study, participant, now()) }),
    ),
    route('GET', `${own}/commands`, 'participant', 0, ({ study, participant, query }) => {
      const { after } = checked(sinceSchema, { after: Number(query.get('after') ?? 0) });
      return json({ commands: store.commands(study, participant, after) });
    }),
    route('POST', `${own}/commands`, 'experimenter', bodyLimits.json, (call) => {
      const command = checked(commandSchema, jsonOf(call));
      return json({ number: store.addCommand(call.study, call.participant, command, now()) }, 201);
    }),
    route('POST', `${own}/remarks`, 'experimenter', bodyLimits.json, (call) => {
      const remark = checked(remarkSchema, jsonOf(call));
      return json({ id: store.addRemark(call.study, call.participant, remark.text, now()) }, 201);
    }),
    route('PUT', `${own}/motion`, 'participant', bodyLimits.motion, ({ study, participant, query, body }) => {
      const { trial } = checked(motionSchema, { trial: query.get('trial') });
      try {
        parseRecording(body);
      } catch (error) {
        throw new HttpError(400, (error as Error).message);
      }
      store.storeMotion(study, participant, trial, body, now());
      return done;
    }),
    route('POST', `${own}/seat`, 'participant', bodyLimits.json, async (call) => {
      const trial = checked(seatSchema, jsonOf(call));
      const plan = store.planFor(call.study, call.participant);
      // Let in without being this participant: an experimenter, who watches.
      return json(await seats.sign(plan, call.participant, trial, !guard.isParticipant(call)));
    }),
    route('GET', `${own}/export`, 'participant', 0, (call) =>
      exportOf({ store, now, software, makeZip }, call, { study: call.study, participant: call.participant }),
    ),
    route('DELETE', own, 'experimenter', 0, ({ study, participant }) =>
      json(store.deleteParticipant(study, participant, 'experimenter', now())),
    ),
  ];
}

/** The same route, whose answer waits until what it changed is on the disk. */
const flushed = (store: StudyStore, changing: Route<StudyAccess>): Route<StudyAccess> => ({
  ...changing,
  async handle(call) {
    const answer = await changing.handle(call);
    await store.flushed();
    return answer;
  },
});

/** The study's part of the server: all below /api/studies. A participant's token opens nothing but that participant. */
export function createStudyRoutes({
  now,
  onFault,
  seats,
  software,
  ...guarded
}: StudyRoutesOptions): Service<StudyAccess> {
  const guard = createStudyGuard(guarded);
  const { store } = guarded;
  const table = { store, now, guard, seats, software, makeZip: createExporter() };
  const routes = [...studyTable(table), ...participantTable(table)];
  return {
    routes: routes.map((one) => (one.method === 'GET' ? one : flushed(store, one))),
    admit: ({ access }, { request, names }) => guard.admit(access, { request, ...namesOf({ names }) }),
    refusalOf(error) {
      if (error instanceof StoreRefusal) return refusalOf(error);
      return null;
    },
    onFault,
  };
}
