import { ConfigurationError, invalidVariable, splitList } from 'threepoint-http';

/** The servers by which pages connect their voices. */
export interface VoiceConfiguration {
  /** STUN servers, from which a page learns its public address. Without one, only pages of the same network connect. */
  readonly stun: readonly string[];
  /** TURN servers, which relay voices between networks and hide addresses; null: none. */
  readonly turn: { readonly urls: readonly string[]; readonly secret: string } | null;
}

export const voiceEnvironment = `  THREEPOINT_VOICES             off: players cannot talk to each other, and no page may use the microphone; default on
  THREEPOINT_STUN               STUN servers as stun:HOST:PORT, separated by commas; default none
  THREEPOINT_TURN               TURN servers as turn:HOST:PORT, separated by commas; default none
  THREEPOINT_TURN_SECRET        secret of the TURN servers (coturn: static-auth-secret), 32 characters or more`;

function urlsFrom(environment: NodeJS.ProcessEnv, name: string, form: RegExp, like: string): readonly string[] {
  const urls = splitList(environment[name]);
  const strange = urls.find((url) => !form.test(url));
  if (strange !== undefined) throw invalidVariable(name, `list addresses such as ${like}`, strange);
  return urls;
}

/**
 * Reads the voice settings; null: voices are off. Throws a ConfigurationError that names the variable and its valid
 * values.
 */
export function voiceConfigurationFrom(environment: NodeJS.ProcessEnv): VoiceConfiguration | null {
  const wanted = environment.THREEPOINT_VOICES || 'on';
  if (wanted !== 'on' && wanted !== 'off') throw invalidVariable('THREEPOINT_VOICES', 'be on or off', wanted);
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
      `The environment variable THREEPOINT_TURN needs THREEPOINT_TURN_SECRET with at least 32 characters; it has ${secret.length}.`,
    );
  }
  if (wanted === 'off') return null;
  return { stun, turn: urls.length > 0 ? { urls, secret } : null };
}
