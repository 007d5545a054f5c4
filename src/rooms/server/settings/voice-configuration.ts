import { ConfigurationError } from 'threepoint-http/configuration-error';

/** How pages of the rooms find a way to each other for their voices. */
export interface VoiceConfiguration {
  /** Servers that tell a page its own address as others see it; none: pages of one network find each other all the same. */
  readonly stun: readonly string[];
  /** Servers that pass on what finds no other way, and hide who talks from whom; null: there are none. */
  readonly turn: { readonly urls: readonly string[]; readonly secret: string } | null;
}

type Environment = Readonly<Record<string, string | undefined>>;

export const voiceEnvironment = `  THREEPOINT_VOICES             off: people in a room cannot talk to each other, and no page may use the microphone; default on
  THREEPOINT_STUN               stun:HOST:PORT of servers that tell pages their address, with commas between; default none
  THREEPOINT_TURN               turn:HOST:PORT of servers that pass voices on, with commas between; default none
  THREEPOINT_TURN_SECRET        what those servers sign passes with (coturn: static-auth-secret), 32 characters or more`;

function urlsFrom(environment: Environment, name: string, form: RegExp, like: string): readonly string[] {
  const urls = (environment[name] ?? '')
    .split(',')
    .map((part) => part.trim())
    .filter(Boolean);
  for (const url of urls) {
    if (!form.test(url))
      throw new ConfigurationError(`The environment variable ${name} must hold addresses as ${like}, not "${url}".`);
  }
  return urls;
}

/** null: there are no voices. Throws a ConfigurationError that names the variable and what it should be. */
export function voiceConfigurationFrom(environment: Environment): VoiceConfiguration | null {
  const wanted = environment.THREEPOINT_VOICES || 'on';
  if (wanted !== 'on' && wanted !== 'off') {
    throw new ConfigurationError(`The environment variable THREEPOINT_VOICES must be on or off, not "${wanted}".`);
  }
  const stun = urlsFrom(environment, 'THREEPOINT_STUN', /^stuns?:[\w.[\]:-]+$/, 'stun:stun.example.org:3478');
  const urls = urlsFrom(
    environment,
    'THREEPOINT_TURN',
    /^turns?:[\w.[\]:-]+(\?transport=(udp|tcp))?$/,
    'turn:turn.example.org:3478?transport=udp',
  );
  const secret = environment.THREEPOINT_TURN_SECRET ?? '';
  if (urls.length > 0 && secret.length < 32) {
    throw new ConfigurationError(
      `The environment variable THREEPOINT_TURN needs THREEPOINT_TURN_SECRET beside it, of at least 32 characters; it has ${secret.length}.`,
    );
  }
  if (wanted === 'off') return null;
  return { stun, turn: urls.length > 0 ? { urls, secret } : null };
}
