import { ConfigurationError } from 'threepoint-http/configuration-error';
import { weaknessOf } from 'threepoint-http/secret-bits';
import { type VoiceConfiguration, voiceConfigurationFrom, voiceEnvironment } from './voice-configuration';

/** How the relay behaves, from the environment. */
export interface RelayConfiguration {
  /** Signs the room tokens; the same in all processes of a fleet. null: one of our own, kept on this machine. */
  readonly secret: string | null;
  /** Pages of these origins may connect; empty: pages of the very address they connect to. */
  readonly origins: readonly string[];
  /** Names of the server besides localhost, this machine's own and those of the origins. */
  readonly hosts: readonly string[];
  /** How often the rooms' matches are stepped per second, at most. */
  readonly tickHz: number;
  readonly posesPerSecond: number;
  readonly eventsPerSecond: number;
  /** New people per minute and address; a person who returns does not count. */
  readonly joinsPerMinute: number;
  /** Connections that one address may have open at once. */
  readonly connectionsPerAddress: number;
  readonly mostRooms: number;
  /** Seconds of a ball game's round. */
  readonly ballSeconds: number;
  /** Of all avatars together that the people of this process's rooms have stored; 0: none is taken. */
  readonly avatarMegabytes: number;
  /** The folder of another server that has avatars by the same names, with a slash at its end; null: there is none. */
  readonly avatarsFrom: string | null;
  /** Origins from which the page may read files that are named by address: avatars, recordings, motion capture. */
  readonly filesFrom: readonly string[];
  /** null: people in a room cannot talk to each other. */
  readonly voices: VoiceConfiguration | null;
  /** Believe what a proxy in front says of a client's address. */
  readonly trustProxy: boolean;
  /** Of the lobby that several processes share; null: this process is alone. */
  readonly redisUrl: string | null;
  /** The address to listen on; null: this machine alone, or with --lan all of its own. */
  readonly host: string | null;
  /** The holder of this, sent as "Authorization: Bearer …", may end rooms; null: no one. */
  readonly adminToken: string | null;
  readonly logLevel: (typeof logLevels)[number];
}

const logLevels = ['trace', 'debug', 'info', 'warn', 'error', 'silent'] as const;
const shortestSecret = 32;

type Environment = Readonly<Record<string, string | undefined>>;

export const relayEnvironment = `Environment of the relay (server/README.md):
  THREEPOINT_SECRET             signs room tokens; 128 bits or more (openssl rand -base64 32), the same in every process of a fleet
  THREEPOINT_ORIGINS            origins of pages that may connect, with commas between; default: the server's own
  THREEPOINT_HOSTS              names of the server, with commas between, where it has others than localhost, its addresses,
                                this machine's name and those in THREEPOINT_ORIGINS
  THREEPOINT_TICK_HZ            how often matches are stepped a second, 20 to 120; default 60
  THREEPOINT_POSES_PER_SECOND   budget of each client; default 40
  THREEPOINT_EVENTS_PER_SECOND  budget of each client; default 10
  THREEPOINT_JOINS_PER_MINUTE   budget of new people of each address; default 5, on this machine itself 120
  THREEPOINT_CONNECTIONS_PER_ADDRESS  connections that one address may have open; default 256
  THREEPOINT_MOST_ROOMS         rooms in this process; default 500
  THREEPOINT_BALL_SECONDS       length of a round of the ball game; default 90
  THREEPOINT_AVATAR_MEGABYTES   of avatars that people show each other, in memory; default 256, 0: none
  THREEPOINT_AVATARS_FROM       https:// address of a folder that has more of them, each named by its SHA-256 as base64url
  THREEPOINT_FILES_FROM         https:// origins, with commas between, from which the page may read avatars, recordings and motion capture
                                that are named by address; default: its own server alone
${voiceEnvironment}
  THREEPOINT_TRUST_PROXY        1: a proxy in front appends the clients' addresses to X-Forwarded-For; default 0
  THREEPOINT_REDIS_URL          redis://HOST:PORT of the lobby that several processes share
  THREEPOINT_ADMIN_TOKEN        lets its holder end rooms; 128 bits or more
  THREEPOINT_HOST               address to listen on behind a proxy, as 0.0.0.0; default 127.0.0.1
  THREEPOINT_LOG_LEVEL          ${logLevels.join(', ')}; default warn`;

