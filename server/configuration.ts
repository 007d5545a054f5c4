import { parseArgs } from 'node:util';
import { ConfigurationError, secretWeakness } from 'threepoint-http';
import { gamesWithRooms } from './room-kinds';

/** The settings of this process, from the command line and the environment. */
export interface Configuration {
  /** The port to try first; 0: any free one. */
  readonly port: number;
  /** Serve HTTPS to the whole network instead of HTTP to this machine alone. */
  readonly lan: boolean;
  /** The folder of the studies; null: `study-data` next to the program. */
  readonly studyDirectory: string | null;
  /** The token for the experimenter's page; null: the server generates one and stores it with the studies. */
  readonly experimenterToken: string | null;
}

const roundLengths = gamesWithRooms.map(({ variable, rooms }) => `${variable}, default ${rooms.seconds}`).join('; ');

export const usage = `Usage: npm start -- [options]
  --port NUMBER  port to serve on (or the environment variable PORT); default 3333, the next free one if it is taken
  --lan          HTTPS for every device on the network, with a self-signed certificate
  --studies DIR  folder of the studies (or the environment variable STUDIES); default study-data
  --help         this text
The environment variable EXPERIMENTER_TOKEN (32 characters or more, as from "openssl rand -base64 32") replaces the token that the server
generates. The length of a round in seconds, 1 to 3600: ${roundLengths}.`;

function portFrom(text: string, source: string): number {
  const port = Number(text);
  if (!/^\d+$/.test(text) || port > 65535) {
    throw new ConfigurationError(`${source} must be a port number from 0 to 65535, not "${text}".`);
  }
  return port;
}

/**
 * Reads the arguments after the script's name, and the environment. Returns 'help' for --help. Throws a
 * ConfigurationError.
 */
export function configurationFrom(args: readonly string[], environment: NodeJS.ProcessEnv): Configuration | 'help' {
  const options = {
    port: { type: 'string' },
    lan: { type: 'boolean' },
    studies: { type: 'string' },
    help: { type: 'boolean' },
  } as const;
  let values: { port?: string; lan?: boolean; studies?: string; help?: boolean };
  try {
    ({ values } = parseArgs({ args: [...args], options, allowPositionals: false }));
  } catch (error) {
    throw new ConfigurationError(`${(error as Error).message.split('. ')[0]}.\n${usage}`);
  }
  if (values.help) return 'help';
  const port =
    values.port !== undefined
      ? portFrom(values.port, '--port')
      : environment.PORT
        ? portFrom(environment.PORT, 'The environment variable PORT')
        : 3333;
  const experimenterToken = environment.EXPERIMENTER_TOKEN || null;
  if (experimenterToken !== null) {
    const weakness = secretWeakness(experimenterToken);
    if (weakness) throw new ConfigurationError(`The token in the environment variable EXPERIMENTER_TOKEN ${weakness}`);
    if (!/^[\w~+/.-]{1,256}={0,2}$/.test(experimenterToken)) {
      throw new ConfigurationError(
        'The environment variable EXPERIMENTER_TOKEN must have at most 256 characters: letters, digits and - _ ~ + / .',
      );
    }
  }
  const studyDirectory = values.studies ?? (environment.STUDIES || null);
  if (studyDirectory === '') throw new ConfigurationError('--studies needs the name of a folder.');
  return { port, lan: values.lan ?? false, studyDirectory, experimenterToken };
}
