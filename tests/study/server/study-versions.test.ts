import { strFromU8, unzipSync } from 'fflate';
import { describe, expect, test } from 'vitest';
import { togetherWith } from '../../../src/study/model/plan/allocation';
import type { StudyPlan } from '../../../src/study/model/plan/plan';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { latencyPlan, paperPlan, session } from '../model/studies';
import { experimenter, now, servedStudies } from './running-studies';

const later = latencyPlan({ title: 'A body that follows much later' });

/** Returns the complete session of a participant by this plan. */
function recordsOf(plan: StudyPlan, participant: string) {
  const one = session(scheduleFor(plan, participant));
  one.doUntil(({ kind }) => kind === 'end');
  return one;
}

/** Returns a server with the study of three latencies, which P01 has finished. */
async function begunStudy() {
  const server = await servedStudies();
  const plan = latencyPlan();
  server.store.plans.add(plan, { simulated: false, at: now });
  const of = (participant: string) => `/api/studies/latency/participants/${participant}`;
  const take = async (participant: string, by: StudyPlan) => {
    const { json } = await server.ask('POST', `${of(participant)}/claim`, { token: experimenter, json: {} });
    const { records, progress } = recordsOf(by, participant);
    const sent = await server.ask('POST', `${of(participant)}/records`, { token: json.token, json: { records } });
    expect(sent.status).toBe(200);
    expect((await server.ask('PUT', `${of(participant)}/progress`, { token: json.token, json: progress })).status).toBe(
      204,
    );
    return json as { token: string; plan: StudyPlan };
  };
  const change = (changed: StudyPlan, newVersion?: boolean) =>
    server.ask('POST', '/api/studies', {
      token: experimenter,
      json: { plan: changed, simulated: false, ...(newVersion && { newVersion }) },
    });
  const see = async (path: string) =>
    (await server.ask('GET', `/api/studies/latency${path}`, { token: experimenter })).json;
  await take('P01', plan);
  return { ...server, plan, of, take, change, see };
}

/** The plan with another question after each round. */
const asksMore = latencyPlan({
  questionnaires:
    latencyPlan().questionnaires?.map((asked) => ({
      ...asked,
      questions: [...asked.questions, { id: 'late', text: 'My body came too late.' }],
    })) ?? [],
});

