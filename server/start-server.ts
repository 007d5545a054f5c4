import {
  ConnectionLimiter,
  type Credentials,
  createRouter,
  createSitePolicy,
  errorLine,
  prepareServer,
  readSoftwareVersion,
} from 'threepoint-http';
import { attachRooms, type RelayConfiguration } from 'threepoint-relay';
import type { RoomKinds } from 'threepoint-rooms/room';
import { openStudyService } from 'threepoint-study/server';
import { createPageHandler } from './page-handler';

export interface StartOptions {
  readonly pageDirectory: string;
  readonly studyDirectory: string;
  /** null: the token that is stored with the studies. */
  readonly experimenterToken: string | null;
  readonly relay: RelayConfiguration;
  readonly games: RoomKinds;
  /** Signs the passes into rooms. */
  readonly secret: string;
  readonly host: string;
  readonly port: number;
  readonly credentials?: Credentials;
  /** Receives a line for each fault, wrong guess and deletion of the studies. */
  readonly log: (line: string) => void;
}

/** The running server: page, studies and relay on one port. */
export interface RunningServer {
  readonly port: number;
  /** The file of the experimenter's token; null: the token is a setting. */
  readonly tokenFile: string | null;
  /** Methods and paths of all services; ":name" stands for one segment. */
  readonly routes: readonly { readonly method: string; readonly path: string }[];
  close(): Promise<void>;
}

/** Starts the server of `npm start`. Throws if the page is not built. */
export async function startServer(options: StartOptions): Promise<RunningServer> {
  const { relay: relaying, games, host, port, credentials, log } = options;
  const now = () => Date.now() / 1000;
  const page = createPageHandler(options.pageDirectory, {
    microphone: relaying.voices !== null,
    filesFrom: [...relaying.filesFrom, ...(relaying.avatarsFrom ? [new URL(relaying.avatarsFrom).origin] : [])],
  });
  const studies = await openStudyService({
    thread: new URL('./study-thread-worker.mjs', import.meta.url),
    directory: options.studyDirectory,
    token: options.experimenterToken,
    software: readSoftwareVersion(options.pageDirectory, new URL('../package.json', import.meta.url)),
    now,
    secret: options.secret,
    trustProxy: relaying.trustProxy,
    log,
  });
  const connectionLimiter = new ConnectionLimiter({
    perAddress: relaying.connectionsPerAddress,
    behindProxy: relaying.trustProxy,
  });
  const site = createSitePolicy(relaying);
  const prepared = prepareServer(createRouter([studies.service], page, site), {
    ...(credentials && { credentials }),
    connectionLimiter,
    checkHost: site.checkHost,
    onError: (error) => log(errorLine(error)),
  });
  const rooms = attachRooms(prepared.http, {
    ...relaying,
    secret: options.secret,
    games,
    monitoring: true,
    connections: connectionLimiter,
  });
  const server = await prepared.listen({ host, port }).catch(async (error: unknown) => {
    // Their timers would keep the process alive.
    await rooms.close();
    await studies.close();
    throw error;
  });
  return {
    port: server.port,
    tokenFile: studies.tokenFile,
    routes: [...rooms.routes, ...studies.service.routes],
    async close() {
      await rooms.close();
      await server.close();
      await studies.close();
    },
  };
}
