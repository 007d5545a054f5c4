import * as v from 'valibot';
import { fetchWithPass, type RoomPass } from '../client/room-pass';

/** The voice settings of a room. */
export interface VoiceSettings {
  /** Whether players of the room can talk. */
  readonly voices: boolean;
  /** The STUN and TURN servers by which pages connect. */
  readonly iceServers: readonly RTCIceServer[];
  /** Time to live of the TURN credential [s]; null: there is no TURN server. */
  readonly ttlSeconds: number | null;
}

const urls = v.pipe(v.array(v.pipe(v.string(), v.regex(/^(stun|turn)s?:/))), v.minLength(1));
const settings = v.object({
  voices: v.boolean(),
  iceServers: v.array(
    v.object({ urls, username: v.exactOptional(v.string()), credential: v.exactOptional(v.string()) }),
  ),
  ttlSeconds: v.nullable(v.pipe(v.number(), v.minValue(1))),
});

/**
 * Fetches the settings from the relay at `base`, without a trailing slash. Rejects with a sentence if the server does
 * not answer.
 */
export async function fetchVoiceSettings(base: string, room: string, pass: RoomPass): Promise<VoiceSettings> {
  const response = await fetchWithPass(pass, `${base}/api/voices?room=${room}`);
  const read = response.ok ? v.safeParse(settings, await response.json().catch(() => null)) : null;
  if (!read?.success) throw new Error(`the server sent no voice settings (${response.status})`);
  return read.output;
}

/** Returns whether there is a TURN server, by which pages connect without learning each other's address. */
export const hasRelay = ({ iceServers }: VoiceSettings): boolean =>
  iceServers.some(({ urls }) => [urls].flat().some((url) => url.startsWith('turn')));
