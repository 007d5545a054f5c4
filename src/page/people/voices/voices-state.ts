/** The user's part in the voices, as panels show it. */
export interface VoicesState {
  /** none: the room has no voices. asked: the user reads the consent text. in: the user takes part. */
  readonly phase: 'none' | 'off' | 'asked' | 'joining' | 'in';
  readonly muted: boolean;
  /** The server has a relay. */
  readonly relay: boolean;
  readonly relayOnly: boolean;
  /** A message about the user's voice; null: none. */
  readonly message: string | null;
  /** There is no microphone. The user can request it again. */
  readonly microphoneMissing: boolean;
}

/** The voice of another player. */
export interface PersonVoice {
  readonly voice: 'none' | 'muted' | 'open';
  readonly link: 'none' | 'connecting' | 'connected' | 'lost';
  /** The user has muted the player. */
  readonly silenced: boolean;
  /** The user has hidden the player, which mutes the voice too. */
  readonly hidden: boolean;
}

/** The consent text before the user joins the voices for the first time. */
export const consentText =
  'Voices are sent directly between browsers, so people in the room could learn your network address (IP). Nothing is recorded, and you join muted.';
