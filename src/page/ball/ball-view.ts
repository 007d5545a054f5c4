import type { Group } from 'three';
import { invertTransform, type Pose, type Transform, transformPoint } from 'threepoint/math';
import { type BallCue, type BallEvent, type BallState, stations } from 'threepoint-games/ball';
import type { DisplayedMatch, DisplayedPlayer } from '../people/view/displayed-match';
import { createLobbySheet, type LobbySheet } from '../people/view/lobby-sheet';
import { createNameLabels, type NameLabels } from '../people/view/name-labels';
import type { SeatVoices } from '../people/voices/seat-voices';
import { disposeTree } from '../scene/dispose-tree';
import type { Quality } from '../scene/renderer';
import type { AudibleStage } from '../scene/sound/sound-stage';
import type { Surroundings } from '../scene/surroundings';
import { type Court, createCourt } from './court/court';
import { createZoneRing } from './court/zone-ring';
import type { BallFrame, PlayerFrame } from './match/ball-frame';
import { BallSounds } from './sound/ball-sounds';
import { createAimArc } from './view/aim-arc';
import { Balls } from './view/balls';
import { type Boards, createBoards } from './view/boards';
import { CatchPopups } from './view/catch-popups';
import { eventLine, waitingLine } from './view/match-texts';
import { createWickerBasket } from './view/wicker-basket';

/** A player at the court as they are drawn in this frame. */
export type DrawnPlayer = DisplayedPlayer & Pick<PlayerFrame, 'head' | 'palms' | 'opacity'>;

/** One frame of a match as it is drawn. */
export interface BallScene
  extends Pick<BallFrame, 'state' | 'time' | 'secondsLeft' | 'me' | 'opening' | 'aim' | 'paused'> {
  /** By player; null: the seat is free. */
  readonly attendants: readonly (DrawnPlayer | null)[];
  /** The page's time [s], and whether it is still in the room. */
  readonly pageTime: number;
  readonly inRoom: boolean;
  /** A simulated player has the user's seat. */
  readonly acting: boolean;
  readonly voices: Pick<SeatVoices, 'markOf' | 'levelOf'>;
  /** The seats of the players that the user has hidden. */
  readonly hidden: ReadonlySet<number>;
  /** The viewer's eyes and ears, floor frame of the user. */
  readonly head: Pose<'floor'>;
}

export interface BallViewOptions {
  readonly quality: Quality;
  readonly balls: number;
  /** Every sound in words, with its direction. */
  readonly onCaption: (text: string) => void;
}

/** The last sentence stays on the board this long [s]. */
const lineSeconds = 3;

const origin: Transform<'floor', 'arena'> = {
  position: { x: 0, y: 0, z: 0 },
  orientation: { x: 0, y: 0, z: 0, w: 1 },
};
const unseenPalms: DrawnPlayer['palms'] = { left: null, right: null };

/** Picks what labels show of a player; a label is redrawn when any of it changes. */
const writtenOf = (attendant: DrawnPlayer | null): DisplayedPlayer | null =>
  attendant && {
    name: attendant.name,
    bot: attendant.bot,
    presence: attendant.presence,
    me: attendant.me,
    station: attendant.station,
  };

const stationOf = ({ players }: BallState, me: number | null): number | null =>
  me === null ? null : (players[me]?.station ?? null);

/** The view of the ball game without the players' bodies. */
export class BallView {
  /** The parts in the user's floor frame, to be added to the scene. */
  readonly own: Group;
  readonly lobby: LobbySheet;
  readonly sound: AudibleStage;
  readonly #sounds: BallSounds;
  readonly #court: Court;
  readonly #balls: Balls;
  readonly #basket = createWickerBasket();
  readonly #boards: Boards;
  readonly #pops: CatchPopups;
  readonly #names: NameLabels;
  readonly #ring = createZoneRing();
  readonly #arc = createAimArc();
  #floorFromArena = origin;
  #shown: BallScene | null = null;
  /** The line of the last event, and the page time until which the board shows it [s]. */
  #line = { text: '', until: Number.NEGATIVE_INFINITY };

