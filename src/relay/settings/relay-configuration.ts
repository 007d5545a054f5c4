import { ConfigurationError, invalidVariable, numberFrom, secretWeakness, splitList } from 'threepoint-http';
import { type VoiceConfiguration, voiceConfigurationFrom, voiceEnvironment } from './voice-configuration';

/** The settings of the relay, from the environment. */
export interface RelayConfiguration {
  /** Signs the room tokens; the same in all processes. null: a generated secret, stored on this machine. */
  readonly secret: string | null;
  /** Origins of pages that may connect; empty: the server's own origin. */
  readonly origins: readonly string[];
  /**
   * Further names of the server, beyond localhost, this machine's and those of the origins: requests with another Host
   * are rejected, those of the WebSockets, too. 'any': the Host is not checked.
   */
  readonly hosts: readonly string[] | 'any';
  /** The most ticks of a room per second. */
  readonly tickHz: number;
  readonly posesPerSecond: number;
  readonly eventsPerSecond: number;
  /** New people per minute and address; returning people do not count. */
  readonly joinsPerMinute: number;
  /** The most open connections of one address. */
  readonly connectionsPerAddress: number;
  readonly maxRooms: number;
  /** The most megabytes of all stored avatars; 0: no avatar is accepted. */
  readonly avatarMegabytes: number;
  /** A folder on another server with avatars by hash, with a trailing slash; null: none. */
  readonly avatarsFrom: string | null;
  /** Origins from which the page may read files by address: avatars, recordings, motion capture. */
  readonly filesFrom: readonly string[];
  /** null: players cannot talk to each other. */
  readonly voices: VoiceConfiguration | null;
  /** Whether to trust the client's address in a proxy's X-Forwarded-For. */
  readonly trustProxy: boolean;
  /** Redis of the lobby that several processes share; null: a single process. */
  readonly redisUrl: string | null;
  /** The address to listen on; null: loopback, or with --lan all interfaces. */
  readonly host: string | null;
  /** The bearer token that permits ending rooms; null: nobody may. */
  readonly adminToken: string | null;
  readonly logLevel: (typeof logLevels)[number];
}

const logLevels = ['trace', 'debug', 'info', 'warn', 'error', 'silent'] as const;

export const relayEnvironment = `Environment of the relay:
  THREEPOINT_SECRET             signs room tokens; 32 characters or more (openssl rand -base64 32), the same in all processes
  THREEPOINT_ORIGINS            origins of pages that may connect, separated by commas; default: the server's own
  THREEPOINT_HOSTS              further names of the server, separated by commas; known are localhost, its addresses,
                                this machine's name and those in THREEPOINT_ORIGINS
  THREEPOINT_TICK_HZ            ticks of a match per second, 20 to 120; default 60
  THREEPOINT_POSES_PER_SECOND   most poses of each client; default 40
  THREEPOINT_EVENTS_PER_SECOND  most messages of each client; default 10
  THREEPOINT_JOINS_PER_MINUTE   most new people of each address; default 5, from this machine 120
  THREEPOINT_CONNECTIONS_PER_ADDRESS  most open connections of each address; default 256
  THREEPOINT_MOST_ROOMS         most rooms of this process; default 500
  THREEPOINT_AVATAR_MEGABYTES   memory for players' avatars; default 256, 0: none
  THREEPOINT_AVATARS_FROM       https:// address of a folder with further avatars, each named by its SHA-256 as base64url
  THREEPOINT_FILES_FROM         https:// origins, separated by commas, from which the page may read avatars, recordings and motion capture
                                by address; default: only its own server
${voiceEnvironment}
  THREEPOINT_TRUST_PROXY        1: a proxy appends the client's address to X-Forwarded-For; default 0
  THREEPOINT_REDIS_URL          redis://HOST:PORT of the lobby that several processes share
  THREEPOINT_ADMIN_TOKEN        token that permits ending rooms; 32 characters or more
  THREEPOINT_HOST               address to listen on behind a proxy, for example 0.0.0.0; default 127.0.0.1
  THREEPOINT_LOG_LEVEL          ${logLevels.join(', ')}; default warn`;

function originsFrom(environment: NodeJS.ProcessEnv, name: string, scheme: RegExp): readonly string[] {
  return splitList(environment[name]).map((part) => {
    const url = URL.canParse(part) ? new URL(part) : null;
    if (!url || !scheme.test(url.protocol) || (part !== url.origin && part !== `${url.origin}/`))
      throw invalidVariable(name, 'list origins such as https://example.org', part);
    return url.origin;
  });
}

