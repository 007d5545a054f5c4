import type { HostedGame } from 'threepoint-rooms/room';
import { showInvitation } from 'threepoint-ui';
import type { ActivityContext } from '../../activity/activity-context';
import type { MatchCamera } from '../match/match-camera';
import type { MatchPlay } from '../match/match-play';
import type { SeatedGame } from '../match/seated-game';
import type { BlockList } from '../voices/block-list';
import type { Voices } from '../voices/voices';
import type { MatchRound } from './match-round';

/** The match that the play bar and the menu in the headset show and act on. */
export interface ControlledMatch {
  readonly game: SeatedGame<HostedGame>;
  readonly play: Pick<MatchPlay<HostedGame>, 'connection' | 'setOption'>;
  readonly voices: Voices;
  readonly blocked: BlockList;
  readonly camera: Pick<MatchCamera, 'follow'>;
  /** null: not in the room yet. */
  round(): MatchRound | null;
  /** The user is ready without being asked. */
  readyByItself(): boolean;
  banner(): string | null;
}

/** The fragment of an address that opens a new room and its invitation. */
export const invitingHash = '#invite';
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

/** Returns the room that other people can join; null: it is in this page alone. */
export const sharedRoom = ({ server, switches }: ActivityContext): string | null =>
  server.state === 'none' ? null : switches.room;

/** The actions of the bar on the match and on the page. */
export function barActions({ game, play, voices, blocked, camera }: ControlledMatch, context: ActivityContext) {
  const { writer, notices, chooseInput, reopen, switches } = context;
  return {
    ready: (on: boolean) => play.connection?.setReady(on),
    setOption: (on: boolean) => play.setOption?.(on),
    sit: (seat: number | null) => play.connection?.changeSeat(seat),
    setBots: (on: boolean) => writer.keep({ bots: on }),
    setSound: (on: boolean) => context.setSound(on),
    setName(name: string) {
      writer.keep({ name });
      notices.show('info', 'The other players will see your new name when you join a room again.');
    },
    /** Opens a room that other people can join. */
    openRoom: () => location.assign(`?play=${game.name}&room=${newRoomName()}${invitingHash}`),
    askServer: () => void askServer(context),
    /** Shows the invitation to this room. */
    invite() {
      if (switches.room) showInvitation(game.name, game.roles.length, switches.room);
    },
    /** Rejoins the room that this page is no longer in. */
    rejoin: reopen,
    /** The camera of a spectator: with a player, or null: free. */
    follow: (seat: number | null) => camera.follow(seat),
    /** Lets the mouse or the simulated player move the user's body. */
    steer: (on: boolean) => chooseInput(on ? 'mouse' : 'actor'),
    voices: {
      ask: (on: boolean) => voices.ask(on),
      join: () => void voices.join(),
      leave: () => voices.leave(),
      mute: (on: boolean) => void voices.setMuted(on),
      relayOnly: (on: boolean) => writer.keep({ voicesByRelay: on }),
      /** Stops or resumes playing the voice of a player. */
      silence: (seat: number, on: boolean) => blocked.set('silenced', seat, on),
      /** Hides a player and their voice, or shows them again. */
      hide: (seat: number, on: boolean) => blocked.set('hidden', seat, on),
    },
  };
}

export type MatchBarActions = ReturnType<typeof barActions>;

/** Returns a match as the bar shows it. */
export function barState(match: ControlledMatch, context: ActivityContext) {
  const { settings, headset, server } = context;
  return {
    round: match.round(),
    room: sharedRoom(context),
    server: server.state,
    bots: settings.bots,
    sound: settings.sound,
    readyByItself: match.readyByItself(),
    /** The mouse moves the user's body; null: it cannot, because a headset is worn or an emulated one is steered. */
    mouse: headset.worn || !settings.actor ? null : settings.mouse,
    name: settings.name,
    /** The name that others see if the player gave none. */
    defaultName: settings.defaultName,
    /** The seat that a spectator's camera follows; null: the camera is free. */
    following: settings.following,
  };
}

export type MatchBarState = ReturnType<typeof barState>;