function numberFrom(environment: Environment, name: string, fallback: number, min: number, max: number): number {
  const text = environment[name];
  if (text === undefined || text === '') return fallback;
  const value = Number(text);
  if (!(value >= min && value <= max)) {
    throw new ConfigurationError(
      `The environment variable ${name} must be a number from ${min} to ${max}, not "${text}".`,
    );
  }
  return value;
}

function originsFrom(environment: Environment, name: string, scheme: RegExp): readonly string[] {
  return (environment[name] ?? '')
    .split(',')
    .map((part) => part.trim())
    .filter(Boolean)
    .map((part) => {
      const url = URL.canParse(part) ? new URL(part) : null;
      if (!url || !scheme.test(url.protocol) || (part !== url.origin && part !== `${url.origin}/`)) {
        throw new ConfigurationError(
          `The environment variable ${name} must hold origins as https://example.org, not "${part}".`,
        );
      }
      return url.origin;
    });
}

function hostsFrom(text: string | undefined): readonly string[] {
  const names = (text ?? '')
    .split(',')
    .map((part) => part.trim())
    .filter(Boolean);
  for (const name of names) {
    if (!/^[a-z0-9]([a-z0-9.-]*[a-z0-9])?$/i.test(name)) {
      throw new ConfigurationError(
        `The environment variable THREEPOINT_HOSTS must hold names as study.example.org, without ports, not "${name}".`,
      );
    }
  }
  return names;
}

function folderFrom(text: string | undefined): string | null {
  if (!text) return null;
  const url = URL.canParse(text) ? new URL(text) : null;
  if (url?.protocol !== 'https:' || !url.pathname.endsWith('/') || url.search || url.hash || url.username) {
    throw new ConfigurationError(
      `The environment variable THREEPOINT_AVATARS_FROM must be a folder as https://example.org/avatars/, not "${text}".`,
    );
  }
  return url.href;
}

function refuseWeak(name: string, secret: string | null): void {
  const weakness = secret === null ? null : weaknessOf(secret);
  if (weakness) throw new ConfigurationError(`The secret in the environment variable ${name} ${weakness}`);
}

/** Throws a ConfigurationError that names the variable and what it should be. */
export function relayConfigurationFrom(environment: Environment): RelayConfiguration {
  const secret = environment.THREEPOINT_SECRET || null;
  if (secret !== null && secret.length < shortestSecret) {
    throw new ConfigurationError(
      `The environment variable THREEPOINT_SECRET must have at least ${shortestSecret} characters, has ${secret.length}.`,
    );
  }
  refuseWeak('THREEPOINT_SECRET', secret);
  const adminToken = environment.THREEPOINT_ADMIN_TOKEN || null;
  if (adminToken !== null && !/^\S{16,256}$/.test(adminToken)) {
    throw new ConfigurationError(
      `The environment variable THREEPOINT_ADMIN_TOKEN must have 16 to 256 characters and no spaces, has ${adminToken.length}.`,
    );
  }
  refuseWeak('THREEPOINT_ADMIN_TOKEN', adminToken);
  const redisUrl = environment.THREEPOINT_REDIS_URL || null;
  if (redisUrl !== null && !/^rediss?:\/\/\S+$/.test(redisUrl)) {
    throw new ConfigurationError(
      `The environment variable THREEPOINT_REDIS_URL must be like redis://localhost:6379, not "${redisUrl}".`,
    );
  }
  const logLevel = logLevels.find((level) => level === (environment.THREEPOINT_LOG_LEVEL || 'warn'));
  if (!logLevel) {
    throw new ConfigurationError(
      `The environment variable THREEPOINT_LOG_LEVEL must be one of ${logLevels.join(', ')}, not "${environment.THREEPOINT_LOG_LEVEL}".`,
    );
  }
  if (redisUrl !== null && secret === null) {
    throw new ConfigurationError(
      'Several processes need a common THREEPOINT_SECRET: set it beside THREEPOINT_REDIS_URL.',
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
    // A class of thirty behind one address: six connections for the page and two WebSockets each.
    connectionsPerAddress: whole('THREEPOINT_CONNECTIONS_PER_ADDRESS', 256, 8, 1_000_000),
    mostRooms: whole('THREEPOINT_MOST_ROOMS', 500, 1, 100_000),
    ballSeconds: number('THREEPOINT_BALL_SECONDS', 90, 1, 3600),
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
