import { describe, expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { begin, reported } from '../../../src/study/model/progress/progress';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import { studyTables } from '../../../src/study/model/tables/study-tables';
import { normalisedCode } from '../../../src/study/server/codes';
import { type StudyStorage, unpacked } from '../../../src/study/server/study-storage';
import { completed, paperPlan, session } from '../model/studies';
import { now, testSoftware } from './running-studies';
import { asSent, opened } from './stored-studies';

const day = 86_400;

/** The adapters of StudyStorage; each opens an empty storage that is closed when the test ends. */
const adapters = [{ adapter: 'SQLite', open: (): StudyStorage => opened().store }];

describe.each(adapters)('a storage in $adapter', ({ open }) => {
  async function withPaperStudy(simulated = false): Promise<StudyStorage> {
    const store = open();
    await store.plans.add(paperPlan(), { simulated, at: now });
    return store;
  }

  describe('the store', () => {
    test('stores once what is sent twice, and says so both times', async () => {
      const store = await withPaperStudy();
      const records = completed();
      await store.records.store('paper', 'P01', records, now);
      expect(await store.records.store('paper', 'P01', records, now + 5)).toHaveLength(records.length);
      expect(await store.records.all('paper')).toHaveLength(records.length);
    });

    test('does not overwrite what it has', async () => {
      const store = await withPaperStudy();
      const records = completed();
      await store.records.store('paper', 'P01', records, now);
      const changed = { ...(records[1] as StudyRecord), at: 7 };
      await expect(async () => store.records.store('paper', 'P01', [changed], now)).rejects.toThrow(
        'has stored something else',
      );
      expect((await store.records.all('paper', 'P01')).map(asSent)[1]).toEqual(records[1]);
    });

    test('stores a batch whole or not at all', async () => {
      const store = await withPaperStudy();
      const records = completed();
      const foreign = { ...(records.at(-1) as StudyRecord), participant: 'P02' };
      await expect(async () =>
        store.records.store('paper', 'P01', [...records.slice(0, -1), foreign], now),
      ).rejects.toThrow('is of P02');
      expect(await store.records.all('paper')).toEqual([]);
    });

    test('stores nothing before consent, and takes consent to the shown text alone', async () => {
      const store = await withPaperStudy();
      const [consent, ...rest] = completed() as [StudyRecord, ...StudyRecord[]];
      await expect(async () => store.records.store('paper', 'P01', rest, now)).rejects.toThrow('has not consented');
      await expect(async () => store.records.addRemark('paper', 'P01', 'tall', now)).rejects.toThrow(
        'has not consented',
      );
      const old = { ...consent, body: { ...consent.body, version: '2001' } } as StudyRecord;
      await expect(async () => store.records.store('paper', 'P01', [old], now)).rejects.toThrow(
        'consent is to text 2001',
      );
      await store.records.store('paper', 'P01', [consent, ...rest], now);
    });

    test('keeps simulated people and people apart', async () => {
      const people = await withPaperStudy();
      const program = completed('P01', { simulated: true });
      await expect(async () => people.records.store('paper', 'P01', program, now)).rejects.toThrow('of people');
      const adding = async () => people.plans.add(paperPlan(), { simulated: true, at: now });
      await expect(adding).rejects.toThrow('give this one another id');
      const simulated = await withPaperStudy(true);
      await expect(async () => simulated.records.store('paper', 'P01', completed(), now)).rejects.toThrow(
        'is simulated',
      );
    });

    test('knows where each participant is', async () => {
      const store = await withPaperStudy();
      await store.places.claim('paper', 'P02', now);
      await store.records.store('paper', 'P02', completed('P02').slice(0, 1), now);
      await store.places.saveProgress(
        'paper',
        'P02',
        { ...begin(scheduleFor(paperPlan(), 'P02')), step: 'consent' },
        now,
      );
      const [first, second] = await store.overview('paper', now + 20);
      expect(first).toMatchObject({ participant: 'P01', claimed: false, session: null });
      expect(second).toMatchObject({ participant: 'P02', claimed: true, session: { step: 'consent', silence: 20 } });
      expect((await store.places.progress('paper', 'P02'))?.step).toBe('consent');
    });

    test('counts the time of a step by its own clock, independent of the device’s clock', async () => {
      const store = await withPaperStudy();
      await store.places.claim('paper', 'P01', now);
      const one = session(scheduleFor(paperPlan(), 'P01'));
      one.doUntil(({ kind }) => kind === 'rest');
      await store.records.store('paper', 'P01', one.records, now);
      one.wait(20);
      // The device's clock is an hour ahead of the server's.
      await store.places.saveProgress('paper', 'P01', reported(one.progress, one.now), one.now - 3600);
      const [state] = await store.overview('paper', one.now - 3600 + 15);
      expect(state?.session?.remainingSeconds).toBeCloseTo(25, 6);
      expect((await store.places.progress('paper', 'P01', one.now - 3600 + 15))?.elapsed).toBeCloseTo(35, 6);
      expect((await store.places.progress('paper', 'P01'))?.elapsed).toBeCloseTo(20, 6);
    });

    test('hands on commands in order, each once', async () => {
      const store = await withPaperStudy();
      const first = await store.commands.add('paper', 'P01', { type: 'pause' }, now);
      await store.commands.add('paper', 'P02', { type: 'start' }, now);
      await store.commands.add('paper', 'P01', { type: 'resume' }, now);
      expect((await store.commands.after('paper', 'P01', 0)).map(({ command }) => command.type)).toEqual([
        'pause',
        'resume',
      ]);
      expect((await store.commands.after('paper', 'P01', first)).map(({ command }) => command.type)).toEqual([
        'resume',
      ]);
    });
  });

  describe('a place in the study', () => {
    test('belongs to the first device that claims it', async () => {
      const store = await withPaperStudy();
      const { token } = await store.places.claim('paper', 'P01', now);
      await expect(async () => store.places.claim('paper', 'P01', now)).rejects.toThrow('taken by another device');
      expect(await store.places.holds('paper', 'P01', token)).toBe(true);
      expect(await store.places.holds('paper', 'P02', token)).toBe(false);
      expect(await store.places.holds('paper', 'P01', `${token}x`)).toBe(false);
    });

    test('goes to the next device after its release; the withdrawal code stays', async () => {
      const store = await withPaperStudy();
      const first = await store.places.claim('paper', 'P01', now);
      await store.records.store('paper', 'P01', completed(), now);
      await store.places.release('paper', 'P01');
      const second = await store.places.claim('paper', 'P01', now);
      expect(await store.places.holds('paper', 'P01', first.token)).toBe(false);
      expect(await store.places.holds('paper', 'P01', second.token)).toBe(true);
      expect(second.withdrawalCode).toBeNull();
      expect((await store.deletion.withdraw('paper', first.withdrawalCode as string, now))?.participant).toBe('P01');
    });

    test('gives its withdrawal code again while it has no record, as the answer may be lost', async () => {
      const store = await withPaperStudy();
      const lost = (await store.places.claim('paper', 'P01', now)).withdrawalCode as string;
      await store.places.release('paper', 'P01');
      const { withdrawalCode } = await store.places.claim('paper', 'P01', now);
      expect(withdrawalCode).toMatch(/^(\w{4}-){3}\w{4}$/);
      expect(withdrawalCode).not.toBe(lost);
      await store.records.store('paper', 'P01', completed(), now);
      expect(await store.deletion.withdraw('paper', lost, now)).toBeNull();
      expect((await store.deletion.withdraw('paper', withdrawalCode as string, now))?.participant).toBe('P01');
    });
  });

  describe('the deletion of a participant', () => {
    test('concerns one participant alone', async () => {
      const store = await withPaperStudy();
      for (const participant of ['P01', 'P02']) {
        await store.records.store('paper', participant, completed(participant), now);
      }
      await store.deletion.delete('paper', 'P01', 'experimenter', now);
      expect((await store.records.all('paper')).every(({ participant }) => participant === 'P02')).toBe(true);
      expect(await store.records.all('paper')).toHaveLength(completed('P02').length);
    });

    test('leaves all but the recordings where the code is for motion alone', async () => {
      const store = await withPaperStudy();
      const { withdrawalCode } = await store.places.claim('paper', 'P01', now);
      const records = completed('P01', { motion: true });
      await store.records.store('paper', 'P01', records, now);
      await store.motion.store('paper', 'P01', 'archery/1/trial-1@1.1:trial', 'frames', now);
      const withdraw = () => store.deletion.withdrawMotion('paper', withdrawalCode as string, now);
      expect(await withdraw()).toMatchObject({ reason: 'withdrawn', records: 0, motionFiles: 1 });
      expect(await withdraw()).toMatchObject({ records: 0, motionFiles: 0 });
      expect(await store.motion.all('paper')).toEqual([]);
      await expect(async () => store.motion.store('paper', 'P01', 'later', 'frames', now)).rejects.toThrow('motion');
      const stored = await store.records.all('paper', 'P01');
      expect(stored).toHaveLength(records.length + 1);
      expect(stored.at(-1)).toMatchObject({ author: 'participant', body: { type: 'motion-withdrawn' } });
      expect(studyTables(stored, paperPlan())[0]?.rows[0]).toMatchObject({ motion_consent: false });
      const commands = await store.commands.after('paper', 'P01', 0);
      expect(commands.map(({ command }) => command)).toEqual([{ type: 'withdraw-motion' }]);
    });

    test('takes the withdrawal code, however it is typed, and is for good', async () => {
      const store = await withPaperStudy();
      const { withdrawalCode } = await store.places.claim('paper', 'P01', now);
      await store.records.store('paper', 'P01', completed(), now);
      expect(await store.deletion.withdraw('paper', '0000-0000-0000-0000', now)).toBeNull();
      const typed = (withdrawalCode as string).toLowerCase().replaceAll('-', ' ');
      expect(await store.deletion.withdraw('paper', typed, now)).toMatchObject({
        participant: 'P01',
        reason: 'withdrawn',
      });
      await expect(async () => store.places.claim('paper', 'P01', now)).rejects.toThrow('has withdrawn');
      await expect(async () => store.records.store('paper', 'P01', completed(), now)).rejects.toThrow('has withdrawn');
      expect(await store.deletion.withdraw('paper', withdrawalCode as string, now)).toBeNull();
    });

    test('takes o for 0 and l for 1 in a code, since they look alike', () => {
      expect(normalisedCode('o1lI 23ab-cdef-ghjk')).toBe('0111-23AB-CDEF-GHJK');
    });

    test('happens by itself after the retention date, not before', async () => {
      const store = await withPaperStudy();
      await store.places.claim('paper', 'P01', now);
      await store.records.store('paper', 'P01', completed(), now);
      const expired = async (at: number) => store.deletion.deleteExpired(at, (_, error) => expect(error).toBeNull());
      expect(await expired(now + 365 * day)).toEqual([]);
      expect(await expired(now + 365 * day + 1)).toMatchObject([{ participant: 'P01', reason: 'retention' }]);
      expect(await store.records.all('paper')).toEqual([]);
      expect(await expired(now + 366 * day)).toEqual([]);
    });
  });

  describe('the content of an export', () => {
    const software = (version: string) => ({ ...testSoftware.exportedBy, version });

    test('has the records and recordings of the participants who follow a version of the plan', async () => {
      const store = await withPaperStudy();
      await store.places.claim('paper', 'P01', now);
      await store.records.store('paper', 'P01', completed('P01', { motion: true }), now);
      await store.motion.store('paper', 'P01', 'archery/1/trial-1', '{"frames":[]}', now);
      const second = paperPlan({ title: 'The second version' });
      const { version } = await store.plans.add(second, { simulated: false, at: now, newVersion: true });
      const places = await store.overview('paper', now);
      const newcomer = places.find((place) => place.version === version)?.participant ?? '';
      await store.places.claim('paper', newcomer, now);
      await store.records.store('paper', newcomer, completed(newcomer), now);
      const [before, after] = [await store.storedStudy('paper', 1), await store.storedStudy('paper', version)];
      expect(before).toMatchObject({ plan: paperPlan(), planVersion: 1, simulated: false });
      expect(before.records).toEqual(await store.records.all('paper', 'P01'));
      expect(before.motion.map(unpacked)).toEqual([
        { participant: 'P01', trial: 'archery/1/trial-1', text: '{"frames":[]}' },
      ]);
      expect(after).toMatchObject({ plan: second, planVersion: 2, motion: [] });
      expect(after.records).toEqual(await store.records.all('paper', newcomer));
      const { planVersion, ...one } = await store.storedStudy('paper', version, 'P01');
      expect([one.plan, one.records, planVersion]).toEqual([before.plan, before.records, undefined]);
    });

    test('has no number while the plan has one version, and refuses an unknown study', async () => {
      const store = await withPaperStudy(true);
      const { planVersion, simulated } = await store.storedStudy('paper', 1);
      expect([planVersion, simulated]).toEqual([undefined, true]);
      await expect(async () => store.storedStudy('tea', 1)).rejects.toThrow('there is no study "tea"');
    });

    test('names the software that has served the study since its creation, each version once', async () => {
      const store = open();
      await store.software.note(software('1.0.0'), now - 20);
      await store.software.note(software('1.1.0'), now - 10);
      await store.software.note(software('1.1.0'), now - 5);
      await store.plans.add(paperPlan(), { simulated: false, at: now });
      await store.software.note(software('1.2.0'), now + 10);
      const { served } = await store.storedStudy('paper', 1);
      expect(served).toEqual([
        { since: now - 10, ...software('1.1.0') },
        { since: now + 10, ...software('1.2.0') },
      ]);
    });
  });

  describe('tracked frames', () => {
    test('are kept with consent to them alone', async () => {
      const store = await withPaperStudy();
      await store.records.store('paper', 'P01', completed('P01'), now);
      await expect(async () => store.motion.store('paper', 'P01', 'archery/1/trial-1', '{}', now)).rejects.toThrow(
        'motion recording',
      );
      await store.records.store('paper', 'P02', completed('P02', { motion: true }), now);
      await store.motion.store('paper', 'P02', 'archery/1/trial-1', '{"frames":[]}', now);
      expect((await store.motion.all('paper')).map(unpacked)).toEqual([
        { participant: 'P02', trial: 'archery/1/trial-1', text: '{"frames":[]}' },
      ]);
      expect((await store.deletion.delete('paper', 'P02', 'experimenter', now)).motionFiles).toBe(1);
      expect(await store.motion.all('paper')).toEqual([]);
    });

    test('are not kept in a study that does not ask for them', async () => {
      const store = open();
      await store.plans.add(paperPlan({ consent: { ...paperPlan().consent, motion: null } }), {
        simulated: false,
        at: now,
      });
      await store.records.store('paper', 'P01', completed('P01', { motion: true }), now);
      await expect(async () => store.motion.store('paper', 'P01', 'archery/1/trial-1', '{}', now)).rejects.toThrow(
        'motion recording',
      );
    });
  });
});
