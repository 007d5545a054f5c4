import { noPage, prepareServer } from 'threepoint-http';
import { expect, test } from 'vitest';
import { createParticipantClient, motionTimeoutMs, ServerUnreachable } from '../../../src/study/client/study-client';
import { answeringHost, says } from '../../rooms/client/answering-host';

const clientOf = async (status: number, body: string) =>
  createParticipantClient((await answeringHost(says(status, body))).folder);

test('a host of files is distinguished from a server without the study', async () => {
  const files = await clientOf(404, '<h1>Not found</h1>');
  await expect(files.study({ study: 'paper', participant: 'P01' })).rejects.toMatchObject({ reason: 'elsewhere' });
  await expect(files.study({ study: 'paper', participant: 'P01' })).rejects.toThrow(
    'this page comes from a host without one',
  );
  const server = await clientOf(404, '{"error":"there is no study \\"paper\\"","field":null}');
  await expect(server.study({ study: 'paper', participant: 'P01' })).rejects.toMatchObject({ reason: 'unknown' });
});

test('a server that is away is unreachable, behind a proxy’s page or our own sentence', async () => {
  for (const body of ['<h1>Bad gateway</h1>', '{"error":"starting"}']) {
    await expect((await clientOf(502, body)).study({ study: 'paper', participant: 'P01' })).rejects.toThrow(
      ServerUnreachable,
    );
  }
});

test('a recording may travel for as long as the server lets a request arrive', () => {
  expect(motionTimeoutMs).toBe(prepareServer(noPage, {}).http.requestTimeout);
});
