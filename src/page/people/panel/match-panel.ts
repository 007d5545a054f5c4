import { createInvitation, type Invitation } from 'threepoint-ui';
import type { ActivityPanel } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import type { BallPlay } from '../../ball/match/ball-play';
import type { CourtCamera } from '../match/match-camera';
import type { BlockList } from '../voices/block-list';
import type { Voices } from '../voices/voices';
import { type BallBarActions, type BallBarState, createBallBar } from './match-bar';
import type { BallRound } from './match-round';

/** What the panel shows and acts on. */
export interface CourtControls {
  readonly play: Pick<BallPlay, 'ready' | 'rotate' | 'sit'>;
  readonly voices: Voices;
  readonly blocked: BlockList;
  readonly camera: Pick<CourtCamera, 'follow'>;
  round(): BallRound | null;
}

/** The fragment of an address that opens a new room and its invitation. */
const invitingHash = '#invite';
const roomLetters = 'abcdefghjkmnpqrstuvwxyz';
const roomNameLength = 6;

/** Returns a random room name. */
function newRoomName(): string {
  const random = crypto.getRandomValues(new Uint8Array(roomNameLength));
  return Array.from(random, (byte) => roomLetters[byte % roomLetters.length]).join('');
}

/** The ball game's part of the play bar: its buttons act on the court and on the page. */
class BallPanel implements ActivityPanel {
  readonly node: HTMLElement;
  readonly #court: CourtControls;
  readonly #context: ActivityContext;
  readonly #bar: ReturnType<typeof createBallBar>;
  #invitation: Invitation | null = null;

  constructor(court: CourtControls, context: ActivityContext) {
    this.#court = court;
    this.#context = context;
    this.#bar = createBallBar(this.#actions(), (on) => context.setSound(on));
    this.node = this.#bar.node;
    if (location.hash !== invitingHash) return;
    history.replaceState(null, '', `${location.pathname}${location.search}`);
    this.#invite();
  }

  show(): void {
    if (!this.#context.study.run) void this.#context.server.whenKnown();
    this.#bar.show(this.#state(), this.#context.settings.sound);
  }

  #actions(): BallBarActions {
    const { writer, notices, chooseInput, reopen } = this.#context;
    const { play, voices, blocked } = this.#court;
    return {
      ready: (on) => play.ready(on),
      rotate: (on) => play.rotate(on),
      sit: (seat) => play.sit(seat),
      setBots: (on) => writer.keep({ bots: on }),
      setName(name) {
        writer.keep({ name });
        notices.show('info', 'The other players will see your new name when you join a room again.');
      },
      openRoom: () => location.assign(`?play=ball&room=${newRoomName()}${invitingHash}`),
      askServer: () => void this.#askServer(),
      invite: () => this.#invite(),
      rejoin: reopen,
      follow: (seat) => this.#court.camera.follow(seat),
      steer: (on) => chooseInput(on ? 'mouse' : 'actor'),
      voices: {
        ask: (on) => voices.ask(on),
        join: () => void voices.join(),
        leave: () => voices.leave(),
        mute: (on) => void voices.setMuted(on),
        relayOnly: (on) => writer.keep({ voicesByRelay: on }),
        silence: (seat, on) => blocked.set('silenced', seat, on),
        hide: (seat, on) => blocked.set('hidden', seat, on),
      },
    };
  }

  /** Asks again whether there is a server. If there is one now, joins the room of the address. */
  async #askServer(): Promise<void> {
    const { server, switches, reopen } = this.#context;
    const { state: before } = server;
    if ((await server.refresh()) === 'here' && before === 'none' && switches.room) reopen();
  }

  #invite(): void {
    const { room } = this.#context.switches;
    this.#invitation ??= createInvitation();
    if (room) this.#invitation.open(room);
  }

  #state(): BallBarState {
    const { settings, switches, headset, server } = this.#context;
    return {
      round: this.#court.round(),
      room: server.state === 'none' ? null : switches.room,
      server: server.state,
      bots: settings.bots,
      acting: settings.actor && !settings.mouse && !headset.worn,
      mouse: headset.worn || !settings.actor ? null : settings.mouse,
      name: settings.name,
      defaultName: settings.defaultName,
      following: settings.following,
    };
  }
}

export const createBallPanel = (court: CourtControls, context: ActivityContext): ActivityPanel =>
  new BallPanel(court, context);
