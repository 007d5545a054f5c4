import { request as httpRequest } from 'node:http';
import { expect, test } from 'vitest';
import { unpacked } from '../../../src/study/server/study-storage';
import { answeringHost } from '../../rooms/client/answering-host';
import { shortRecording } from '../model/studies';
import { device, toTheFirstQuestion } from './participant-device';
import { place, type StudyServer, studyServer } from './study-server';

test('tracked frames reach the server with consent to them, and leave the device then', async () => {
  const server = await studyServer();
  const { store } = server;
  const { first, vault } = await device(server);
  toTheFirstQuestion(first, true);
  first.keepMotion('archery/1/trial-1@1.1:trial', shortRecording);
  await first.settled();
  expect(await vault.motion(place)).toHaveLength(1);
  await first.exchange();
  await first.motionSent();
  expect(store.motion.all('paper').map(unpacked)).toEqual([
    { participant: 'P01', trial: 'archery/1/trial-1@1.1:trial', text: shortRecording },
  ]);
  expect(await vault.motion(place)).toEqual([]);
});

test('a recording that the server refuses is reported and kept, and blocks nothing else', async () => {
  const server = await studyServer();
  const { store, experimenter } = server;
  const { first, vault } = await device(server);
  toTheFirstQuestion(first, true);
  first.keepMotion('archery/1/trial-1@1.1:trial', 'no recording');
  first.keepMotion('archery/2/trial-1@1.1:trial', shortRecording);
  await first.exchange();
  await first.motionSent();
  expect(store.places.progress('paper', 'P01')?.step).toBe(first.step.id);
  expect(store.motion.all('paper').map(({ trial }) => trial)).toEqual(['archery/2/trial-1@1.1:trial']);
  expect(await vault.motion(place)).toHaveLength(1);
  await experimenter.command('paper', 'P01', { type: 'pause' });
  await first.exchange();
  expect(first.progress.paused).toBe(true);
  expect(first.uploadStatus).toMatchObject({
    unsent: 1,
    online: true,
    rejection: expect.stringContaining('not valid JSON'),
    lockedOut: false,
  });
});

test('a withdrawn consent to motion reaches the page, which drops what it has not sent', async () => {
  const server = await studyServer();
  const { store } = server;
  const { first, vault } = await device(server);
  toTheFirstQuestion(first, true);
  await first.exchange();
  first.keepMotion('archery/1/trial-1@1.1:trial', 'no recording');
  await first.settled();
  const code = first.kept.withdrawalCode as string;
  expect(store.deletion.withdrawMotion('paper', code, 1e9)).toMatchObject({ reason: 'withdrawn', records: 0 });
  await first.exchange();
  await first.motionSent();
  await first.exchange();
  expect(first.progress.motion).toBe(false);
  expect(first.uploadStatus).toMatchObject({ unsent: 0, lockedOut: false });
  expect(await vault.motion(place)).toEqual([]);
  expect(server.events()).toContain('motion-withdrawn');
});

/** A way to the server on which recordings stop before they arrive, how often is counted. */
async function wayWithoutMotion({ origin }: StudyServer) {
  const stopped = { count: 0 };
  const { server } = await answeringHost((request, response) => {
    if (request.url?.includes('/motion?')) {
      stopped.count += 1;
      return;
    }
    const { method = 'GET', headers } = request;
    const onward = httpRequest(`${origin}${request.url}`, { method, headers }, (answer) => {
      answer.pipe(response.writeHead(answer.statusCode ?? 0, answer.headers));
    });
    request.pipe(onward);
  });
  const address = server.address() as { readonly port: number };
  return { origin: `http://127.0.0.1:${address.port}`, stopped };
}

test('while a recording is on its way, progress is reported and commands are followed', async () => {
  const server = await studyServer();
  const { store, experimenter } = server;
  const way = await wayWithoutMotion(server);
  const { first } = await device({ ...way, invitation: server.invitation });
  toTheFirstQuestion(first, true);
  first.keepMotion('archery/1/trial-1@1.1:trial', shortRecording);
  await first.exchange();
  expect(store.places.progress('paper', 'P01')?.step).toBe(first.step.id);
  await experimenter.command('paper', 'P01', { type: 'pause' });
  await first.exchange();
  expect(first.progress.paused).toBe(true);
  expect(way.stopped.count).toBe(1);
  expect(first.uploadStatus).toMatchObject({ unsent: 1, online: true, rejection: null });
});
