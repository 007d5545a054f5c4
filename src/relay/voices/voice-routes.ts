import { createHash, createHmac } from 'node:crypto';
import { jsonResponse, type Route } from 'threepoint-http';
import { requirePass } from '../access/require-pass';
import type { RoomTokens } from '../access/room-tokens';
import type { VoiceConfiguration } from '../settings/voice-configuration';

/** Lifetime of a TURN credential [s]; pages request the next one earlier. */
const turnSeconds = 4 * 3600;
const noVoices = { voices: false, iceServers: [], ttlSeconds: null };

/**
 * Returns a time-limited credential for a TURN server with the same secret ("REST API for access to TURN services",
 * draft-uberti-behave-turn-rest-00; coturn's use-auth-secret). `until`: seconds since 1970. The user name does not
 * identify the person.
 */
function turnCredential(secret: string, identity: string, until: number): { username: string; credential: string } {
  const alias = createHash('sha256').update(identity).digest('hex').slice(0, 12);
  const username = `${Math.floor(until)}:${alias}`;
  return { username, credential: createHmac('sha1', secret).update(username).digest('base64') };
}

/**
 * Returns the route that answers whether a room has voices (`voices` null: none has), and by which ICE servers. A proxy
 * in front of several processes routes by `?room=`. `now`: seconds since 1970.
 */
export const voiceRoute = (
  voices: VoiceConfiguration | null,
  tokens: Pick<RoomTokens, 'verify'>,
  now: () => number,
): Route<'client'> => ({
  method: 'GET',
  path: '/api/voices',
  access: 'client',
  bodyLimit: 0,
  async handle(call) {
    const { identity, assigned } = await requirePass(call, tokens);
    if (!voices || assigned) return jsonResponse(noVoices);
    const { stun, turn } = voices;
    return jsonResponse({
      voices: true,
      iceServers: [
        ...(stun.length > 0 ? [{ urls: stun }] : []),
        ...(turn ? [{ urls: turn.urls, ...turnCredential(turn.secret, identity, now() + turnSeconds) }] : []),
      ],
      ttlSeconds: turn ? turnSeconds : null,
    });
  },
});
