import type { PersonVoice } from './voices-state';

/** A seat of the room, and how it stands with the voice of the player on it. */
export interface Seated extends PersonVoice {
  readonly seat: number;
  /** null: no player is there. */
  readonly name: string | null;
  readonly role: string;
}

/** Another player of the room as lists show them, at the desk and in the headset alike. */
export interface OtherPlayer {
  readonly seat: number;
  readonly name: string;
  readonly role: string;
  /** How it stands with them here, in words; empty: nothing to say. */
  readonly said: string;
  readonly silenced: boolean;
  readonly hidden: boolean;
  /** none: the player has no voice to mute. off: the player is hidden, which mutes the voice too. */
  readonly muting: 'offered' | 'off' | 'none';
}

const linkTexts = { none: '', connecting: 'connecting …', connected: '', lost: 'connection lost' } as const;

/** How it stands with a player's voice, in words. */
function voiceText({ voice, link, silenced }: PersonVoice): string {
  if (voice === 'none') return '';
  if (silenced) return 'muted by you';
  return linkTexts[link] || (voice === 'muted' ? 'muted' : 'can be heard');
}

/** Lists the other people in the room. `seat`: the user's, null for a spectator; `inVoices`: the user takes part in the voices. */
export const otherPlayers = (
  { seat: own, people }: { readonly seat: number | null; readonly people: readonly Seated[] },
  inVoices: boolean,
): readonly OtherPlayer[] =>
  people.flatMap((person): OtherPlayer[] => {
    const { seat, name, role, voice, silenced, hidden } = person;
    if (name === null || seat === own) return [];
    const said = hidden ? 'hidden' : inVoices ? voiceText(person) : '';
    const muting = !inVoices || voice === 'none' ? 'none' : hidden ? 'off' : 'offered';
    return [{ seat, name, role, said, silenced, hidden, muting }];
  });

/** What the button says that mutes or unmutes a player, and the one that hides or shows them. */
export const muteLabel = ({ silenced }: Pick<OtherPlayer, 'silenced'>): string => (silenced ? 'Unmute' : 'Mute');
export const hideLabel = ({ hidden }: Pick<OtherPlayer, 'hidden'>): string => (hidden ? 'Show' : 'Hide');
