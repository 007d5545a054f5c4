import { createHash, createHmac } from 'node:crypto';
import { type HttpResponse, jsonResponse } from 'threepoint-http/response';
import type { Call, Route } from 'threepoint-http/router';
import { requirePass } from '../access/request-pass';
import type { RoomTokens } from '../access/room-tokens';
import type { VoiceConfiguration } from '../settings/voice-configuration';

export interface VoiceRoutesOptions {
  /** null: voices are off. */
  readonly voices: VoiceConfiguration | null;
  readonly tokens: Pick<RoomTokens, 'verify'>;
  /** Seconds since 1970. */
  readonly now: () => number;
}

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
 * The route that answers whether a room has voices, and by which ICE servers. A proxy in front of several processes
 * routes by `?room=`.
 */
export class VoiceRoutes {
  readonly routes: readonly Route<'client'>[];
  readonly #options: VoiceRoutesOptions;

  constructor(options: VoiceRoutesOptions) {
    this.#options = options;
    const handle = (call: Call) => this.#terms(call);
    this.routes = [{ method: 'GET', path: '/api/voices', access: 'client', handle, bodyLimit: 0 }];
  }

  async #terms(call: Call): Promise<HttpResponse> {
    const { voices, tokens, now } = this.#options;
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
  }
}
