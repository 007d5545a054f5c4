import { afterEach, expect, test, vi } from 'vitest';
import { createParticipantClient } from '../../../src/study/client/study-client';
import { ParticipantSession, startSession } from '../../../src/study/participant/session/participant-session';
import { calibration, device, fillDevice, toTheFirstQuestion, toTheFirstRest } from './participant-device';
import { place, studyServer } from './study-server';

afterEach(() => vi.restoreAllMocks());

test('an acknowledged record leaves the device, and no other does', async () => {
  const server = await studyServer();
  const { store } = server;
  const { first, vault } = await device(server);
  toTheFirstQuestion(first);
  await first.settled();
  const kinds = ['consent', 'demographics', 'calibration', 'trial', 'trial'];
  expect((await vault.records(place)).map(({ kind }) => kind)).toEqual(kinds);
  expect(store.records.all('paper')).toEqual([]);
  await first.exchange();
  expect(store.records.all('paper').map(({ kind }) => kind)).toEqual(kinds);
  expect(await vault.records(place)).toEqual([]);
  expect(first.uploadStatus).toEqual({
    unsent: 0,
    unsaved: 0,
    storageFault: null,
    online: true,
    rejection: null,
    lockedOut: false,
  });
  expect(store.places.progress('paper', 'P01')?.step).toBe(first.step.id);
});

test('a reload in a questionnaire without network resumes the same question, and all is sent later', async () => {
  const server = await studyServer();
  const { first, reload } = await device(server);
  await server.stop();
  toTheFirstQuestion(first);
  first.apply({ type: 'answer', question: 'Q1', value: 4 });
  first.apply({ type: 'answer', question: 'Q2', value: 5 });
  await first.exchange();
  expect(first.uploadStatus.online).toBe(false);
  expect(first.uploadStatus.unsent).toBe(5);

  const second = await reload();
  expect(second.step.id).toBe(first.step.id);
  expect(second.progress.draft).toEqual({ Q1: 4, Q2: 5 });
  expect(second.kept.calibration).toEqual(calibration);
  for (const question of ['Q3', 'Q4', 'Q5', 'Q6', 'Q7']) second.apply({ type: 'answer', question, value: 3 });
  expect(second.apply({ type: 'submit' })).toBe(null);
  await second.exchange();
  expect(second.uploadStatus.online).toBe(false);

  await server.restart();
  const third = await reload();
  await third.exchange();
  expect(third.uploadStatus).toMatchObject({ unsent: 0, online: true, rejection: null });
  expect(server.bodies('answers')[0]).toMatchObject({ answers: { Q1: 4, Q2: 5, Q3: 3, Q4: 3, Q5: 3, Q6: 3, Q7: 3 } });
});

test('a full device says so, keeps the answers in the page, and stores them later', async () => {
  const server = await studyServer();
  const { first, vault } = await device(server);
  await first.settled();
  await server.stop();
  const makeRoom = fillDevice();
  toTheFirstQuestion(first);
  await first.exchange();
  expect(first.uploadStatus).toMatchObject({
    unsent: 5,
    unsaved: 5,
    storageFault: 'the quota is used up',
    online: false,
  });
  makeRoom();
  await first.exchange();
  expect(first.uploadStatus).toMatchObject({ unsent: 5, unsaved: 0, storageFault: null });
  expect(await vault.records(place)).toHaveLength(5);
  await server.restart();
  await first.exchange();
  expect(server.store.records.all('paper')).toHaveLength(5);
});

test('a full device with a network loses nothing either', async () => {
  const server = await studyServer();
  const { first } = await device(server);
  fillDevice();
  toTheFirstQuestion(first);
  await first.exchange();
  expect(server.store.records.all('paper')).toHaveLength(5);
  expect(first.uploadStatus).toMatchObject({ unsent: 0, unsaved: 0 });
});

test('a browser without storage sends everything all the same', async () => {
  const server = await studyServer();
  const { store } = server;
  const { claim, options } = await device(server);
  const session = new ParticipantSession(startSession(claim, place), { records: [], motion: [] }, options(null));
  toTheFirstQuestion(session);
  expect(session.uploadStatus).toMatchObject({ unsaved: 5, storageFault: 'this browser offers no storage' });
  await session.exchange();
  expect(store.records.all('paper')).toHaveLength(5);
});

