import { createServer } from 'node:https';
import type { AddressInfo } from 'node:net';
import { testCredentials } from '../tests/server/test-credentials';

/**
 * Serves one avatar under this name, from another origin than the page's, to all origins; `asked` lists the requests.
 */
export async function serveCrossOrigin(file: ArrayBuffer, name: string) {
  const asked: string[] = [];
  const server = createServer(await testCredentials(), ({ method, url, headers }, response) => {
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
    },
  };
}
