import { linkTo, qrCode } from 'threepoint-ui';
import type { ActivityContext } from '../../activity/activity-context';
import type { ActivityMenu, MenuEntry } from '../../activity/activity-menu';
import { type ControlledMatch, sharedRoom } from '../panel/match-controls';
import type { MatchRound } from '../panel/match-round';
import { type OtherPlayer, otherPlayers } from '../panel/other-players';
import type { Voices } from '../voices/voices';
import { consentText } from '../voices/voices-state';
import { invitationSheet, type ShownInvitation } from './invitation-sheet';
import { playersSheet } from './players-sheet';

function voiceEntries(voices: Voices): MenuEntry[] {
  const { phase, muted, microphoneMissing } = voices.state;
  switch (phase) {
    case 'off':
      return [{ id: 'voices', label: 'Talk', act: () => voices.ask(true) }];
    case 'asked':
      return [
        { id: 'voices', label: 'Join, muted', act: () => void voices.join() },
        { id: 'no-voices', label: 'Not now', act: () => voices.ask(false) },
      ];
    case 'in': {
      const label = microphoneMissing ? 'No microphone' : muted ? 'Unmute me' : 'Mute me';
      return [{ id: 'voices', label, act: () => void voices.setMuted(!muted) }];
    }
    default:
      return [];
  }
}

/** A match's part of the menu in the headset. */
export class PeopleMenu {
  readonly #match: ControlledMatch;
  readonly #context: ActivityContext;
  #invitation: ShownInvitation | null = null;
  /** The list of players replaces the menu. */
  #listed = false;

  constructor(match: ControlledMatch, context: ActivityContext) {
    this.#match = match;
    this.#context = context;
  }

  /** Closes the list of players and the invitation. */
  close(): void {
    this.#invitation = null;
    this.#listed = false;
  }

  state(): ActivityMenu {
    const match = this.#match;
    const round = match.round();
    const { phase, message } = match.voices.state;
    const others = round && otherPlayers(round, phase === 'in');
    return {
      entries: this.#entries(round, others),
      sheet: this.#sheet(others),
      notice: (phase === 'asked' ? consentText : message) ?? match.banner(),
      hint: round?.waiting ?? round?.connection ?? null,
    };
  }

  #entries(round: MatchRound | null, others: readonly OtherPlayer[] | null): readonly MenuEntry[] {
    const { play, voices } = this.#match;
    const { settings, writer } = this.#context;
    const entries: MenuEntry[] = [];
    if (round?.joined && round.seat !== null && round.phase !== 'running') {
      const { ready } = round;
      const label = ready ? 'Wait for me' : 'Ready';
      entries.push({ id: 'ready', label, act: () => play.connection?.setReady(!ready) });
    }
    // The user reads the consent text first: there is nothing else to press.
    if (voices.state.phase !== 'asked') {
      const { plainOthers } = settings;
      const label = `Others: ${plainOthers ? 'mannequins' : 'avatars'}`;
      entries.push({ id: 'others', label, act: () => writer.keep({ plainOthers: !plainOthers }) });
      if (others && others.length > 0) entries.push({ id: 'players', label: 'Players', act: () => this.#list() });
      if (sharedRoom(this.#context)) entries.push({ id: 'invite', label: 'Invite', act: () => this.#invite() });
    }
    return [...entries, ...voiceEntries(voices)];
  }

  #sheet(others: readonly OtherPlayer[] | null): ActivityMenu['sheet'] {
    const close = () => this.#change(() => this.close());
    if (this.#invitation && sharedRoom(this.#context)) return invitationSheet(this.#invitation, close);
    if (!this.#listed || others === null) return null;
    const { blocked } = this.#match;
    return playersSheet(others, {
      silence: (seat, on) => this.#change(() => blocked.set('silenced', seat, on)),
      hide: (seat, on) => this.#change(() => blocked.set('hidden', seat, on)),
      close,
    });
  }

  #list(): void {
    this.#change(() => {
      this.#listed = true;
    });
  }

  /** Shows the effect of a press at once, not with the next periodic update. */
  #change(act: () => void): void {
    act();
    this.#context.onChange();
  }

  #invite(): void {
    const room = sharedRoom(this.#context);
    if (room === null) return;
    const link = linkTo(this.#match.game.name, room);
    const show = (code: ShownInvitation['code']) =>
      this.#change(() => {
        this.#invitation = { ...link, code };
      });
    const finish = (code: ShownInvitation['code']) => {
      if (this.#invitation?.code === 'loading') show(code);
    };
    show('loading');
    qrCode(link.address).then(finish, () => finish('failed'));
  }
}
