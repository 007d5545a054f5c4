import { button, element, toggle } from 'threepoint-ui';
import { seatLooks } from '../view/seat-looks';
import { consentText, type VoicesState } from '../voices/voices-state';
import { hideLabel, muteLabel, type OtherPlayer, otherPlayers, type SeatRow } from './other-players';

/** The people in the room, for this part of the bar. */
export interface ListedPeople {
  /** The user's seat; null: a spectator. */
  readonly seat: number | null;
  readonly people: readonly SeatRow[];
}

export interface VoicesBarActions {
  /** Shows or hides the consent text of voices. */
  ask(on: boolean): void;
  join(): void;
  leave(): void;
  mute(on: boolean): void;
  relayOnly(on: boolean): void;
  /** Stops or resumes playing the voice of a player. */
  silence(seat: number, on: boolean): void;
  /** Hides a player and their voice, or shows them again. */
  hide(seat: number, on: boolean): void;
}

/** Returns the mark of a station in its colour. */
function seatMark(station: number): HTMLElement {
  const look = seatLooks[station];
  const mark = element('span', { class: 'seat-mark' }, look?.mark ?? '');
  // The page's policy allows no style in markup.
  if (look) Object.assign(mark.style, { background: look.color, color: look.ink });
  return mark;
}

/** Creates the list of the other players with the buttons that mute and hide them. */
function createPeople(actions: VoicesBarActions) {
  const node = element('ul', { class: 'people', 'aria-label': 'Other players' });
  let shown = '';
  const row = (player: OtherPlayer) => {
    const { seat, name, station, label, status, silenced, hidden, muting } = player;
    const mute = button(muteLabel(player), () => actions.silence(seat, !silenced), {
      'aria-label': `${muteLabel(player)} ${label}`,
      disabled: muting === 'off',
    });
    mute.hidden = muting === 'none';
    const hide = button(hideLabel(player), () => actions.hide(seat, !hidden), {
      'aria-label': `${hideLabel(player)} ${label}`,
    });
    const who = element('p', { class: 'who' }, element('span', {}, name), element('span', { class: 'hint' }, status));
    return element('li', {}, seatMark(station), who, element('div', { class: 'buttons' }, mute, hide));
  };
  return {
    node,
    show(round: ListedPeople | null, inVoices: boolean): void {
      const others = round ? otherPlayers(round, inVoices) : [];
      const key = JSON.stringify(others);
      node.hidden = others.length === 0;
      if (key === shown) return;
      shown = key;
      node.replaceChildren(...others.map(row));
    },
  };
}

/** Creates the consent text with the buttons that join or decline. */
function createConsent(actions: VoicesBarActions) {
  const relay = toggle('Hide my address (relay only)', actions.relayOnly);
  const without = element(
    'p',
    { class: 'hint' },
    'This server has no relay, so your address cannot be hidden. Do not join if you do not want that.',
  );
  const node = element(
    'div',
    { class: 'consent', role: 'group', 'aria-label': 'Before you join voice chat' },
    element('p', {}, consentText),
    relay.node,
    without,
    element(
      'div',
      { class: 'row' },
      button('Join, muted', actions.join, { class: 'primary' }),
      button('Not now', () => actions.ask(false)),
    ),
  );
  return {
    node,
    show({ phase, relay: has, relayOnly }: VoicesState): void {
      node.hidden = phase !== 'asked';
      relay.node.hidden = !has;
      relay.input.checked = relayOnly;
      without.hidden = has;
    },
  };
}

/** Talking with the others, and the list of them. */
export function createVoicesBar(actions: VoicesBarActions) {
  let muted = true;
  const ask = button('Talk with the others', () => actions.ask(true));
  const mute = button('Unmute me', () => actions.mute(!muted), { 'aria-keyshortcuts': 't' });
  const leave = button('Leave voice chat', actions.leave);
  const status = element('p', { class: 'hint', role: 'status' });
  const consent = createConsent(actions);
  const people = createPeople(actions);
  const node = element(
    'div',
    { class: 'voices', role: 'group', 'aria-label': 'Voices' },
    consent.node,
    element('div', { class: 'row' }, ask, mute, leave),
    status,
    people.node,
  );
  return {
    node,
    show(state: VoicesState, round: ListedPeople | null): void {
      const { phase, microphoneMissing } = state;
      muted = state.muted;
      const isIn = phase === 'in';
      ask.hidden = phase !== 'off' && phase !== 'joining';
      ask.disabled = phase === 'joining';
      ask.textContent = phase === 'joining' ? 'Joining voice chat …' : 'Talk with the others';
      mute.hidden = !isIn || round?.seat === null;
      mute.textContent = microphoneMissing ? 'Find a microphone' : muted ? 'Unmute me (T)' : 'Mute me (T)';
      mute.classList.toggle('primary', isIn && !muted);
      mute.setAttribute('aria-pressed', String(!muted));
      leave.hidden = !isIn;
      const sentence = phase === 'none' ? '' : (state.message ?? (isIn && muted ? 'You are muted.' : ''));
      if (status.textContent !== sentence) status.textContent = sentence;
      status.hidden = sentence === '';
      consent.show(state);
      people.show(round, isIn);
      node.hidden = phase === 'none' && people.node.hidden;
    },
  };
}
