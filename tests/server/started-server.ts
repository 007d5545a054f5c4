import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { isAlive, kill, messageFrom } from './child-process';

export const experimenterToken = 'tests-Zk3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';
export const testSecret = 'tests-kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gAzE4uV7iO';

/** What the process reports of itself. */
export interface ServerState {
  /** The memory of what is alive, and of garbage that is not collected yet. */
  readonly heldBytes: number;
  readonly rssBytes: number;
  readonly cpuSeconds: number;
  /** Delay of the event loop since the last report [ms]. */
  readonly loop: { readonly p99Ms: number; readonly maxMs: number };
}

interface Question {
  readonly aheadSeconds?: number;
  readonly atSeconds?: number;
  readonly collect?: boolean;
}

interface StartOptions {
  /** Holds the folder of the studies. Default: a new one, which is deleted with the server. */
  readonly directory?: string;
  /** Default: any free one. */
  readonly port?: number;
  /** A program, with its arguments, that runs the server as its child. */
  readonly through?: readonly string[];
}

const pathInRepository = (path: string): string => fileURLToPath(new URL(`../../${path}`, import.meta.url));

/** Returns the arguments of Node: those of the image, or with THREEPOINT_SERVER=source those of `npm start`. */
function serverCommand(): readonly string[] {
  if (process.env.THREEPOINT_SERVER === 'source') return ['--import', 'tsx', pathInRepository('server/main.ts')];
  const image = process.env.THREEPOINT_IMAGE;
  if (!image) throw new Error('The server is not built: tests/server/built-server.ts builds it before the tests.');
  return ['--enable-source-maps', join(image, 'server/main.mjs')];
}

/**
 * Starts the server that users run, with page, studies and rooms, in a process of its own. Rejects with its messages if
 * it ends instead of serving.
 */
export async function startServer(
  environment: Readonly<Record<string, string>> = {},
  { directory: given, port: wanted = 0, through = [] }: StartOptions = {},
) {
  const directory = given ?? mkdtempSync(join(tmpdir(), 'threepoint-server-'));
  const preload = ['--import', new URL('./inspect.mjs', import.meta.url).href];
  const [command, ...words] = [...through, process.execPath, ...preload, ...serverCommand()];
  const child = spawn(command as string, words, {
    stdio: ['ignore', 'pipe', 'pipe', 'ipc'],
    env: {
      ...process.env,
      PORT: `${wanted}`,
      STUDIES: join(directory, 'studies'),
      EXPERIMENTER_TOKEN: experimenterToken,
      THREEPOINT_SECRET: testSecret,
      THREEPOINT_LOG_LEVEL: 'silent',
      ...environment,
      NODE_OPTIONS: environment.NODE_OPTIONS ?? '',
    },
  });
  let output = '';
  let errors = '';
  child.stderr?.setEncoding('utf8').on('data', (text: string) => {
    errors += text;
  });
  const port = await new Promise<number>((resolve, reject) => {
    child.once('error', reject);
    child.once('close', (code) => reject(new Error(`The server ended with ${code}: ${errors}${output}`)));
    child.stdout?.setEncoding('utf8').on('data', (text: string) => {
      output += text;
      const address = /http:\/\/localhost:(\d+)/.exec(output);
      if (address) resolve(Number(address[1]));
    });
  });
  const ask = async (question: Question) => {
    child.send(question);
    return messageFrom<ServerState>(child);
  };
  return {
    port,
    url: `http://127.0.0.1:${port}`,
    directory,
    isAlive: () => isAlive(child),
    /** Asks the server to stop, as a service manager does. */
    stop: () => child.kill('SIGTERM'),
    async kill() {
      await kill(child);
      if (given === undefined) rmSync(directory, { recursive: true, force: true, maxRetries: 10 });
    },
    /** Everything printed so far. */
    printed: () => output + errors,
    /** Everything printed so far on the stream of errors: the log of the studies, and exceptions. */
    errors: () => errors,
    /** The faults of the studies that were logged so far. */
    faults: () => errors.split('\n').filter((line) => line.startsWith('study: unexpected error: ')),
    /** Moves the clock of the server, and of nothing else, to this far from the machine's [s]. */
    setClock: (aheadSeconds: number) => ask({ aheadSeconds }),
    /** Stops the clock of the server at this time [s]. */
    stopClock: (atSeconds: number) => ask({ atSeconds }),
    /** `collect`: after garbage collection, without the memory that V8 reserves for new objects. */
    inspect: ({ collect = false } = {}) => ask({ collect }),
  };
}
export type StartedServer = Awaited<ReturnType<typeof startServer>>;
