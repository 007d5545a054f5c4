import type { Object3D } from 'three';
import type { HostedGame } from 'threepoint-rooms/room';
import { disposeTree } from '../../scene/dispose-tree';
import type { Quality } from '../../scene/renderer';
import type { MatchFrame, SeatFrame } from '../match/match-frame';
import type { SeatedGame } from '../match/seated-game';
import type { SeatVoices } from '../voices/seat-voices';
import type { DisplayedMatch, DisplayedPlayer } from './displayed-match';
import { LobbySheet } from './lobby-sheet';
import { createNameLabels, type NameLabels } from './name-labels';

/** One frame of a match as people are shown in it. */
export interface PeopleScene<Game extends HostedGame>
  extends Pick<MatchFrame<Game>, 'state' | 'secondsLeft' | 'me' | 'players'> {
  /** The page's time [s], and whether it is connected to the room. */
  readonly pageTime: number;
  readonly inRoom: boolean;
  /** The user is ready without being asked. */
  readonly readyByItself: boolean;
  readonly voices: Pick<SeatVoices, 'markOf' | 'levelOf'>;
  /** The seats of the players that the user has hidden. */
  readonly hidden: ReadonlySet<number>;
  /** Whether a player's body is drawn, or would be if the user had not hidden it. Names appear with the bodies. */
  isThere(seat: number): boolean;
}

/** Picks what labels show of a player; a label is redrawn when any of it changes. */
const writtenOf = (player: SeatFrame | null): DisplayedPlayer | null =>
  player && {
    name: player.name,
    bot: player.bot,
    presence: player.presence,
    me: player.me,
    station: player.station,
  };

/** The lobby in front of the user, and the names over the heads of the others. */
export class PeopleView<Game extends HostedGame> {
  readonly lobby: LobbySheet<Game>;
  readonly #names: NameLabels;

  constructor(game: SeatedGame<Game>, quality: Quality) {
    this.lobby = new LobbySheet(game, quality);
    this.#names = createNameLabels(game.roles, quality);
  }

  /** The names, in the arena frame. */
  get names(): Object3D {
    return this.#names.object;
  }

  /** Shows a frame to eyes at this height [m]. Returns the match as boards show it. */
  show(scene: PeopleScene<Game>, eyeHeight: number): DisplayedMatch<Game['state']> {
    const { state, me, readyByItself } = scene;
    const players = scene.players.map(writtenOf);
    const match = { state, seconds: Math.ceil(scene.secondsLeft), players, me, readyByItself };
    this.lobby.show(match, eyeHeight, scene.pageTime, scene.inRoom);
    this.#showNames(scene, players);
    return match;
  }

  dispose(): void {
    disposeTree(this.lobby.object);
    disposeTree(this.#names.object);
  }

  #showNames(
    { players, voices, hidden, isThere }: PeopleScene<Game>,
    people: readonly (DisplayedPlayer | null)[],
  ): void {
    this.#names.show(
      players.map((player, seat) => {
        const person = people[seat];
        if (!player?.head || !person || person.me || hidden.has(seat) || !isThere(seat)) return null;
        const { head, opacity } = player;
        return { person, head, opacity, voice: voices.markOf(seat), level: voices.levelOf(seat) };
      }),
    );
  }
}
