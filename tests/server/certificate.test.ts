import { X509Certificate } from 'node:crypto';
import { statSync } from 'node:fs';
import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { certificateFor, lanAddresses } from '../../server/certificate';
import { hasFileModes } from '../platform';
import { directoryWith } from '../temporary-directory';

const now = new Date();

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

  test('is renewed for a new address and before it expires', async () => {
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
