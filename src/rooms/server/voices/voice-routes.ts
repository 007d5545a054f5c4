import { createHash, createHmac } from 'node:crypto';
import { type Answer, json } from 'threepoint-http/answer';
import type { Call, Route } from 'threepoint-http/router';
import { requirePass } from '../access/request-pass';
import type { RoomTokens } from '../access/room-tokens';
import type { VoiceConfiguration } from '../settings/voice-configuration';

export interface VoiceRoutesOptions {
  /** null: there are no voices. */
  readonly voices: VoiceConfiguration | null;
  readonly tokens: Pick<RoomTokens, 'verify'>;
  /** Seconds since 1970. */
  readonly now: () => number;
}

/** A pass to the servers that pass voices on is good for so long [s]: pages ask for another one before. */
const turnSeconds = 4 * 3600;
const noVoices = { voices: false, iceServers: [], ttlSeconds: null };

/**
 * A user and password that a TURN server believes which knows the same secret, until a time [s since 1970] ("REST API for access to TURN
 * services", draft-uberti-behave-turn-rest-00; coturn's use-auth-secret). The user's name tells the TURN server nothing but that.
 */
function turnPass(secret: string, identity: string, until: number): { username: string; credential: string } {
  const alias = createHash('sha256').update(identity).digest('hex').slice(0, 12);
  const username = `${Math.floor(until)}:${alias}`;
  return { username, credential: createHmac('sha1', secret).update(username).digest('base64') };
}

/** Whether the people of a room can talk, and by which servers their pages find each other. `?room=` is for the proxy of a fleet. */
export class VoiceRoutes {
  readonly routes: readonly Route<'client'>[];
  readonly #options: VoiceRoutesOptions;

  constructor(options: VoiceRoutesOptions) {
    this.#options = options;
    const handle = (call: Call) => this.#terms(call);
    this.routes = [{ method: 'GET', path: '/api/voices', access: 'client', handle, bodyLimit: 0 }];
  }

  async #terms(call: Call): Promise<Answer> {
    const { voices, tokens, now } = this.#options;
    const { identity, assigned } = await requirePass(call, tokens);
    if (!voices || assigned) return json(noVoices);
    const { stun, turn } = voices;
    return json({
      voices: true,
      iceServers: [
        ...(stun.length > 0 ? [{ urls: stun }] : []),
        ...(turn ? [{ urls: turn.urls, ...turnPass(turn.secret, identity, now() + turnSeconds) }] : []),
      ],
      ttlSeconds: turn ? turnSeconds : null,
    });
  }
}
