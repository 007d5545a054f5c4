import { fileURLToPath } from 'node:url';
import { certificateFor } from './certificate';
import { ConfigurationError, configurationFrom, usage } from './configuration';
import { lanAddresses } from './lan-addresses';
import { createPageHandler } from './page';
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
  const server = await serve(createPageHandler(pathInRepository('dist')), {
    host: addresses ? '0.0.0.0' : '127.0.0.1',
    port: configuration.port,
    ...(addresses && { credentials: await certificateFor(addresses, pathInRepository('.cache'), new Date()) }),
  });
  console.log(welcome({ port: server.port, requestedPort: configuration.port, addresses }));
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
