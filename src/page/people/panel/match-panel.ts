import type { HostedGame } from 'threepoint-rooms/room';
import { createInvitation, type Invitation } from 'threepoint-ui';
import type { ActivityPanel } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import type { MatchCamera } from '../match/match-camera';
import type { MatchPlay } from '../match/match-play';
import type { SeatedGame } from '../match/seated-game';
import type { BlockList } from '../voices/block-list';
import type { Voices } from '../voices/voices';
import { createMatchBar, type MatchBarActions, type MatchBarState } from './match-bar';
import type { MatchRound } from './match-round';

/** What the panel shows and acts on. */
export interface MatchControls {
  readonly game: SeatedGame<HostedGame>;
  readonly play: Pick<MatchPlay<HostedGame>, 'connection' | 'setOption'>;
  readonly voices: Voices;
  readonly blocked: BlockList;
  readonly camera: Pick<MatchCamera, 'follow'>;
  round(): MatchRound | null;
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

/** A match's part of the play bar: its buttons act on the match and on the page. */
class MatchPanel implements ActivityPanel {
  readonly node: HTMLElement;
  readonly #match: MatchControls;
  readonly #context: ActivityContext;
  readonly #bar: ReturnType<typeof createMatchBar>;
  #invitation: Invitation | null = null;

  constructor(match: MatchControls, context: ActivityContext) {
    this.#match = match;
    this.#context = context;
    this.#bar = createMatchBar(match.game, this.#actions(), (on) => context.setSound(on));
    this.node = this.#bar.node;
    if (location.hash !== invitingHash) return;
    history.replaceState(null, '', `${location.pathname}${location.search}`);
    this.#invite();
  }

  show(): void {
    if (!this.#context.study.run) void this.#context.server.whenKnown();
    this.#bar.show(this.#state(), this.#context.settings.sound);
  }

  #actions(): MatchBarActions {
    const { writer, notices, chooseInput, reopen } = this.#context;
    const { game, play, voices, blocked } = this.#match;
    return {
      ready: (on) => play.connection?.setReady(on),
      setOption: (on) => play.setOption?.(on),
      sit: (seat) => play.connection?.changeSeat(seat),
      setBots: (on) => writer.keep({ bots: on }),
      setName(name) {
        writer.keep({ name });
        notices.show('info', 'The other players will see your new name when you join a room again.');
      },
      openRoom: () => location.assign(`?play=${game.name}&room=${newRoomName()}${invitingHash}`),
      askServer: () => void this.#askServer(),
      invite: () => this.#invite(),
      rejoin: reopen,
      follow: (seat) => this.#match.camera.follow(seat),
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
    const { game } = this.#match;
    this.#invitation ??= createInvitation(game.name, game.roles.length);
    if (room) this.#invitation.open(room);
  }

  #state(): MatchBarState {
    const { settings, switches, headset, server } = this.#context;
    return {
      round: this.#match.round(),
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

export const createMatchPanel = (match: MatchControls, context: ActivityContext): ActivityPanel =>
  new MatchPanel(match, context);
