import { checked, integerBetween, parseRecording, text } from 'threepoint/core';
import { jsonOf, jsonResponse, noContent, textOf } from 'threepoint-http';
import * as v from 'valibot';
import type { StudyPlan } from '../../model/plan/plan';
import { scheduleFor } from '../../model/plan/schedule';
import { Rejection } from '../../model/progress/rejection';
import { commandSchema, type PlayedTogether, playedTogetherSchema } from '../../model/progress/study-api';
import { profileFrom } from '../../model/records/participant-profile';
import { rejectUnscheduled, rejectUnscheduledTrial } from '../../model/records/scheduled-record';
import { checkedRecord, type StudyRecord, within } from '../../model/records/study-record';
import type { StudyStorage } from '../study-storage';
import { bodyLimits, route, type StudyCall, type StudyParts, type StudyRoute } from './route';
import { exportOf } from './study-routes';

export const maxRecordsAtOnce = 200;

const batchSchema = v.object({
  records: v.pipe(
    v.array(v.unknown(), 'expected a list'),
    v.minLength(1, 'expected at least one record'),
    v.maxLength(maxRecordsAtOnce, `expected at most ${maxRecordsAtOnce} records`),
  ),
});

/** `consent` is the version of the text that the participant has read. */
const claimSchema = v.strictObject({ invitation: v.optional(text(60)), consent: v.optional(text(40)) });
const remarkSchema = v.strictObject({ text: text(2000) });
const sinceSchema = v.object({ after: integerBetween(0, 2 ** 53 - 1) });
const notATrial = 'expected the id of a trial record';
const motionSchema = v.object({
  trial: v.pipe(v.string(notATrial), v.regex(/^[a-z0-9][a-z0-9/@.:-]{0,119}$/, notATrial)),
});

/** Returns the state for a device that has taken a participant's place; a session of another device is continued. */
const sessionOf = async (store: StudyStorage, { study, participant, at }: StudyCall) => ({
  plan: await store.plans.planFor(study, participant),
  simulated: (await store.plans.get(study)).simulated,
  progress: await store.places.progress(study, participant, at),
  ...profileFrom(await store.records.all(study, participant)),
});

/**
 * Takes a place. `read` is the version of the text that was consented to, if it was sent. Throws if the plan has
 * another one; the place stays free.
 */
async function takePlace(store: StudyStorage, { study, participant, at }: StudyCall, read: string | undefined) {
  const plan = await store.plans.planFor(study, participant);
  const { version } = plan.consent;
  if (read !== undefined && read !== version) {
    throw new Rejection('conflict', `consent was given to text ${read}, but the study shows ${version}`, {
      field: 'consent',
    });
  }
  return store.places.claim(study, participant, at);
}

/** Returns these values as records of a participant; throws a ValidationError for one that no page makes. */
function recordsIn(values: readonly unknown[], plan: StudyPlan, participant: string): readonly StudyRecord[] {
  const schedule = scheduleFor(plan, participant);
  return values.map((value, index) =>
    within(`records[${index}]`, () => {
      const record = checkedRecord(value, plan);
      if (record.participant === participant) rejectUnscheduled(record, schedule);
      return record;
    }),
  );
}

/** Returns the text of a recording; throws a Rejection for another file. */
function recordingIn(call: StudyCall): string {
  const recording = textOf(call);
  try {
    parseRecording(recording);
    return recording;
  } catch (error) {
    throw new Rejection('invalid', (error as Error).message);
  }
}

/**
 * Throws a Rejection of the field `step` if another participant of the group has gone on from this trial: its match is
 * over. A participant who stopped has finished no match.
 */
async function rejectFinished({ places }: StudyStorage, call: StudyCall, plan: StudyPlan, trial: PlayedTogether) {
  const { steps, groups } = scheduleFor(plan, call.participant);
  const indexOf = (step: string) => steps.findIndex(({ id }) => id === step);
  const step = steps[indexOf(trial.step)];
  if (!step || !('task' in step)) return;
  const others = groups[step.task]?.members.filter((member) => member !== call.participant) ?? [];
  for (const other of others) {
    const progress = await places.progress(call.study, other);
    if (!progress || progress.stopped) continue;
    const run = progress.runs[`${step.task}/${step.block}`] ?? 1;
    if (run !== trial.run || indexOf(progress.step) <= indexOf(trial.step)) continue;
    throw new Rejection('conflict', `${other} has gone on: the match is over`, { field: 'step' });
  }
}