describe('a plan that has participants', () => {
  test('is frozen: a change is refused in a sentence with its holder and the remedy', async () => {
    const { plan, change, see } = await begunStudy();
    const { status, json } = await change(later);
    expect(status).toBe(409);
    expect(json.field).toBe('newVersion');
    expect(json.error).toContain('has begun: P01 keep its plan. Add the plan as version 2');
    expect((await change(plan)).status).toBe(201);
    expect((await see('/records')).versions).toHaveLength(1);
  });

  test('becomes a new version for those who come later; who began stays with theirs', async () => {
    const { plan, change, take, see, ask, of } = await begunStudy();
    expect((await change(asksMore, true)).json).toMatchObject({
      version: 2,
      versions: [{ participants: ['P01'] }, { participants: [] }],
    });
    const { token, plan: followed } = await take('P02', asksMore);
    expect(followed).toEqual(asksMore);
    const states = (await see('/participants')).participants as { participant: string; version: number }[];
    expect(states.map(({ version }) => version)).toEqual([1, ...states.slice(1).map(() => 2)]);
    // Later records of each participant are checked by that participant's plan.
    const [, answers] = recordsOf(asksMore, 'P01').records.filter(({ kind }) => kind === 'answers');
    const more = { ...answers, id: 'archery/1/questionnaire@9.1:answers' };
    const p01 = await ask('POST', `${of('P01')}/records`, { token: experimenter, json: { records: [more] } });
    expect(p01.status).toBe(200);
    const consent = await ask('GET', '/api/studies/latency?participant=P01');
    expect(consent.json.title).toBe(plan.title);
    expect(token).toMatch(/./);
  });

  test('has results and exports of each version apart', { tags: ['full'] }, async () => {
    const { change, take, see, ask } = await begunStudy();
    await change(asksMore, true);
    await take('P02', asksMore);
    const who = (recorded: { records: { participant: string }[] }) => [
      ...new Set(recorded.records.map((one) => one.participant)),
    ];
    expect(who(await see('/records'))).toEqual(['P02']);
    expect(who(await see('/records?version=1'))).toEqual(['P01']);
    for (const [version, participant, questions] of [
      [1, 'P01', 14],
      [2, 'P02', 15],
    ] as const) {
      const zip = await ask('GET', `/api/studies/latency/export?version=${version}`, { token: experimenter });
      expect(zip.headers.get('content-disposition')).toContain(`latency-version-${version}.zip`);
      const files = unzipSync(zip.body);
      const answers = strFromU8(files[`latency-version-${version}/answers.csv`] as Uint8Array)
        .trimEnd()
        .split('\r\n')
        .slice(1);
      expect(answers).toHaveLength(3 * questions);
      for (const row of answers) expect(row).toContain(`latency,${participant},`);
    }
    expect((await ask('GET', '/api/studies/latency/export?version=3', { token: experimenter })).status).toBe(404);
  });

  test('keeps links that were sent, its withdrawal and its retention date', async () => {
    const { change, see, store } = await begunStudy();
    const invitations = async () =>
      (await see('/participants')).participants.map(({ invitation }: { invitation: string }) => invitation);
    const before = await invitations();
    await change({ ...later, participants: 24, retentionDays: 3650 }, true);
    const after = await invitations();
    expect(after.slice(0, 18)).toEqual(before);
    expect(new Set(after).size).toBe(24);
    expect(store.plans.get('latency').retentionUntil).toBe(now + 365 * 86_400);
  });

  test('keeps its one invitation if it is open, also for places of the new version', async () => {
    const { store } = await servedStudies();
    const open = latencyPlan({ entry: 'open', participants: 6 });
    store.plans.add(open, { simulated: false, at: now });
    const invitations = () => store.overview('latency', now).map(({ invitation }) => invitation);
    const [sent] = invitations();
    for (const { participant } of store.overview('latency', now)) store.places.claim('latency', participant, now);
    store.plans.add({ ...open, participants: 12 }, { simulated: false, at: now, newVersion: true });
    expect(invitations()).toEqual(Array.from({ length: 12 }, () => sent));
  });

  test('does not give its participants other codes: links that were sent would open nothing', async () => {
    const { change, see } = await begunStudy();
    const { status, json } = await change({ ...later, participants: 120 }, true);
    expect(status).toBe(400);
    expect(json).toMatchObject({ field: 'participants', error: expect.stringContaining('from P01 to P001') });
    expect((await see('/participants')).participants).toHaveLength(18);
    expect((await change({ ...later, participants: 99 }, true)).status).toBe(201);
  });

  test('does not change its consent text under the same version of the text', async () => {
    const { change, plan } = await begunStudy();
    const consent = { ...plan.consent, paragraphs: ['Another text.'] };
    expect((await change({ ...plan, consent }, true)).json).toMatchObject({ field: 'consent.version' });
    expect((await change({ ...plan, consent: { ...consent, version: '2' } }, true)).status).toBe(201);
  });

  test('is replaced without a version while no one has begun it', async () => {
    const { store } = await servedStudies();
    store.plans.add(latencyPlan(), { simulated: false, at: now });
    expect(store.plans.add(later, { simulated: false, at: now })).toMatchObject({ version: 1, plan: later });
  });
});

