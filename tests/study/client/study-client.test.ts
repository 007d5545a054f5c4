import { expect, test } from 'vitest';
import { requestTimeoutMs } from '../../../src/http/web-server';
import {
  createParticipantClient,
  motionTimeoutMs,
  NoStudyServer,
  ServerRefusal,
  ServerUnreachable,
} from '../../../src/study/client/study-client';
import { answeringHost, says } from '../../rooms/client/answering-host';

const clientOf = async (status: number, body: string) =>
  createParticipantClient((await answeringHost(says(status, body))).folder);

test('a host of files is distinguished from a server without the study', async () => {
  const files = await clientOf(404, '<h1>Not found</h1>');
  await expect(files.study({ study: 'paper', participant: 'P01' })).rejects.toThrow(NoStudyServer);
  await expect(files.study({ study: 'paper', participant: 'P01' })).rejects.toThrow(
    'this page comes from a host without one',
  );
  const server = await clientOf(404, '{"error":"there is no study \\"paper\\"","field":null}');
  await expect(server.study({ study: 'paper', participant: 'P01' })).rejects.toThrow(ServerRefusal);
  await expect(server.study({ study: 'paper', participant: 'P01' })).rejects.not.toThrow(NoStudyServer);
});

test('a server that is away for now is unreachable, with a proxy’s page as with our own sentence', async () => {
  for (const body of ['<h1>Bad gateway</h1>', '{"error":"starting"}']) {
    await expect((await clientOf(502, body)).study({ study: 'paper', participant: 'P01' })).rejects.toThrow(
      ServerUnreachable,
    );
  }
});

test('a recording may be on its way for as long as the server lets a request arrive', () => {
  expect(motionTimeoutMs).toBe(requestTimeoutMs);
});
