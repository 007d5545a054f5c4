import { X509Certificate } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { hostname, type NetworkInterfaceInfo, networkInterfaces } from 'node:os';
import { join } from 'node:path';
import { generate } from 'selfsigned';
import type { Credentials } from 'threepoint-http';

const day = 24 * 3600 * 1000;

/** Returns the IPv4 addresses at which other devices on the network reach this machine. */
export function lanAddresses(interfaces: NodeJS.Dict<NetworkInterfaceInfo[]> = networkInterfaces()): string[] {
  return Object.values(interfaces)
    .flatMap((addresses) => addresses ?? [])
    .filter(({ family, internal, address }) => family === 'IPv4' && !internal && !address.startsWith('169.254.'))
    .map(({ address }) => address);
}

function stillServes(cert: string, addresses: readonly string[], now: Date): boolean {
  const certificate = new X509Certificate(cert);
  return (
    new Date(certificate.validTo).getTime() - now.getTime() > 7 * day &&
    addresses.every((address) => certificate.checkIP(address) !== undefined)
  );
}

/**
 * Returns a self-signed certificate for these IPv4 addresses, localhost and this machine's name. It is stored in the
 * directory, so that a headset has to trust it only once. It is replaced when an address is new or when it expires
 * within a week.
 */
export async function certificateFor(addresses: readonly string[], directory: string, now: Date): Promise<Credentials> {
  const keyFile = join(directory, 'lan.key.pem');
  const certFile = join(directory, 'lan.cert.pem');
  const wanted = ['127.0.0.1', ...addresses];
  if (existsSync(keyFile) && existsSync(certFile)) {
    const cert = readFileSync(certFile, 'utf8');
    if (stillServes(cert, wanted, now)) return { key: readFileSync(keyFile, 'utf8'), cert };
  }
  const names = [...new Set(['localhost', hostname(), `${hostname()}.local`])];
  const pems = await generate([{ name: 'commonName', value: 'threepoint on this network' }], {
    keyType: 'ec',
    curve: 'P-256',
    algorithm: 'sha256',
    notBeforeDate: new Date(now.getTime() - day),
    // Browsers refuse certificates that are valid for longer than 398 days.
    notAfterDate: new Date(now.getTime() + 390 * day),
    extensions: [
      { name: 'basicConstraints', cA: false },
      { name: 'keyUsage', digitalSignature: true },
      { name: 'extKeyUsage', serverAuth: true },
      {
        name: 'subjectAltName',
        altNames: [
          ...names.map((value) => ({ type: 2 as const, value })),
          ...wanted.map((ip) => ({ type: 7 as const, ip })),
        ],
      },
    ],
  });
  mkdirSync(directory, { recursive: true });
  writeFileSync(keyFile, pems.private, { mode: 0o600 });
  writeFileSync(certFile, pems.cert);
  return { key: pems.private, cert: pems.cert };
}
