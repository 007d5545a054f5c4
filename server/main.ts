import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { certificateFor } from './certificate';
import { ConfigurationError, configurationFrom, usage } from './configuration';
import { lanAddresses } from './lan-addresses';
import { createPageHandler } from './page';
import { createRelay, type Relay, secretIn } from './relay';
import { relayConfigurationFrom, relayEnvironment } from './relay-configuration';
import { openStudyService } from './study-service';
import { serve } from './web-server';
import { welcome } from './welcome';

const pathInRepository = (path: string) => fileURLToPath(new URL(`../${path}`, import.meta.url));

async function main(): Promise<void> {
  const configuration = configurationFrom(process.argv.slice(2), process.env);
  if (configuration === 'help') {
    console.log(`${usage}\n\n${relayEnvironment}`);
    return;
  }
  const relaying = relayConfigurationFrom(process.env);
  const addresses = configuration.lan ? lanAddresses() : null;
  const page = createPageHandler(pathInRepository('dist'));
  const { studyDirectory } = configuration;
  const studies = openStudyService({
    directory: studyDirectory
      ? resolve(process.env.INIT_CWD ?? process.cwd(), studyDirectory)
      : pathInRepository('study-data'),
    token: configuration.experimenterToken,
    now: () => Date.now() / 1000,
    log: (line) => console.error(line),
  });
  let relay: Relay | null = null;
  const server = await serve(
    (request, response) => {
      if (!relay?.handle(request, response) && !studies.handle(request, response)) page(request, response);
    },
    {
      host: relaying.host ?? (addresses ? '0.0.0.0' : '127.0.0.1'),
      port: configuration.port,
      ...(addresses && { credentials: await certificateFor(addresses, pathInRepository('.cache'), new Date()) }),
    },
  );
  relay = createRelay(server.requests, relaying, relaying.secret ?? secretIn(pathInRepository('.cache/relay-secret')));
  console.log(
    welcome({ port: server.port, requestedPort: configuration.port, addresses, tokenFile: studies.tokenFile }),
  );
  for (const signal of ['SIGINT', 'SIGTERM'] as const) {
    process.once(signal, () => {
      console.log('Stopping.');
      void Promise.resolve(relay?.close())
        .then(() => server.close())
        .then(() => studies.close());
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
