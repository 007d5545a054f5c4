import { randomBytes } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { ConfigurationError } from 'threepoint-http';
import { relayConfigurationFrom, relayEnvironment } from 'threepoint-relay';
import { certificateFor, lanAddresses } from './certificate';
import { configurationFrom, usage } from './configuration';
import { shippedRoomKinds } from './room-kinds';
import { startServer } from './start-server';
import { startupMessage } from './startup-message';

const pathInRepository = (path: string) => fileURLToPath(new URL(`../${path}`, import.meta.url));

/** Returns the secret in a file, and creates it if needed, so that tokens stay valid after a restart. */
function loadOrCreateSecret(path: string): string {
  if (existsSync(path)) {
    const kept = readFileSync(path, 'utf8').trim();
    if (kept.length >= 32) return kept;
  }
  const secret = randomBytes(32).toString('base64url');
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, `${secret}\n`, { mode: 0o600 });
  return secret;
}

async function main(): Promise<void> {
  const configuration = configurationFrom(process.argv.slice(2), process.env);
  if (configuration === 'help') {
    console.log(`${usage}\n\n${relayEnvironment}`);
    return;
  }
  const relay = relayConfigurationFrom(process.env);
  const addresses = configuration.lan ? lanAddresses() : null;
  const { studyDirectory, experimenterToken } = configuration;
  const server = await startServer({
    pageDirectory: pathInRepository('dist'),
    studyDirectory: studyDirectory
      ? resolve(process.env.INIT_CWD ?? process.cwd(), studyDirectory)
      : pathInRepository('study-data'),
    experimenterToken,
    relay,
    games: await shippedRoomKinds(process.env),
    secret: relay.secret ?? loadOrCreateSecret(pathInRepository('.cache/relay-secret')),
    host: relay.host ?? (addresses ? '0.0.0.0' : '127.0.0.1'),
    port: configuration.port,
    ...(addresses && { credentials: await certificateFor(addresses, pathInRepository('.cache'), new Date()) }),
    log: (line) => console.error(line),
  });
  const { port, tokenFile } = server;
  console.log(startupMessage({ port, requestedPort: configuration.port, addresses, tokenFile }));
  for (const signal of ['SIGINT', 'SIGTERM'] as const) {
    process.once(signal, () => {
      console.log('Stopping.');
      void server.close();
    });
  }
}

try {
  await main();
} catch (error) {
  if (!(error instanceof ConfigurationError)) throw error;
  console.error(error.message);
  process.exitCode = 1;
}