function hostsFrom(text: string | undefined): readonly string[] {
  const names = splitList(text);
  const strange = names.find((name) => !/^[a-z0-9]([a-z0-9.-]*[a-z0-9])?$/i.test(name));
  if (strange !== undefined)
    throw invalidVariable('THREEPOINT_HOSTS', 'list names such as study.example.org, without ports', strange);
  return names;
}

function folderFrom(text: string | undefined): string | null {
  if (!text) return null;
  const url = URL.canParse(text) ? new URL(text) : null;
  if (url?.protocol !== 'https:' || !url.pathname.endsWith('/') || url.search || url.hash || url.username)
    throw invalidVariable('THREEPOINT_AVATARS_FROM', 'be a folder such as https://example.org/avatars/', text);
  return url.href;
}

function rejectWeak(name: string, secret: string | null): void {
  const weakness = secret === null ? null : secretWeakness(secret);
  if (weakness) throw new ConfigurationError(`The secret in the environment variable ${name} ${weakness}`);
}

/** Reads the settings. Throws a ConfigurationError that names the variable and its valid values. */
export function relayConfigurationFrom(environment: NodeJS.ProcessEnv): RelayConfiguration {
  const secret = environment.THREEPOINT_SECRET || null;
  rejectWeak('THREEPOINT_SECRET', secret);
  const adminToken = environment.THREEPOINT_ADMIN_TOKEN || null;
  rejectWeak('THREEPOINT_ADMIN_TOKEN', adminToken);
  if (adminToken !== null && !/^\S{1,256}$/.test(adminToken)) {
    throw new ConfigurationError(
      `The environment variable THREEPOINT_ADMIN_TOKEN must have no spaces and at most 256 characters, has ${adminToken.length}.`,
    );
  }
  const redisUrl = environment.THREEPOINT_REDIS_URL || null;
  if (redisUrl !== null && !/^rediss?:\/\/\S+$/.test(redisUrl))
    throw invalidVariable('THREEPOINT_REDIS_URL', 'be like redis://localhost:6379', redisUrl);
  const level = environment.THREEPOINT_LOG_LEVEL || 'warn';
  const logLevel = logLevels.find((known) => known === level);
  if (!logLevel) throw invalidVariable('THREEPOINT_LOG_LEVEL', `be one of ${logLevels.join(', ')}`, level);
  if (redisUrl !== null && secret === null) {
    throw new ConfigurationError(
      'Several processes need the same THREEPOINT_SECRET. Set it together with THREEPOINT_REDIS_URL.',
    );
  }
  const number = (name: string, fallback: number, min: number, max: number) =>
    numberFrom(environment, name, fallback, min, max);
  const whole = (name: string, fallback: number, min: number, max: number) =>
    Math.round(number(name, fallback, min, max));
  return {
    secret,
    origins: originsFrom(environment, 'THREEPOINT_ORIGINS', /^https?:$/),
    hosts: hostsFrom(environment.THREEPOINT_HOSTS),
    tickHz: number('THREEPOINT_TICK_HZ', 60, 20, 120),
    posesPerSecond: whole('THREEPOINT_POSES_PER_SECOND', 40, 1, 200),
    eventsPerSecond: whole('THREEPOINT_EVENTS_PER_SECOND', 10, 1, 1000),
    joinsPerMinute: whole('THREEPOINT_JOINS_PER_MINUTE', 5, 1, 100_000),
    // Thirty people behind one address: each has six connections for the page and two WebSockets.
    connectionsPerAddress: whole('THREEPOINT_CONNECTIONS_PER_ADDRESS', 256, 8, 1_000_000),
    maxRooms: whole('THREEPOINT_MOST_ROOMS', 500, 1, 100_000),
    avatarMegabytes: whole('THREEPOINT_AVATAR_MEGABYTES', 256, 0, 65_536),
    avatarsFrom: folderFrom(environment.THREEPOINT_AVATARS_FROM),
    filesFrom: originsFrom(environment, 'THREEPOINT_FILES_FROM', /^https:$/),
    voices: voiceConfigurationFrom(environment),
    trustProxy: whole('THREEPOINT_TRUST_PROXY', 0, 0, 1) === 1,
    redisUrl,
    host: environment.THREEPOINT_HOST || null,
    adminToken,
    logLevel,
  };
}