test('the experimenter’s commands are followed once, also across a reload; one out of place is remarked', async () => {
  const server = await studyServer();
  const { store } = server;
  const { first, reload } = await device(server);
  toTheFirstQuestion(first);
  const { experimenter } = server;
  await experimenter.command('paper', 'P01', { type: 'pause' });
  await first.exchange();
  expect(first.progress.paused).toBe(true);
  expect(store.overview('paper', 1e9)[0]?.session?.paused).toBe(true);
  first.apply({ type: 'resume' });
  await first.settled();

  const second = await reload();
  await second.exchange();
  expect(second.progress.paused).toBe(false);
  await experimenter.command('paper', 'P01', { type: 'start' });
  await experimenter.command('paper', 'P01', { type: 'void-block', reason: 'the phone rang', repeat: true });
  await second.exchange();
  expect(second.step.id).toBe('archery/1/calibration');
  const said = server.bodies('event');
  expect(said).toContainEqual(expect.objectContaining({ type: 'remark', text: expect.stringContaining('"start"') }));
  expect(said).toContainEqual(expect.objectContaining({ type: 'void-block', reason: 'the phone rang' }));
});

test('a device that takes over follows no command that another one has followed', async () => {
  const server = await studyServer();
  const { experimenter } = server;
  const { first } = await device(server);
  toTheFirstQuestion(first);
  await experimenter.command('paper', 'P01', { type: 'void-block', reason: 'the phone rang', repeat: true });
  await first.exchange();
  expect(first.step.id).toBe('archery/1/calibration');
  expect(first.apply({ type: 'calibrated', calibration })).toBeNull();
  await first.exchange();
  await experimenter.release('paper', 'P01');
  const { first: second } = await device(server);
  second.apply({ type: 'reload' });
  expect(second.step.id).toBe('archery/1/trial-1');
  await second.exchange();
  expect(second.step.id).toBe('archery/1/trial-1');
  expect(server.events().filter((type) => type === 'void-block')).toHaveLength(1);
  await experimenter.command('paper', 'P01', { type: 'pause' });
  await second.exchange();
  expect(second.progress.paused).toBe(true);
});

test.each([-600, 600])('a rest lasts as long on a second device whose clock is %d s ahead', async (ahead) => {
  const server = await studyServer();
  const { first } = await device(server);
  toTheFirstRest(first);
  await first.exchange();
  await server.experimenter.release('paper', 'P01');
  const { first: second } = await device(server, { clock: 1e9 + ahead });
  second.apply({ type: 'reload' });
  expect(second.step.kind).toBe('rest');
  expect(second.remaining()).toBeGreaterThan(50);
  expect(second.remaining()).toBeLessThan(60);
});

test('a record that the server refuses is reported and kept, and does not block others', async () => {
  const server = await studyServer();
  const { store } = server;
  const { first, vault } = await device(server);
  toTheFirstQuestion(first);
  await first.exchange();
  const [stored] = store.records.all('paper').filter(({ kind }) => kind === 'demographics');
  if (!stored) throw new Error('there are no demographics');
  // Another story under an id that is taken, as after a device was set back to an old backup.
  await vault.save((await vault.session(place)) as never, [{ ...stored, at: stored.at + 5 }]);
  const kept = await vault.session(place);
  const again = new ParticipantSession(
    kept as NonNullable<typeof kept>,
    { records: await vault.records(place), motion: [] },
    { client: createParticipantClient(server.origin), vault, now: () => 2e9, onChange: () => undefined },
  );
  for (const question of ['Q1', 'Q2', 'Q3', 'Q4', 'Q5', 'Q6', 'Q7'])
    again.apply({ type: 'answer', question, value: 2 });
  again.apply({ type: 'submit' });
  await again.exchange();
  expect(server.bodies('answers')).toHaveLength(1);
  expect(again.uploadStatus).toMatchObject({
    unsent: 1,
    online: true,
    rejection: expect.stringContaining('something else'),
  });
});
