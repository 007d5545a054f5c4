import type { IncomingMessage, ServerResponse } from 'node:http';
import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { certificateFor } from './certificate';
import { ConfigurationError, configurationFrom, usage } from './configuration';
import { lanAddresses } from './lan-addresses';
import { createPageHandler } from './page';
import { openStudyService } from './study-service';
import { serve } from './web-server';
import { welcome } from './welcome';

const pathInRepository = (path: string) => fileURLToPath(new URL(`../${path}`, import.meta.url));

async function main(): Promise<void> {
  const configuration = configurationFrom(process.argv.slice(2), process.env);
  if (configuration === 'help') {
    console.log(usage);
    return;
  }
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
  const answer = (request: IncomingMessage, response: ServerResponse) => {
    if (!studies.handle(request, response)) page(request, response);
  };
  const server = await serve(answer, {
    host: addresses ? '0.0.0.0' : '127.0.0.1',
    port: configuration.port,
    ...(addresses && { credentials: await certificateFor(addresses, pathInRepository('.cache'), new Date()) }),
  });
  console.log(
    welcome({ port: server.port, requestedPort: configuration.port, addresses, tokenFile: studies.tokenFile }),
  );
  for (const signal of ['SIGINT', 'SIGTERM'] as const) {
    process.once(signal, () => {
      console.log('Stopping.');
      void server.close().then(() => studies.close());
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
