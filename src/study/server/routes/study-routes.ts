import { checked, integerBetween, participantId, text } from 'threepoint/core';
import { type HttpResponse, jsonOf, jsonResponse, noContent } from 'threepoint-http';
import * as v from 'valibot';
import { languagesOf, type StudyPlan, studyTitle } from '../../model/plan/plan';
import type { PlanVersion, StudyInfo } from '../../model/progress/study-api';
import { exportName } from '../export/export-zip';
import type { StudyStorage } from '../study-storage';
import { bodyLimits, route, type StudyParts, type StudyRoute } from './route';

const newStudySchema = v.strictObject({
  plan: v.unknown(),
  simulated: v.boolean('expected true or false'),
  newVersion: v.optional(v.boolean('expected true or false')),
});
const versionSchema = v.object({ version: v.optional(integerBetween(1, 10_000)) });
/** `only`: what of the participant is deleted; absent: everything. */
const withdrawalSchema = v.object({ code: text(60), only: v.optional(v.literal('motion')) });

/** Returns the public part of a plan. Participants get the order and names of conditions only with their schedule. */
const publicPlan = (plan: StudyPlan, simulated: boolean) => {
  const { id, title, consent, remote, phrases = {} } = plan;
  return { id, title, consent, languages: languagesOf(plan), phrases, simulated, contact: remote?.contact ?? null };
};

/** Returns the requested version of the plan, or undefined for the newest. */
function versionIn(query: URLSearchParams): number | undefined {
  const asked = query.get('version');
  return checked(versionSchema, asked === null ? {} : { version: Number(asked) }).version;
}

/** Returns a study with the records of participants who follow the version of its plan that `info` shows. */
async function recordsOf(store: Pick<StudyStorage, 'records'>, info: StudyInfo): Promise<HttpResponse> {
  const { participants } = info.versions.find(({ version }) => version === info.version) as PlanVersion;
  const head = `${JSON.stringify(info).slice(0, -1)},"records":`;
  const records = await store.records.listed(info.plan.id, new Set(participants));
  const body = Buffer.concat([Buffer.from(head), ...records, Buffer.from('}\n')]);
  return { ...jsonResponse(null), body };
}

interface ExportAsked {
  readonly at: number;
  readonly study: string;
  readonly participant?: string;
  readonly version?: number | undefined;
}

/** Resolves with the answer that contains an export. */
export async function exportOf({ store, software, makeZip }: StudyParts, asked: ExportAsked): Promise<HttpResponse> {
  const { study, participant, version } = asked;
  const info = await store.plans.get(study, version);
  if (participant !== undefined) await store.places.get(study, participant);
  const plan = participant === undefined ? info.plan : await store.plans.planFor(study, participant);
  const planVersion = participant === undefined && info.versions.length > 1 ? info.version : undefined;
  const name = exportName({ plan, simulated: info.simulated, ...(planVersion && { planVersion }) }, participant);
  return {
    status: 200,
    headers: { 'content-type': 'application/zip', 'content-disposition': `attachment; filename="${name}.zip"` },
    body: await makeZip({ ...asked, version: info.version, software }),
  };
}

export function studyRoutes(parts: StudyParts): StudyRoute[] {
  const { store, guard } = parts;
  return [
    route('GET', '', 'experimenter', 0, async () =>
      jsonResponse({
        studies: (await store.plans.all()).map(({ plan, versions: _, ...rest }) => {
          const { id, participants } = plan;
          return { id, title: studyTitle(plan), participants, ...rest };
        }),
      }),
    ),
    route('POST', '', 'experimenter', bodyLimits.json, async (call) => {
      const { plan, simulated, newVersion = false } = checked(newStudySchema, jsonOf(call));
      return jsonResponse(await store.plans.add(plan, { simulated, newVersion, at: call.at }), 201);
    }),
    // Participants who have begun read the text of their version.
    route('GET', '/:study', 'anyone', 0, async ({ study, query }) => {
      const { plan, simulated } = await store.plans.get(study);
      const participant = query.get('participant');
      const read = participant === null ? plan : await store.plans.planFor(study, checked(participantId, participant));
      return jsonResponse(publicPlan(read, simulated));
    }),
    route('DELETE', '/:study', 'experimenter', 0, async ({ study }) => {
      await store.deletion.deleteSimulated(study);
      return noContent;
    }),
    route('GET', '/:study/records', 'experimenter', 0, async ({ study, query }) => {
      return recordsOf(store, await store.plans.get(study, versionIn(query)));
    }),
    route('GET', '/:study/receipts', 'experimenter', 0, async ({ study }) => {
      await store.plans.get(study);
      return jsonResponse({ receipts: await store.deletion.receipts(study) });
    }),
    {
      ...route('GET', '/:study/export', 'experimenter', 0, ({ study, at, query }) =>
        exportOf(parts, { at, study, version: versionIn(query) }),
      ),
      isPatient: true,
    },
    route('GET', '/:study/participants', 'experimenter', 0, async ({ study, at }) =>
      jsonResponse({ participants: await store.overview(study, at) }),
    ),
    {
      ...route('POST', '/:study/withdraw', 'withdrawing', bodyLimits.json, async (call) => {
        const { code, only } = checked(withdrawalSchema, jsonOf(call));
        const withdraw = () =>
          only === 'motion'
            ? store.deletion.withdrawMotion(call.study, code, call.at)
            : store.deletion.withdraw(call.study, code, call.at);
        return jsonResponse(await guard.withdrawing(call, code, withdraw));
      }),
      effect: 'withdraws',
    },
  ];
}
