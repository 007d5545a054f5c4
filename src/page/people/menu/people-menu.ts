import type { RoomClient } from 'threepoint-rooms';
import type { HostedGame } from 'threepoint-rooms/room';
import { linkTo, qrCode } from 'threepoint-ui';
import type { ActivityContext } from '../../activity/activity-context';
import type { ActivityMenu, MenuEntry } from '../../activity/activity-menu';
import type { SeatedGame } from '../match/seated-game';
import type { MatchRound } from '../panel/match-round';
import { type OtherPlayer, otherPlayers } from '../panel/other-players';
import type { BlockList } from '../voices/block-list';
import type { Voices } from '../voices/voices';
import { consentText, type VoicesState } from '../voices/voices-state';
import { invitationSheet, type ShownInvitation } from './invitation-sheet';
import { playersSheet } from './players-sheet';

export interface PeopleMenuState {
  /** Before and after a match, whether the user is ready; null: the user is not asked. */
  readonly ready: boolean | null;
  readonly plainOthers: boolean;
  readonly others: readonly OtherPlayer[];
  /** Other people can join this room. */
  readonly canInvite: boolean;
  readonly voices: Pick<VoicesState, 'phase' | 'muted' | 'microphoneMissing'>;
}

export interface PeopleMenuActions {
  ready(on: boolean): void;
  setPlainOthers(on: boolean): void;
  listOthers(): void;
  invite(): void;
  /** Shows or hides the consent text of voices. */
  askVoices(on: boolean): void;
  joinVoices(): void;
  mute(on: boolean): void;
}

function voiceEntries(
  { voices: { phase, muted, microphoneMissing } }: PeopleMenuState,
  actions: PeopleMenuActions,
): MenuEntry[] {
  switch (phase) {
    case 'off':
      return [{ id: 'voices', label: 'Talk', act: () => actions.askVoices(true) }];
    case 'asked':
      return [
        { id: 'voices', label: 'Join, muted', act: () => actions.joinVoices() },
        { id: 'no-voices', label: 'Not now', act: () => actions.askVoices(false) },
      ];
    case 'in': {
      const label = microphoneMissing ? 'No microphone' : muted ? 'Unmute me' : 'Mute me';
      return [{ id: 'voices', label, act: () => actions.mute(!muted) }];
    }
    default:
      return [];
  }
}

/** Returns a match's buttons of the menu in the headset. */
export function peopleEntries(state: PeopleMenuState, actions: PeopleMenuActions): readonly MenuEntry[] {
  const { ready, plainOthers, others, canInvite, voices } = state;
  const entries: MenuEntry[] = [];
  if (ready !== null)
    entries.push({ id: 'ready', label: ready ? 'Wait for me' : 'Ready', act: () => actions.ready(!ready) });
  // The user reads the consent text first: there is nothing else to press.
  if (voices.phase !== 'asked') {
    const label = `Others: ${plainOthers ? 'plain' : 'as worn'}`;
    entries.push({ id: 'others', label, act: () => actions.setPlainOthers(!plainOthers) });
    if (others.length > 0) entries.push({ id: 'players', label: 'Players', act: () => actions.listOthers() });
    if (canInvite) entries.push({ id: 'invite', label: 'Invite', act: () => actions.invite() });
  }
  return [...entries, ...voiceEntries(state, actions)];
}

/** What the menu shows and acts on. */
export interface MenuMatch {
  readonly game: Pick<SeatedGame<HostedGame>, 'name'>;
  readonly play: Pick<RoomClient<HostedGame>, 'connection'>;
  readonly voices: Voices;
  readonly blocked: BlockList;
  round(): MatchRound | null;
  banner(): string | null;
}

/** A match's part of the menu in the headset. */
export class PeopleMenu {
  readonly #match: MenuMatch;
  readonly #context: ActivityContext;
  #invitation: ShownInvitation | null = null;
  /** The list of players replaces the menu. */
  #listed = false;

  constructor(match: MenuMatch, context: ActivityContext) {
    this.#match = match;
    this.#context = context;
  }

  /** Closes the list of players and the invitation. */
  close(): void {
    this.#invitation = null;
    this.#listed = false;
  }

  state(): ActivityMenu {
    const { settings } = this.#context;
    const match = this.#match;
    const round = match.round();
    const { phase, muted, microphoneMissing, message } = match.voices.state;
    const isAsked = round !== null && round.ended === null && round.seat !== null && round.phase !== 'running';
    const others = round ? otherPlayers(round, phase === 'in') : [];
    const canInvite = this.#openRoom() !== null;
    const state: PeopleMenuState = {
      ready: isAsked ? round.ready : null,
      plainOthers: settings.plainOthers,
      others,
      canInvite,
      voices: { phase, muted, microphoneMissing },
    };
    return {
      entries: peopleEntries(state, this.#actions()),
      sheet: this.#sheet(canInvite, round === null ? null : others),
      notice: (phase === 'asked' ? consentText : message) ?? match.banner(),
      hint: round?.waiting ?? round?.connection ?? null,
    };
  }

  #sheet(canInvite: boolean, others: readonly OtherPlayer[] | null): ActivityMenu['sheet'] {
    const close = () =>
      this.#change(() => {
        this.close();
      });
    if (canInvite && this.#invitation) return invitationSheet(this.#invitation, close);
    if (!this.#listed || others === null) return null;
    const { blocked } = this.#match;
    return playersSheet(others, {
      silence: (seat, on) => this.#change(() => blocked.set('silenced', seat, on)),
      hide: (seat, on) => this.#change(() => blocked.set('hidden', seat, on)),
      close,
    });
  }

  #actions(): PeopleMenuActions {
    const { writer } = this.#context;
    const { play, voices } = this.#match;
    return {
      ready: (on) => play.connection?.setReady(on),
      setPlainOthers: (plainOthers) => writer.keep({ plainOthers }),
      listOthers: () =>
        this.#change(() => {
          this.#listed = true;
        }),
      invite: () => this.#invite(),
      askVoices: (on) => voices.ask(on),
      joinVoices: () => void voices.join(),
      mute: (on) => void voices.setMuted(on),
    };
  }

  /** The room that other people can join; null: it is in this page. */
  #openRoom(): string | null {
    const { switches, server } = this.#context;
    return server.state === 'none' ? null : switches.room;
  }

  /** Shows the effect of a press at once, not with the next periodic update. */
  #change(act: () => void): void {
    act();
    this.#context.onChange();
  }

  #invite(): void {
    const room = this.#openRoom();
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
