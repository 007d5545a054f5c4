import { describe, expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { begin, type Progress } from '../../../src/study/model/progress/progress';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import { reportFigures } from '../../reliability/report-figures';
import { completed, paperPlan, session, shortRecording } from '../model/studies';
import { experimenter, now, servedPaperStudy } from './running-studies';
import { asSent } from './stored-studies';

const place = '/api/studies/paper/participants/P01';
const schedule = scheduleFor(paperPlan(), 'P01');

/** P01 on their device: what its page sends. */
async function participant() {
  const served = await servedPaperStudy();
  const token = await served.claim('P01');
  const headers = { authorization: `Bearer ${token}`, 'content-type': 'application/json' };
  return {
    ...served,
    send: (records: readonly unknown[]) => served.ask('POST', `${place}/records`, { token, json: { records } }),
    report: (progress: unknown) => served.ask('PUT', `${place}/progress`, { token, json: progress }),
    sendMotion: async () =>
      (await served.ask('PUT', `${place}/motion?trial=archery/1/trial-1`, { raw: { headers, body: shortRecording } }))
        .status,
  };
}

const consentOf = (motion: boolean, id = 'consent'): StudyRecord => {
  const [consent] = completed('P01', { motion });
  return { ...(consent as StudyRecord), id };
};

describe('consent to motion that was taken back', () => {
  test('stays taken back when the first consent is sent once more', async () => {
    const { send, sendMotion } = await participant();
    await send([consentOf(true)]);
    expect(await sendMotion()).toBe(204);
    await send([consentOf(false, 'consent-again')]);
    expect(await sendMotion()).toBe(403);
    expect((await send([consentOf(true)])).status).toBe(200);
    expect(await sendMotion()).toBe(403);
  });

  test('stays taken back at the server when another device reported that', async () => {
    const { send, report, sendMotion } = await participant();
    await send([consentOf(true)]);
    const progress = { ...begin(schedule), step: 'demographics', motion: true, changes: 1 };
    await report(progress);
    expect(await sendMotion()).toBe(204);
    await report({ ...progress, motion: false, changes: 2 });
    expect(await sendMotion()).toBe(403);
    await report({ ...progress, changes: 3 });
    expect(await sendMotion(), 'a report is no consent').toBe(403);
  });
});

test('before consent no progress is stored, whose answers would be recorded without it', async () => {
  const { report, store } = await participant();
  const { status, json } = await report({ ...begin(schedule), motion: false, step: 'demographics' });
  expect([status, json.error]).toEqual([403, 'P01 has not consented: nothing is recorded']);
  expect(store.places.progress('paper', 'P01')).toBeNull();
});

test('reports that arrive in any order, some twice, leave the latest', async () => {
  const { send, report, store } = await participant();
  const one = session(schedule);
  const reports: Progress[] = [];
  for (const kind of ['demographics', 'calibration', 'tutorial', 'trial', 'questionnaire', 'end'] as const) {
    one.doUntil((step) => step.kind === kind);
    reports.push(one.progress);
  }
  await send(one.records.slice(0, 1));
  const latest = reports.at(-1);
  const arrivals = [1, 0, 1, 3, 2, 5, 4, 0, 3].map((index) => reports[index]);
  for (const progress of arrivals) expect((await report(progress)).status).toBe(204);
  expect(store.places.progress('paper', 'P01')).toEqual(latest);
  reportFigures('study-replays', { 'reports out of order that led back': `0 of ${arrivals.length}` });
});

test('records that arrive in any order, in batches that overlap, are stored once each', async () => {
  const { send, store } = await participant();
  const records = completed();
  const [consent, ...others] = records as [StudyRecord, ...StudyRecord[]];
  expect((await send([others[0]])).status, 'before consent').toBe(403);
  await send([consent]);
  for (const batch of [others.slice(5), others.slice(0, 8), records.toReversed(), others.slice(3, 6)]) {
    expect((await send(batch)).status).toBe(200);
  }
  const stored = store.records.all('paper', 'P01').map(asSent);
  expect(new Map(stored.map((record) => [record.id, record]))).toEqual(
    new Map(records.map((record) => [record.id, record])),
  );
  expect(stored).toHaveLength(records.length);
  reportFigures('study-replays', { 'records stored twice or lost': `0 of ${records.length}` });
});

test('a link that twenty people open at once gives one the place, the others nothing', async () => {
  const { ask, invited, store } = await servedPaperStudy();
  const claims = await Promise.all(
    Array.from({ length: 20 }, () => ask('POST', `${place}/claim`, { json: invited('P01') })),
  );
  const taken = claims.filter(({ status }) => status === 201);
  expect(taken).toHaveLength(1);
  for (const { status, json } of claims) {
    if (status === 201) continue;
    expect([status, Object.keys(json)]).toEqual([409, ['error', 'field']]);
  }
  expect(store.places.holds('paper', 'P01', taken[0]?.json.token)).toBe(true);
  reportFigures('study-replays', { 'places that one link gave to twenty people': taken.length });
});

test('a participant’s page cannot take the names of the experimenter’s remarks, which would keep them out', async () => {
  const { ask, send } = await participant();
  await send(completed());
  const remark = {
    ...{ version: 1, study: 'paper', participant: 'P01', simulated: false, at: now },
    ...{ kind: 'event', body: { type: 'remark', text: 'all went well' } },
  };
  const forged = Array.from({ length: 50 }, (_, number) => ({ ...remark, id: `experimenter-${number}` }));
  expect((await send(forged)).status).toBe(403);
  const real = await ask('POST', `${place}/remarks`, { token: experimenter, json: { text: 'the headset slipped' } });
  expect(real.status).toBe(201);
});
