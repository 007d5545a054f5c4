import type { PersonVoice } from '../voices/voices-state';

/** A seat of the room, and the voice of its player. */
export interface SeatRow extends PersonVoice {
  readonly seat: number;
  /** null: no player is there. */
  readonly name: string | null;
  /** The station, whose mark is shown next to the name. */
  readonly station: number;
  /** The name in a text, after the mark. */
  readonly label: string;
  readonly role: string;
}

/** Another player of the room as lists show them, at the desk and in the headset alike. */
export interface OtherPlayer extends SeatRow {
  readonly name: string;
  /** The state of their voice in words; empty: nothing to show. */
  readonly status: string;
  /** none: the player has no voice to mute. off: the player is hidden, which mutes the voice too. */
  readonly muting: 'offered' | 'off' | 'none';
}

const linkTexts = { none: '', connecting: 'connecting …', connected: '', lost: 'connection lost' } as const;

/** Describes the state of a player's voice. */
function voiceText({ voice, link, silenced }: PersonVoice): string {
  if (voice === 'none') return '';
  if (silenced) return 'muted by you';
  return linkTexts[link] || (voice === 'muted' ? 'muted' : 'can be heard');
}

/**
 * Lists the other people in the room. `seat`: the user's, null for a spectator; `inVoices`: the user takes part in the
 * voices.
 */
export const otherPlayers = (
  { seat: own, people }: { readonly seat: number | null; readonly people: readonly SeatRow[] },
  inVoices: boolean,
): readonly OtherPlayer[] =>
  people.flatMap((person): OtherPlayer[] => {
    const { seat, name, voice, hidden } = person;
    if (name === null || seat === own) return [];
    const status = hidden ? 'hidden' : inVoices ? voiceText(person) : '';
    const muting = !inVoices || voice === 'none' ? 'none' : hidden ? 'off' : 'offered';
    return [{ ...person, name, status, muting }];
  });

/** The labels of the buttons that mute and hide a player. */
export const muteLabel = ({ silenced }: Pick<OtherPlayer, 'silenced'>): string => (silenced ? 'Unmute' : 'Mute');
export const hideLabel = ({ hidden }: Pick<OtherPlayer, 'hidden'>): string => (hidden ? 'Show' : 'Hide');
