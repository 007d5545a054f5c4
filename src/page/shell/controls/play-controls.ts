import { pageElement } from 'threepoint-ui/element';
import { createInvitation, type Invitation } from 'threepoint-ui/invitation';
import type { BallBarActions, BallBarState } from '../../ball/ball-bar';
import { createPlayBar, type PlayActions, type PlayBar, type PlayState, type Shooter } from '../play-bar';
import type { ControlledParts } from './controlled-parts';

export type PlayControlsOptions = Pick<
  ControlledParts,
  'switches' | 'settings' | 'writer' | 'notices' | 'headset' | 'recorder' | 'activities' | 'study' | 'server'
>;

/** Of an address that has just opened a room for others. */
const invitingHash = '#invite';
const roomLetters = 'abcdefghjkmnpqrstuvwxyz';
const roomNameLength = 6;

/** A name that no room has yet. */
function newRoomName(): string {
  const random = crypto.getRandomValues(new Uint8Array(roomNameLength));
  return Array.from(random, (byte) => roomLetters[byte % roomLetters.length]).join('');
}

/** What to do here, the score and settings of a round beside the picture, and what to know of the connection to others. */
export class PlayControls {
  readonly #options: PlayControlsOptions;
  readonly #bar: PlayBar;
  readonly #banner = pageElement('banner', HTMLElement);
  #invitation: Invitation | null = null;

  constructor(options: PlayControlsOptions) {
    this.#options = options;
    this.#bar = createPlayBar(pageElement('play', HTMLElement), this.#actions());
    if (location.hash !== invitingHash) return;
    history.replaceState(null, '', `${location.pathname}${location.search}`);
    this.#invite();
  }

  /** What is heard, in words. */
  caption(text: string): void {
    this.#bar.caption(text);
  }

  show(): void {
    const { activities, study, server } = this.#options;
    if (activities.ball && !study.run) void server.known();
    this.#bar.show(this.#state());
  }

  /** What a person should know of the connection to others. */
  showBanner(): void {
    const text = this.#options.activities.ball?.banner() ?? '';
    if (this.#banner.textContent === text) return;
    this.#banner.textContent = text;
    this.#banner.hidden = text === '';
  }

  #actions(): PlayActions {
    const { activities } = this.#options;
    return {
      goTo: (activity) => void activities.goTo(activity),
      restart: () => activities.restartRound(),
      chooseShooter: (shooter) => activities.chooseShooter(shooter),
      setBowSide: (side) => activities.rule({ bowSide: side }),
      setOneHanded: (on) => activities.rule({ oneHanded: on }),
      setEveryHitCounts: (on) => activities.rule({ everyHitCounts: on }),
      setSound: (on) => activities.setSound(on),
      ball: this.#ballActions(),
    };
  }

  #ballActions(): BallBarActions {
    const { activities, writer, notices } = this.#options;
    return {
      ready: (on) => activities.ball?.play.ready(on),
      rotate: (on) => activities.ball?.play.rotate(on),
      sit: (seat) => activities.ball?.play.sit(seat),
      setBots: (on) => writer.keep({ bots: on }),
      setName(name) {
        writer.keep({ name });
        notices.show('info', 'The others see your new name when you join the next time.');
      },
      openRoom: () => location.assign(`?play=ball&room=${newRoomName()}${invitingHash}`),
      askServer: () => void this.#askServer(),
      invite: () => this.#invite(),
      rejoin: () => void activities.rejoin(),
      follow: (seat) => activities.follow(seat),
      steer: (on) => activities.chooseShooter(on ? 'mouse' : 'actor'),
      voices: {
        ask: (on) => activities.ball?.voices.ask(on),
        join: () => void activities.ball?.voices.join(),
        leave: () => activities.ball?.voices.leave(),
        mute: (on) => void activities.ball?.voices.setMuted(on),
        relayOnly: (on) => writer.keep({ voicesByRelay: on }),
        silence: (seat, on) => activities.ball?.voices.silence(seat, on),
        hide: (seat, on) => activities.ball?.voices.hide(seat, on),
      },
    };
  }

  /** A server that is found takes this page into the room of its address. */
  async #askServer(): Promise<void> {
    const { server, switches, activities } = this.#options;
    const { state: before } = server;
    if ((await server.ask()) === 'here' && before === 'none' && switches.room) await activities.rejoin();
  }

  #invite(): void {
    const { room } = this.#options.switches;
    this.#invitation ??= createInvitation();
    if (room) this.#invitation.open(room);
  }

  #state(): PlayState {
    const { settings, headset, activities } = this.#options;
    return {
      activity: activities.name,
      arriving: activities.arriving,
      ball: this.#ballState(),
      round: activities.archery?.round() ?? null,
      shooter: this.#shooter(),
      bowSide: settings.bowSide,
      oneHanded: settings.oneHanded,
      everyHitCounts: settings.everyHitCounts,
      sound: settings.sound,
      inSession: headset.worn,
    };
  }

  #ballState(): BallBarState | null {
    const { settings, switches, headset, activities, server } = this.#options;
    if (!activities.ball) return null;
    return {
      round: activities.ball.round(),
      room: server.state === 'none' ? null : switches.room,
      server: server.state,
      bots: settings.bots,
      acting: settings.actor && !settings.mouse && !headset.worn,
      mouse: headset.worn || !settings.actor ? null : settings.mouse,
      name: settings.name,
      guestName: settings.guestName,
      following: settings.following,
    };
  }

  #shooter(): Shooter {
    const { settings, headset, recorder } = this.#options;
    if (!headset.worn && recorder.mode === 'replaying') return 'recording';
    if (headset.worn || !settings.actor) return 'headset';
    return settings.mouse ? 'mouse' : 'actor';
  }
}
