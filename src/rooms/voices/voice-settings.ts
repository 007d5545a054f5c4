import * as v from 'valibot';
import type { RoomPass } from '../client/room-pass';

/** What a server says of the voices in one of its rooms. */
export interface VoiceSettings {
  /** Whether the people of the room can talk at all. */
  readonly voices: boolean;
  /** By which their pages find each other. */
  readonly iceServers: readonly RTCIceServer[];
  /** For so long [s] from the answer on the pass to a relay among them lets a page in; null: there is none. */
  readonly ttlSeconds: number | null;
}

const urls = v.pipe(v.array(v.pipe(v.string(), v.regex(/^(stun|turn)s?:/))), v.minLength(1));
const terms = v.object({
  voices: v.boolean(),
  iceServers: v.array(
    v.object({ urls, username: v.exactOptional(v.string()), credential: v.exactOptional(v.string()) }),
  ),
  ttlSeconds: v.nullable(v.pipe(v.number(), v.minValue(1))),
});

/** Asks the relay at `base`, no slash at its end. Rejects with a sentence where the server does not say. */
export async function fetchVoiceSettings(base: string, room: string, pass: RoomPass): Promise<VoiceSettings> {
  for (const afresh of [false, true]) {
    const response = await fetch(`${base}/api/voices?room=${room}`, {
      headers: { authorization: `Bearer ${await pass.token(afresh)}` },
      cache: 'no-store',
    });
    // Once more with a renewed pass where this one has expired.
    if (response.status === 401 && !afresh) continue;
    const read = response.ok ? v.safeParse(terms, await response.json().catch(() => null)) : null;
    if (!read?.success) throw new Error(`the server says nothing of voices (${response.status})`);
    return read.output;
  }
  throw new Error('the server let no one in');
}

/** Whether there is a server that passes voices on, so that no page learns the address of another. */
export const hasRelay = ({ iceServers }: VoiceSettings): boolean =>
  iceServers.some(({ urls }) => [urls].flat().some((url) => url.startsWith('turn')));
