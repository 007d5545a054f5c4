import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Credentials } from 'threepoint-http';
import { certificateFor } from '../../server/certificate';

/** Returns a certificate for loopback and these addresses, as `npm start -- --lan` makes it. */
export async function testCredentials(addresses: readonly string[] = []): Promise<Credentials> {
  const folder = mkdtempSync(join(tmpdir(), 'threepoint-certificate-'));
  try {
    return await certificateFor(addresses, folder, new Date());
  } finally {
    rmSync(folder, { recursive: true });
  }
}