describe('a place that the experimenter clears', () => {
  test('is free, and the next who takes it follows the new version', async () => {
    const { change, take, of, ask, store } = await begunStudy();
    await change(asksMore, true);
    expect(store.plans.planFor('latency', 'P01')).toEqual(latencyPlan());
    expect((await ask('DELETE', of('P01'), { token: experimenter })).status).toBe(200);
    expect((await take('P01', asksMore)).plan).toEqual(asksMore);
    expect(store.overview('latency', now)[0]).toMatchObject({ participant: 'P01', version: 2 });
  });

  test('goes where the new version has no such place', async () => {
    const { change, of, ask, store } = await begunStudy();
    for (const participant of ['P02', 'P18']) store.places.claim('latency', participant, now);
    await change({ ...later, participants: 12 }, true);
    const places = () => store.overview('latency', now).map(({ participant }) => participant);
    expect(places()).toHaveLength(13);
    expect((await ask('DELETE', of('P18'), { token: experimenter })).status).toBe(200);
    expect(places()).toHaveLength(12);
    expect(store.deletion.receipts('latency')).toMatchObject([{ participant: 'P18', reason: 'experimenter' }]);
  });

  test('stays with its version of a group until the last member who began leaves it', async () => {
    const { store } = await servedStudies();
    store.plans.add(paperPlan(), { simulated: false, at: now });
    const [first = '', second = '', third = ''] = togetherWith(paperPlan(), 'P04');
    for (const participant of [first, second]) store.places.claim('paper', participant, now);
    store.plans.add(paperPlan({ title: 'Changed' }), { simulated: false, newVersion: true, at: now });
    const versions = () => {
      const states = store.overview('paper', now);
      return [first, second, third].map((one) => states.find(({ participant }) => participant === one)?.version);
    };
    store.deletion.delete('paper', first, 'experimenter', now);
    expect(versions()).toEqual([1, 1, 1]);
    store.deletion.delete('paper', second, 'experimenter', now);
    expect(versions()).toEqual([2, 2, 2]);
  });

  test('stays where the new version groups it with a participant who began', async () => {
    const { store } = await servedStudies();
    const plan = paperPlan({ participants: 6 });
    store.plans.add(plan, { simulated: false, at: now });
    const one = [...togetherWith(plan, 'P01')];
    const other = ['P01', 'P02', 'P03', 'P04', 'P05', 'P06'].find((name) => !one.includes(name)) as string;
    for (const participant of ['P01', other]) store.places.claim('paper', participant, now);
    // Another seed makes other groups, but all places keep their version, so nothing is mixed.
    const seed = [1, 2, 3, 4, 5, 6, 7, 8].find((value) =>
      [...togetherWith({ ...plan, seed: value }, 'P01')].some((name) => !one.includes(name)),
    );
    store.plans.add({ ...plan, seed: seed as number }, { simulated: false, newVersion: true, at: now });
    store.deletion.delete('paper', 'P01', 'experimenter', now);
    expect(store.overview('paper', now).map(({ version }) => version)).toEqual([1, 1, 1, 1, 1, 1]);
  });

  test('is taken, in a study opened to all, by everyone’s invitation, not the old one', async () => {
    const { store } = await servedStudies();
    const invited = latencyPlan({ participants: 6 });
    store.plans.add(invited, { simulated: false, at: now });
    const invitations = () => store.overview('latency', now).map(({ invitation }) => invitation);
    const old = invitations()[0] as string;
    store.places.claim('latency', 'P01', now);
    store.plans.add({ ...invited, entry: 'open' }, { simulated: false, at: now, newVersion: true });
    const [, ofAll] = invitations();
    store.deletion.delete('latency', 'P01', 'experimenter', now);
    expect(invitations()).toEqual(Array.from({ length: 6 }, () => ofAll));
    expect(store.places.acceptsInvitation('latency', 'P01', old)).toBe(false);
  });

  test('stays taken for a participant who has withdrawn', async () => {
    const { change, store } = await begunStudy();
    await change(asksMore, true);
    store.deletion.delete('latency', 'P01', 'withdrawn', now);
    expect(store.overview('latency', now)[0]).toMatchObject({ participant: 'P01', version: 1, withdrawn: true });
  });
});

describe('those who play together', () => {
  test('follow one version: the group of a participant who began stays with them', async () => {
    const { store } = await servedStudies();
    const plan = paperPlan();
    store.plans.add(plan, { simulated: false, at: now });
    store.places.claim('paper', 'P04', now);
    const changed = paperPlan({ title: 'Changed' });
    store.plans.add(changed, { simulated: false, newVersion: true, at: now });
    const group = togetherWith(plan, 'P04');
    expect(group.size).toBe(3);
    for (const { participant, version } of store.overview('paper', now)) {
      expect(version).toBe(group.has(participant) ? 1 : 2);
      expect(store.plans.planFor('paper', participant).title).toBe(group.has(participant) ? plan.title : 'Changed');
    }
  });

  test('are never mixed: a change that would add others to their group is refused', async () => {
    const { store } = await servedStudies();
    store.plans.add(paperPlan(), { simulated: false, at: now });
    store.places.claim('paper', 'P04', now);
    const change = () => store.plans.add(paperPlan({ seed: 1 }), { simulated: false, newVersion: true, at: now });
    expect(change).toThrow(/would play with P\d\d, who stays with version 1: leave seed/);
    expect(store.plans.get('paper').versions).toHaveLength(1);
  });
});
