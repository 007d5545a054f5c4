import { mkdtempSync, rmSync } from 'node:fs';
import { createServer } from 'node:https';
import type { AddressInfo } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { certificateFor } from '../server/certificate';

/**
 * Serves one avatar under this name, from another origin than the page's, to all origins; `asked` lists the requests.
 */
export async function serveCrossOrigin(file: ArrayBuffer, name: string) {
  const folder = mkdtempSync(join(tmpdir(), 'threepoint-elsewhere-'));
  const asked: string[] = [];
  const server = createServer(await certificateFor([], folder, new Date()), ({ method, url, headers }, response) => {
    asked.push(`${method} ${url}${headers.authorization ?? ''}`);
    const found = url === `/avatars/${name}`;
    response.writeHead(found ? 200 : 404, { 'access-control-allow-origin': '*', 'content-type': 'model/gltf-binary' });
    response.end(found && method === 'GET' ? Buffer.from(file) : undefined);
  });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  const origin = `https://127.0.0.1:${(server.address() as AddressInfo).port}`;
  return {
    origin,
    folder: `${origin}/avatars/`,
    asked,
    async close() {
      server.closeAllConnections();
      await new Promise((resolve) => server.close(resolve));
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
