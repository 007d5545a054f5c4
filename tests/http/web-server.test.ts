import { fork } from 'node:child_process';
import { X509Certificate } from 'node:crypto';
import { statSync } from 'node:fs';
import { createServer } from 'node:http';
import { type AddressInfo, connect } from 'node:net';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, onTestFinished, test } from 'vitest';
import { certificateFor } from '../../server/certificate';
import { lanAddresses } from '../../server/lan-addresses';
import { serve } from '../../src/http/web-server';
import { hasFileModes, hasLoopbackNetwork } from '../platform';
import { until } from '../rooms/server/running-relay';
import { isAlive, kill } from '../server/child-process';
import { ask } from '../server/running-server';
import { directoryWith } from '../temporary-directory';

const now = new Date();
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
    const server = await serve(hello, { host: '127.0.0.1', port });
    onTestFinished(() => server.close());
    expect(server.port).toBeGreaterThan(port);
    expect((await ask(`http://127.0.0.1:${server.port}`, '/')).body.toString()).toBe('hello');
  });

  test('where none is free, the server says so and its process ends', async () => {
    const script = fileURLToPath(new URL('../server/unserved-process.ts', import.meta.url));
    const child = fork(script, [directoryWith()], { execArgv: ['--import', 'tsx'], stdio: 'pipe' });
    onTestFinished(() => kill(child));
    let said = '';
    child.stderr?.on('data', (text: Buffer) => {
      said += text;
    });
    await until('the end of the process', () => !isAlive(child), 30);
    expect(child.exitCode).toBe(1);
    expect(said).toContain('are in use. Choose another');
  });

  test('is free again once the server has closed, even with a connection open', async () => {
    const server = await serve(hello, { host: '127.0.0.1', port: 0 });
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

describe('HTTPS with a certificate of our own', () => {
  async function secured() {
    const directory = directoryWith();
    const credentials = await certificateFor(['127.0.0.2'], directory, now);
    const server = await serve(hello, { host: '0.0.0.0', port: 0, credentials });
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
});

describe('the certificate', () => {
  test('names every address and this machine, for about a year', async () => {
    const { cert } = await certificateFor(['192.168.7.20', '10.1.2.3'], directoryWith(), now);
    const certificate = new X509Certificate(cert);
    for (const address of ['127.0.0.1', '192.168.7.20', '10.1.2.3']) expect(certificate.checkIP(address)).toBe(address);
    expect(certificate.checkHost('localhost')).toBe('localhost');
    const days = (new Date(certificate.validTo).getTime() - now.getTime()) / 86_400_000;
    expect(days).toBeGreaterThan(300);
    expect(days).toBeLessThan(398);
  });

  test('is kept while it serves, so that no browser warns twice', async () => {
    const directory = directoryWith();
    const first = await certificateFor(['192.168.7.20', '10.1.2.3'], directory, now);
    expect(await certificateFor(['192.168.7.20'], directory, now)).toEqual(first);
  });

  test('is made anew for a new address and before it expires', async () => {
    const directory = directoryWith();
    const first = await certificateFor(['192.168.7.20'], directory, now);
    const moved = await certificateFor(['192.168.8.4'], directory, now);
    expect(moved.cert).not.toBe(first.cert);
    const later = new Date(now.getTime() + 385 * 86_400_000);
    expect((await certificateFor(['192.168.8.4'], directory, later)).cert).not.toBe(moved.cert);
  });

  test.skipIf(!hasFileModes)('leaves a key that only its owner reads', async () => {
    const directory = directoryWith();
    await certificateFor([], directory, now);
    expect(statSync(join(directory, 'lan.key.pem')).mode & 0o077).toBe(0);
  });
});

test('addresses of the network are those another device can use', () => {
  const address = (value: string, family: 'IPv4' | 'IPv6', internal = false) =>
    ({ address: value, family, internal, netmask: '', mac: '', cidr: null, scopeid: 0 }) as never;
  expect(
    lanAddresses({
      lo: [address('127.0.0.1', 'IPv4', true)],
      wlan0: [address('192.168.7.20', 'IPv4'), address('fe80::1', 'IPv6')],
      usb0: [address('169.254.3.4', 'IPv4')],
    }),
  ).toEqual(['192.168.7.20']);
});
