import type { HostedGame } from 'threepoint-rooms/room';
import { showInvitation } from 'threepoint-ui';
import type { ActivityPanel } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import type { MatchCamera } from '../match/match-camera';
import type { MatchPlay } from '../match/match-play';
import type { SeatedGame } from '../match/seated-game';
import type { BlockList } from '../voices/block-list';
import type { Voices } from '../voices/voices';
import { MatchBar, type MatchBarActions, type MatchBarState } from './match-bar';
import type { MatchRound } from './match-round';

/** What the panel shows and acts on. */
export interface MatchControls {
  readonly game: SeatedGame<HostedGame>;
  readonly play: Pick<MatchPlay<HostedGame>, 'connection' | 'setOption'>;
  readonly voices: Voices;
  readonly blocked: BlockList;
  readonly camera: Pick<MatchCamera, 'follow'>;
  round(): MatchRound | null;
  readyByItself(): boolean;
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

/** Asks again whether there is a server. If there is one now, joins the room of the address. */
async function askServer({ server, switches, reopen }: ActivityContext): Promise<void> {
  const { state: before } = server;
  if ((await server.refresh()) === 'here' && before === 'none' && switches.room) reopen();
}

/** The actions of the bar on the match and on the page. */
function barActions({ game, play, voices, blocked, camera }: MatchControls, context: ActivityContext): MatchBarActions {
  const { writer, notices, chooseInput, reopen, switches } = context;
  return {
    ready: (on) => play.connection?.setReady(on),
    setOption: (on) => play.setOption?.(on),
    sit: (seat) => play.connection?.changeSeat(seat),
    setBots: (on) => writer.keep({ bots: on }),
    setSound: (on) => context.setSound(on),
    setName(name) {
      writer.keep({ name });
      notices.show('info', 'The other players will see your new name when you join a room again.');
    },
    openRoom: () => location.assign(`?play=${game.name}&room=${newRoomName()}${invitingHash}`),
    askServer: () => void askServer(context),
    invite() {
      if (switches.room) showInvitation(game.name, game.roles.length, switches.room);
    },
    rejoin: reopen,
    follow: (seat) => camera.follow(seat),
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

function barState(match: MatchControls, { settings, switches, headset, server }: ActivityContext): MatchBarState {
  return {
    round: match.round(),
    room: server.state === 'none' ? null : switches.room,
    server: server.state,
    bots: settings.bots,
    sound: settings.sound,
    readyByItself: match.readyByItself(),
    mouse: headset.worn || !settings.actor ? null : settings.mouse,
    name: settings.name,
    defaultName: settings.defaultName,
    following: settings.following,
  };
}

/** Creates a match's part of the play bar: its buttons act on the match and on the page. */
export function createMatchPanel(match: MatchControls, context: ActivityContext): ActivityPanel {
  const actions = barActions(match, context);
  if (location.hash === invitingHash) {
    history.replaceState(null, '', `${location.pathname}${location.search}`);
    actions.invite();
  }
  return () => {
    if (!context.study.run) void context.server.whenKnown();
    return <MatchBar game={match.game} actions={actions} state={barState(match, context)} />;
  };
}