  constructor({ quality, balls, onCaption }: BallViewOptions) {
    this.#court = createCourt(quality, balls);
    this.#balls = new Balls(balls, quality);
    this.#boards = createBoards(quality);
    this.#pops = new CatchPopups(quality);
    this.#names = createNameLabels(stations.length, quality);
    this.lobby = createLobbySheet(quality);
    this.own = this.lobby.object;
    this.#sounds = new BallSounds(onCaption);
    this.sound = this.#sounds.stage;
    const standing = [this.#balls, this.#basket, this.#boards, this.#pops, this.#names];
    this.#court.object.add(...standing.map(({ object }) => object), this.#ring.mesh, this.#arc.object);
  }

  /** Returns the court for the user's floor frame. Call it again after a change of the seat. */
  placed(floorFromArena: Transform<'floor', 'arena'>): Surroundings {
    this.#floorFromArena = floorFromArena;
    return this.#court.placed(floorFromArena);
  }

  /** Shows or hides the boards. A phone's window is covered by the bar, which has their figures. */
  showBoards(visible: boolean): void {
    this.#boards.object.visible = visible;
  }

  show(scene: BallScene): void {
    this.#shown = scene;
    const { state, attendants, me, head, acting, pageTime } = scene;
    const eyes = transformPoint(invertTransform(this.#floorFromArena), head.position);
    this.#sounds.setListener(head, this.#floorFromArena);
    this.#showBalls(scene);
    this.#pops.show(pageTime, eyes);
    const players = attendants.map(writtenOf);
    const standing: DisplayedMatch = { state, seconds: Math.ceil(scene.secondsLeft), players, me, acting };
    this.#boards.show(standing, scene.paused ? 'Paused' : this.#lineNow(standing, pageTime));
    this.lobby.show(standing, head.position.y, pageTime, scene.inRoom);
    this.#showNames(scene, players);
    const station = stationOf(state, me);
    this.#ring.show(station === null ? null : (stations[station]?.position ?? null), eyes);
  }

  /** Plays and captions the events since the last frame, and writes them on the board. Call it after `show`. */
  playEvents(events: readonly BallEvent[], cues: readonly BallCue[]): void {
    if (!this.#shown) return;
    const { state, pageTime, attendants: people, me, opening } = this.#shown;
    for (const event of events) {
      const text = eventLine(event, people);
      if (text) this.#line = { text, until: pageTime + lineSeconds };
      if (event.type === 'caught') this.#pops.add((opening ?? state.basket).position, pageTime);
    }
    const mine = me === null ? null : people[me];
    this.#sounds.playEvents({ state, events, cues, me, people, palms: mine?.palms ?? unseenPalms });
  }

  dispose(): void {
    this.#sounds.dispose();
    disposeTree(this.own);
    disposeTree(this.#court.object);
  }

  #showBalls({ state, time, attendants, opening: held, aim }: BallScene): void {
    const opening = held ?? state.basket;
    this.#basket.show(opening);
    this.#arc.show(aim, opening);
    this.#balls.show(state, time, (player, side) => attendants[player]?.palms[side] ?? null, opening);
  }

  /** Returns the line of the board: the last event, or what the match waits for. */
  #lineNow(standing: DisplayedMatch, pageTime: number): string {
    const { text, until } = this.#line;
    return pageTime < until && standing.state.phase === 'running' ? text : waitingLine(standing);
  }

  #showNames({ attendants, voices, hidden }: BallScene, people: readonly (DisplayedPlayer | null)[]): void {
    this.#names.show(
      attendants.map((attendant, player) => {
        const person = people[player];
        if (!attendant?.head || !person || person.me || hidden.has(player)) return null;
        const { head, opacity } = attendant;
        return { person, head, opacity, voice: voices.markOf(player), level: voices.levelOf(player) };
      }),
    );
  }
}
