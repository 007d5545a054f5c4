import type { GazeTargets } from 'threepoint/internal/three';
import { invertTransform, type Pose, type Transform, transformPoint } from 'threepoint/math';
import { type BallEvent, type BallGame, type BallState, stations } from 'threepoint-games/ball';
import type { DisplayedMatch } from '../people/view/displayed-match';
import { type PeopleScene, PeopleView } from '../people/view/people-view';
import { disposeTree } from '../scene/dispose-tree';
import type { Quality } from '../scene/renderer';
import type { AudibleStage } from '../scene/sound/sound-stage';
import type { Surroundings } from '../scene/surroundings';
import { ballGame } from './ball-game';
import { type Court, createCourt } from './court/court';
import { createZoneRing } from './court/zone-ring';
import type { BallFrame, Palms } from './match/ball-frame';
import { BallSounds } from './sound/ball-sounds';
import { createAimArc } from './view/aim-arc';
import { Balls, type InHand } from './view/balls';
import { type Boards, createBoards } from './view/boards';
import { CatchPopups } from './view/catch-popups';
import { eventLine, waitingLine } from './view/match-texts';
import { createWickerBasket } from './view/wicker-basket';

/** One frame of a match as it is drawn. */
export interface BallScene
  extends PeopleScene<BallGame>,
    Pick<BallFrame, 'time' | 'palms' | 'opening' | 'aim' | 'paused'> {
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
const unseenPalms: Palms = { left: null, right: null };

/** The view of the ball game without the players' bodies. */
export class BallView {
  readonly people: PeopleView<BallGame>;
  readonly sound: AudibleStage;
  readonly #sounds: BallSounds;
  readonly #court: Court;
  readonly #balls: Balls;
  readonly #basket = createWickerBasket();
  readonly #boards: Boards;
  readonly #pops: CatchPopups;
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
    this.people = new PeopleView(ballGame, quality);
    this.#sounds = new BallSounds(onCaption);
    this.sound = this.#sounds.stage;
    this.#basket.object.visible = false;
    const standing = [this.#balls, this.#basket, this.#boards, this.#pops];
    this.#court.object.add(
      ...standing.map(({ object }) => object),
      this.people.names,
      this.#ring.mesh,
      this.#arc.object,
    );
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
    const { state, me, head, pageTime } = scene;
    const eyes = transformPoint(invertTransform(this.#floorFromArena), head.position);
    this.#sounds.setListener(head, this.#floorFromArena);
    this.#showBalls(scene);
    this.#pops.show(pageTime, eyes);
    const standing = this.people.show(scene, head.position.y);
    this.#boards.show(standing, this.#lineNow(scene, standing));
    const station = me === null ? undefined : stations[ballGame.stationOf(state, me)];
    this.#ring.show(station?.position ?? null, eyes);
  }

  addGazeTargets(targets: GazeTargets): void {
    this.#balls.addGazeTargets(targets, this.#floorFromArena);
  }

  /** Plays and captions the events since the last frame, and writes them on the board. Call it after `show`. */
  playEvents(happened: readonly BallEvent[], { cues: played, simulated }: Pick<BallFrame, 'cues' | 'simulated'>): void {
    if (!this.#shown) return;
    const events = simulated ? happened.filter(({ type }) => type !== 'refused') : happened;
    const cues = simulated ? played.filter(({ type }) => type !== 'slipped') : played;
    const { state, pageTime, players: people, me, palms, opening } = this.#shown;
    for (const event of events) {
      const text = eventLine(event, people);
      if (text) this.#line = { text, until: pageTime + lineSeconds };
      if (event.type === 'caught') this.#pops.add((opening ?? state.basket).position, pageTime);
    }
    const own = (me === null ? null : palms[me]) ?? unseenPalms;
    this.#sounds.playEvents({ state, events, cues, me, people, palms: own });
  }

  dispose(): void {
    this.#sounds.dispose();
    this.people.dispose();
    disposeTree(this.#court.object);
  }

  #showBalls(scene: BallScene): void {
    const { state, time, palms, opening: held, aim, isThere } = scene;
    const opening = held ?? state.basket;
    this.#basket.show(opening);
    this.#basket.object.visible = this.#hasBasket(scene);
    this.#arc.show(aim, opening);
    const inHand: InHand = (player, side) => (isThere(player) && palms[player]?.[side]) || null;
    this.#balls.show(state, time, inHand, this.#basket.object.visible ? opening : null);
  }

  /** Returns whether the basket is shown: from when its holder is there, until the end of a match that they leave. */
  #hasBasket({ state, players, isThere }: BallScene): boolean {
    const holder = state.players.findIndex(({ role }) => role === 'holder');
    if (isThere(holder)) return true;
    return state.phase !== 'ready' && (this.#basket.object.visible || players[holder] === null);
  }

  /** Returns the line of the board: the last event, or what the match waits for. */
  #lineNow({ paused, inRoom, pageTime }: BallScene, standing: DisplayedMatch<BallState>): string {
    if (!inRoom) return 'No connection to the room';
    if (paused) return 'Paused';
    const { text, until } = this.#line;
    return pageTime < until && standing.state.phase === 'running' ? text : waitingLine(standing);
  }
}
