import type { Group } from 'three';
import type { BallEvent, BallState } from '../../core/games/ball/ball-state';
import type { Opening } from '../../core/games/ball/basket';
import type { BallCue } from '../../core/games/ball/gestures';
import { stations } from '../../core/games/ball/stations';
import type { Launch } from '../../core/games/ballistics';
import { invertTransform, type Pose, type Transform, transformPoint } from '../../core/math/pose';
import type { Vec3 } from '../../core/math/vec3';
import type { Quality } from '../../scene/renderer';
import type { Surroundings } from '../../scene/surroundings';
import { createAimArc } from './aim-arc';
import { createBalls } from './balls';
import { lineOfEvent, type Person, type Standing, waitingLine } from './board-drawing';
import { createBoards } from './boards';
import { createCatchPops } from './catch-pops';
import { createCourt } from './court';
import { createLobbySheet, type LobbySheet } from './lobby-sheet';
import { createNameLabels } from './name-labels';
import { type BallSounds, createBallSounds } from './sounds';
import { createWickerBasket } from './wicker-basket';
import { createZoneRing } from './zone-ring';

/** A player at the court as they are drawn in this frame. */
export interface Attendant extends Person {
  /** Arena frame; null: not to be seen now. */
  readonly head: Vec3 | null;
  /** The middle of each fist, arena frame; null: not seen. */
  readonly fists: Readonly<Record<'left' | 'right', Vec3 | null>>;
  /** 1: live; less: a ghost. */
  readonly opacity: number;
}

/** One frame of a match as it is drawn. */
export interface BallScene {
  readonly state: BallState;
  /** Seconds of the match. */
  readonly time: number;
  /** By player; null: the seat is free. */
  readonly attendants: readonly (Attendant | null)[];
  readonly me: number | null;
  readonly rotate: boolean;
  /** The basket where its holder's hands are drawn; null: where it was last. Arena frame. */
  readonly opening: Opening | null;
  /** How a ball would fly that is let go now, arena frame; null: no player here aims with a mouse. */
  readonly aim: Launch | null;
  /** The match's clock stands. */
  readonly paused: boolean;
  /** Seconds until the bell; after a match what was left at its end. */
  readonly secondsLeft: number;
  /** The page's time [s], and whether it is still in the room. */
  readonly pageTime: number;
  readonly inRoom: boolean;
  /** A built-in player has the own seat. */
  readonly acting: boolean;
  /** Whose eyes and ears these are, own floor frame. */
  readonly head: Pose<'floor'>;
}

/** Everything that is seen of the ball game but the people. */
export interface BallView {
  /** The place as it lies in a room whose floor is there; to be given to the arena, and again whenever the seat changes. */
  placed(floorFromArena: Transform<'floor', 'arena'>): Surroundings;
  /** What belongs to the viewer, own floor frame; to be added to the scene. */
  readonly own: Group;
  readonly lobby: Pick<LobbySheet, 'buttonAt' | 'setHovered'>;
  show(scene: BallScene): void;
  /** Plays, captions and writes on the board what happened since the last frame. After `show`. */
  hear(events: readonly BallEvent[], cues: readonly BallCue[]): void;
  readonly sound: Pick<BallSounds, 'unlock' | 'setVolume' | 'setMuted'>;
  dispose(): void;
}

export interface BallViewOptions {
  readonly quality: Quality;
  readonly balls: number;
  /** Every sound in words, with its direction. */
  readonly onCaption: (text: string) => void;
}

/** The last sentence stays on the board this long [s]. */
const lineSeconds = 3;

export function createBallView({ quality, balls: count, onCaption }: BallViewOptions): BallView {
  const court = createCourt(quality, count);
  const balls = createBalls(count, quality);
  const basket = createWickerBasket();
  const boards = createBoards(quality);
  const pops = createCatchPops(quality);
  const names = createNameLabels(stations.length, quality);
  const ring = createZoneRing();
  const arc = createAimArc();
  const lobby = createLobbySheet(quality);
  const sounds = createBallSounds(onCaption);
  court.object.add(balls.object, basket.object, boards.object, pops.object, names.object, ring.mesh, arc.object);
  let floorFromArena: Transform<'floor', 'arena'> = {
    position: { x: 0, y: 0, z: 0 },
    orientation: { x: 0, y: 0, z: 0, w: 1 },
  };
  let shown: BallScene | null = null;
  let line = { text: '', until: Number.NEGATIVE_INFINITY };

  return {
    placed(next) {
      floorFromArena = next;
      return court.placed(next);
    },
    own: lobby.object,
    lobby,
    sound: sounds,
    show(scene) {
      shown = scene;
      const { state, time, attendants, me, rotate, head } = scene;
      const eyes = transformPoint(invertTransform(floorFromArena), head.position);
      sounds.listen(head, floorFromArena);
      const opening = scene.opening ?? state.basket;
      basket.show(opening);
      arc.show(scene.aim, opening);
      balls.show(state, time, (player, side) => attendants[player]?.fists[side] ?? null, opening);
      pops.show(time, eyes);
      const people = attendants.map(
        (person): Person | null =>
          person && { name: person.name, bot: person.bot, presence: person.presence, me: person.me },
      );
      const standing: Standing = {
        state,
        seconds: Math.ceil(scene.secondsLeft),
        people,
        me,
        rotate,
        acting: scene.acting,
      };
      const said = time < line.until && state.phase === 'running' ? line.text : waitingLine(standing);
      boards.show(standing, scene.paused ? 'Paused' : said);
      lobby.show(standing, head.position.y, scene.pageTime, scene.inRoom);
      names.show(
        attendants.map((person, player) => {
          const station = state.players[player]?.station ?? player;
          const head = person?.head;
          const known = people[player];
          return known && head && !known.me ? { person: known, station, head, opacity: person.opacity } : null;
        }),
      );
      const station = me === null ? null : (state.players[me]?.station ?? null);
      ring.show(station === null ? null : (stations[station]?.position ?? null), eyes);
    },
    hear(events, cues) {
      if (!shown) return;
      const { state, time, attendants, me } = shown;
      for (const event of events) {
        const text = lineOfEvent(event, attendants);
        if (text) line = { text, until: time + lineSeconds };
        if (event.type === 'caught') pops.add((shown.opening ?? state.basket).position, time);
      }
      const mine = me === null ? null : (attendants[me] ?? null);
      sounds.hear({
        state,
        time,
        events,
        cues,
        me,
        people: attendants,
        fists: mine?.fists ?? { left: null, right: null },
      });
    },
    dispose() {
      lobby.dispose();
      for (const part of [sounds, balls, basket, boards, pops, names, arc, court]) part.dispose();
    },
  };
}
