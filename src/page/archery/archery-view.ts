import { addScaled, copyVec3, type Pose } from 'threepoint/math';
import {
  type ArcheryEvent,
  type ArcheryState,
  arrowLength,
  type BowCue,
  type BowView,
  braceHeight,
  landingPointOf,
} from 'threepoint-games/archery';
import { disposeTree } from '../scene/dispose-tree';
import type { Quality } from '../scene/renderer';
import type { ArcheryPlay } from './archery-play';
import { createResultPanel } from './boards/result-panel';
import { ScorePopups } from './boards/score-popups';
import { createScoreboard } from './boards/scoreboard';
import { createAimMark } from './bow/aim-mark';
import { makeArrowPose } from './bow/arrow-pose';
import { createArrows } from './bow/arrows';
import { createBow } from './bow/bow-model';
import { createTrails } from './bow/trails';
import { createRange } from './range/range';
import { TargetStands } from './range/target-stands';
import { ArcherySounds } from './sound/archery-sounds';

interface ArcheryViewOptions {
  readonly quality: Quality;
  /** The distances of the targets along the floor [m], for the signs. */
  readonly distances: readonly number[];
  /** Every sound in words, with its direction. */
  readonly onCaption: (text: string) => void;
}

/**
 * Creates the view of archery: range, targets, arrows, bow, boards and sounds. The arena frame of the range is the
 * floor frame of the user: the zone lies around the origin, the targets ahead.
 */
export function createArcheryView({ quality, distances, onCaption }: ArcheryViewOptions) {
  const range = createRange(quality, distances);
  const stands = new TargetStands(quality);
  const arrows = createArrows(arrowLength);
  const trails = createTrails(arrowLength);
  const scoreboard = createScoreboard(quality);
  const pops = new ScorePopups(quality);
  const aimMark = createAimMark();
  const result = createResultPanel(quality);
  const sounds = new ArcherySounds(onCaption);
  let shown: ArcheryState | null = null;
  const onString = makeArrowPose();
  const bow = createBow(quality, braceHeight);
  range.object.add(
    stands.object,
    arrows.object,
    trails.object,
    scoreboard.object,
    pops.object,
    result.object,
    aimMark.object,
  );
  return {
    /** The surroundings of the arena: the whole view except the bow. */
    range,
    /** The bow in its hand, floor frame. Add it to the scene next to the avatar. */
    bow: bow.object,
    result,
    sound: sounds.stage,
    /** Draws a state at a match time [s], with the tracked bow and head, floor frame. `bowView`: null hides the bow. */
    show(state: ArcheryState, bowView: BowView | null, matchTime: number, head: Pose<'floor'>): void {
      shown = state;
      sounds.setListener(head);
      const nocked = bowView?.arrow;
      if (nocked) {
        copyVec3(nocked.direction, onString.direction);
        addScaled(nocked.nock, nocked.direction, arrowLength, onString.tip);
      }
      const eyes = head.position;
      stands.show(state, matchTime);
      arrows.show(state.arrows, matchTime, nocked ? onString : null);
      trails.show(state.arrows, matchTime, eyes);
      pops.show(state, matchTime, eyes);
      scoreboard.show(state, matchTime);
      result.show(state, matchTime);
      bow.show(bowView);
      range.setZoneWarning(!state.inZone);
      range.animate(matchTime);
    },
    /**
     * Marks where the arrow on the string would land, else the point that is aimed at, and how far the string is drawn;
     * null: hides the mark.
     */
    showAim({ targets }: ArcheryState, bow: BowView | null, aim: ArcheryPlay['aim']): void {
      const landing = aim && ((bow && landingPointOf(bow, targets)) ?? aim.point);
      aimMark.show(landing, aim && bow ? Math.min(1, bow.draw / aim.fullDraw) : 0);
    },
    /**
     * Shows or hides the board beside the field. At a desk the play bar has its figures, and the logo would cover it.
     */
    showScoreboard(visible: boolean): void {
      scoreboard.object.visible = visible;
    },
    /** Plays and captions the events and cues since the last frame. */
    playEvents(events: readonly ArcheryEvent[], cues: readonly BowCue[]): void {
      if (shown) sounds.playEvents(shown, events, cues);
    },
    dispose(): void {
      sounds.dispose();
      disposeTree(bow.object);
      disposeTree(range.object);
    },
  };
}

export type ArcheryView = ReturnType<typeof createArcheryView>;