const own = '/:study/participants/:participant';

/** Returns the routes of a place: who has it, and what its device and the experimenter exchange. */
function placeRoutes({ store, guard, seats }: StudyParts): StudyRoute[] {
  return [
    route('POST', `${own}/claim`, 'invited', bodyLimits.json, async (call) => {
      const { invitation, consent } = checked(claimSchema, jsonOf(call));
      const claim = () => takePlace(store, call, consent);
      const { token, withdrawalCode } = await guard.claiming(call, invitation, claim);
      return jsonResponse({ token, withdrawalCode, ...(await sessionOf(store, call)) }, 201);
    }),
    route('POST', `${own}/invitation`, 'experimenter', 0, async ({ study, participant }) => {
      await store.places.renewInvitation(study, participant);
      return noContent;
    }),
    route('POST', `${own}/release`, 'experimenter', 0, async ({ study, participant }) => {
      await store.places.release(study, participant);
      return noContent;
    }),
    route('PUT', `${own}/progress`, 'participant', bodyLimits.json, async (call) => {
      await store.places.saveProgress(call.study, call.participant, jsonOf(call), call.at);
      return noContent;
    }),
    route('GET', `${own}/progress`, 'participant', 0, async ({ study, participant, at }) =>
      jsonResponse({ progress: await store.places.progress(study, participant, at) }),
    ),
    route('GET', `${own}/commands`, 'participant', 0, async ({ study, participant, query }) => {
      const { after } = checked(sinceSchema, { after: Number(query.get('after') ?? 0) });
      return jsonResponse({ commands: await store.commands.after(study, participant, after) });
    }),
    route('POST', `${own}/commands`, 'experimenter', bodyLimits.json, async (call) => {
      const command = checked(commandSchema, jsonOf(call));
      return jsonResponse({ number: await store.commands.add(call.study, call.participant, command, call.at) }, 201);
    }),
    {
      ...route('POST', `${own}/seat`, 'participant', bodyLimits.json, async (call) => {
        const trial = checked(playedTogetherSchema, jsonOf(call));
        const plan = await store.plans.planFor(call.study, call.participant);
        // A request that is admitted without the participant's token is from an experimenter, who watches.
        const watching = !(await guard.isParticipant(call));
        if (!watching) await rejectFinished(store, call, plan, trial);
        return jsonResponse(await seats.sign(plan, call.participant, trial, watching));
      }),
      effect: 'reads',
    },
  ];
}

function recordRoutes(parts: StudyParts): StudyRoute[] {
  const { store, guard } = parts;
  return [
    route('POST', `${own}/records`, 'participant', bodyLimits.json, async (call) => {
      const { study, participant, at } = call;
      const { records } = checked(batchSchema, jsonOf(call));
      const valid = recordsIn(records, await store.plans.planFor(study, participant), participant);
      const author = (await guard.isParticipant(call)) ? 'participant' : 'experimenter';
      return jsonResponse({ acknowledged: await store.records.store(study, participant, valid, at, author) });
    }),
    route('GET', `${own}/records`, 'participant', 0, async ({ study, participant }) =>
      jsonResponse({ records: await store.records.all(study, participant) }),
    ),
    route('POST', `${own}/remarks`, 'experimenter', bodyLimits.json, async ({ study, participant, at, body }) => {
      const { text: remark } = checked(remarkSchema, jsonOf({ body }));
      return jsonResponse({ id: await store.records.addRemark(study, participant, remark, at) }, 201);
    }),
    route('PUT', `${own}/motion`, 'participant', bodyLimits.motion, async (call) => {
      const { study, participant, at, query } = call;
      const { trial } = checked(motionSchema, { trial: query.get('trial') });
      rejectUnscheduledTrial(trial, scheduleFor(await store.plans.planFor(study, participant), participant));
      await store.motion.store(study, participant, trial, recordingIn(call), at);
      return noContent;
    }),
    {
      ...route('GET', `${own}/export`, 'participant', 0, ({ study, participant, at }) =>
        exportOf(parts, { at, study, participant }),
      ),
      isPatient: true,
    },
    route('DELETE', own, 'experimenter', 0, async ({ study, participant, at }) =>
      jsonResponse(await store.deletion.delete(study, participant, 'experimenter', at)),
    ),
  ];
}

export const participantRoutes = (parts: StudyParts): StudyRoute[] => [...placeRoutes(parts), ...recordRoutes(parts)];
