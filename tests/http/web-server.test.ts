import { once } from 'node:events';
import { createServer } from 'node:http';
import { type AddressInfo, connect } from 'node:net';
import { describe, expect, onTestFinished, test } from 'vitest';
import { createSitePolicy } from '../../src/http/site-policy';
import { hasLoopbackNetwork } from '../platform';
import { ask } from '../server/running-server';
import { forkServer } from '../server/server-child';
import { testCredentials } from '../server/test-credentials';
import { serve } from './serve';

const hello = (_: unknown, response: { end: (text: string) => void }) => response.end('hello');

async function taken(): Promise<number> {
  const other = createServer();
  await new Promise<void>((resolve) => other.listen(0, '127.0.0.1', resolve));
  onTestFinished(() => new Promise<void>((resolve) => other.close(() => resolve())));
  return (other.address() as AddressInfo).port;
}

describe('the port', () => {
  test('when it is taken, the next free one is used', async () => {
    const port = await taken();
    const server = await serve(hello, { port });
    onTestFinished(() => server.close());
    expect(server.port).toBeGreaterThan(port);
    expect((await ask(`http://127.0.0.1:${server.port}`, '/')).body.toString()).toBe('hello');
  });

  test('a server that finds none free says so, and its process ends', async () => {
    const other = createServer().listen(65_535, '127.0.0.1');
    // A port that another program has is taken as well.
    await Promise.race([once(other, 'listening'), once(other, 'error')]);
    onTestFinished(() => void other.close());
    await expect(forkServer({}, { port: 65_535 })).rejects.toThrow(/ended with 1: .*are in use\. Choose another/);
  });

  test('is free again once the server has closed, even with a connection open', async () => {
    const server = await serve(hello);
    const client = connect(server.port, '127.0.0.1');
    await new Promise((resolve) => client.once('connect', resolve));
    const ended = new Promise((resolve) => client.once('close', resolve));
    client.on('error', () => client.destroy());
    await server.close();
    await ended;
    const next = await serve(hello, { host: '127.0.0.1', port: server.port });
    onTestFinished(() => next.close());
    expect(next.port).toBe(server.port);
  });
});

describe('an exception', () => {
  const fail = () => {
    throw new Error('a fault of this test');
  };
  const offer = { connection: 'Upgrade', upgrade: 'h2c' };

  test('in the listener of requests gets 500 and a log entry, and the server goes on', async () => {
    const faults: unknown[] = [];
    const server = await serve(fail, { onError: (error) => faults.push(error) });
    onTestFinished(() => server.close());
    for (const headers of [{}, offer]) {
      const { status, body } = await ask(`http://127.0.0.1:${server.port}`, '/', { headers });
      expect(status).toBe(500);
      expect(JSON.parse(body.toString())).toEqual({ error: expect.stringMatching(/^the server failed/), field: null });
    }
    expect(faults).toEqual([new Error('a fault of this test'), new Error('a fault of this test')]);
  });

  test('in the listener of upgrades closes the connection, is logged, and leaves the server running', async () => {
    const faults: unknown[] = [];
    const onError = (error: unknown) => faults.push(error);
    const server = await serve(hello, { upgrade: fail, onError });
    onTestFinished(() => server.close());
    await expect(ask(`http://127.0.0.1:${server.port}`, '/', { headers: offer })).rejects.toThrow(/socket hang up/);
    expect((await ask(`http://127.0.0.1:${server.port}`, '/')).body.toString()).toBe('hello');
    expect(faults).toEqual([new Error('a fault of this test')]);
  });
});

describe('HTTPS with a certificate of our own', () => {
  async function secured() {
    const credentials = await testCredentials(['127.0.0.2']);
    const { checkHost } = createSitePolicy({ origins: [], hosts: [], trustProxy: false });
    const server = await serve(hello, { host: '0.0.0.0', port: 0, credentials, checkHost });
    onTestFinished(() => server.close());
    return { server, credentials };
  }

  test.skipIf(!hasLoopbackNetwork)('a client that trusts it connects under every address it names', async () => {
    const { server, credentials } = await secured();
    for (const host of ['localhost', '127.0.0.1', '127.0.0.2']) {
      const { status, body } = await ask(`https://${host}:${server.port}`, '/', { ca: credentials.cert });
      expect(status).toBe(200);
      expect(body.toString()).toBe('hello');
    }
  });

  test.skipIf(!hasLoopbackNetwork)(
    'a client that does not trust it, or comes under another address, is warned',
    async () => {
      const { server, credentials } = await secured();
      await expect(ask(`https://127.0.0.1:${server.port}`, '/')).rejects.toThrow(/self-signed/);
      await expect(ask(`https://127.0.0.3:${server.port}`, '/', { ca: credentials.cert })).rejects.toThrow(
        /127\.0\.0\.3/,
      );
    },
  );

  test('plain HTTP on the same port is sent to HTTPS, path and all', async () => {
    const { server } = await secured();
    const { status, headers } = await ask(`http://127.0.0.1:${server.port}`, '/?estimator=ik');
    expect(status).toBe(308);
    expect(headers.location).toBe(`https://127.0.0.1:${server.port}/?estimator=ik`);
  });

  test('plain HTTP under a name of another site is refused, not redirected', async () => {
    const { server } = await secured();
    const asked = { headers: { host: 'evil.example' } };
    const { status, headers, body } = await ask(`http://127.0.0.1:${server.port}`, '/', asked);
    expect(status).toBe(421);
    expect(headers.location).toBeUndefined();
    expect(body.toString()).toContain('does not accept the name evil.example');
  });
});
