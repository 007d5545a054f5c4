import type { Holding } from 'threepoint/avatar/hands/holding';
import type { Calibration } from 'threepoint/core/body/calibration';
import type { MutableHandShape } from 'threepoint/core/body/hand-shape';
import type { Buttons } from 'threepoint/core/input/button-presses';
import type { Pose } from 'threepoint/core/math/pose';
import { identity, rotate } from 'threepoint/core/math/quat';
import type { Ray } from 'threepoint/core/math/ray';
import type { Side } from 'threepoint/core/math/side';
import { copyVec3, up, vec3, zero } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { HapticPulse } from 'threepoint-games/archery/gestures';
import type { Quality } from '../scene/renderer';
import type { SurroundingsHost } from '../scene/surroundings';
import { type ArcherySettings, createArcheryPlay, probeOf, roundOf } from './archery-play';
import { createArcheryView } from './archery-view';
import { eventHaptics } from './haptics';
import { lineOf } from './scoreboard-drawing';

/** The room's floor is the range's: its zone lies about the origin, the targets ahead. */
const floorFromArena = { position: zero, orientation: identity };

/** The leather of the bow's grip, as thick as its riser is there [m]. */
const grip = { at: vec3(0, 0, 0), axis: vec3(0, 1, 0), radius: 0.019 };
/** The string, with the arrow's nock on it, where fingers hook it [m]. */
const string = { at: vec3(0, 0, 0), axis: vec3(0, 1, 0), radius: 0.005 };

export interface ArcheryActivityOptions {
  readonly quality: Quality;
  readonly surroundings: SurroundingsHost;
  readonly calibration: Calibration;
  settings(): ArcherySettings;
  /** Of the next round's layout. */
  seed(): number;
  onCaption(text: string): void;
}

/** What a frame of play means to the player. */
export interface ArcheryMoment {
  readonly haptics: readonly HapticPulse[];
  /** The hand that has just taken the bow; null: no hand took it. */
  readonly taken: Side | null;
  /** Score or clock may have changed. */
  readonly eventful: boolean;
}

/** Archery in the page: the range, the bow, and the round that is played. */
export interface ArcheryActivity {
  readonly play: ReturnType<typeof createArcheryPlay>;
  readonly sound: ReturnType<typeof createArcheryView>['sound'];
  /** The tracked frame as play: what it means is heard at once, what it feels like comes back. */
  follow(frame: TrackingFrame, buttons: Buttons): ArcheryMoment;
  /** Draws the newest frame of play; bow: whether it is to be seen. */
  show(head: TrackingFrame['head'], bow: boolean): void;
  /** What a ray meets of the result's button: the distance [m]; null: nothing. */
  restartAt(ray: Ray): number | null;
  setHovered(hovered: boolean): void;
  /** Closes a hand with this wrist round the bow; false: it does not hold the bow. */
  grasp(side: Side, wrist: Pose<'floor'>, holding: Holding, target: MutableHandShape): boolean;
  /** The round in numbers, and what it waits for, in words (null: for nothing). */
  round(): (ReturnType<typeof roundOf> & { readonly waiting: string | null }) | null;
  probe(): ReturnType<typeof probeOf> | null;
  dispose(): void;
}

export function createArcheryActivity(options: ArcheryActivityOptions): ArcheryActivity {
  const { quality, surroundings, calibration, settings, seed, onCaption } = options;
  const play = createArcheryPlay(calibration, settings, seed);
  const view = createArcheryView({
    quality,
    floorFromArena,
    distances: play.targets.map(({ distance }) => distance),
    onCaption,
  });
  surroundings.setSurroundings(view.range);
  surroundings.scene.add(view.bow);

  return {
    play,
    sound: view.sound,
    follow(frame, buttons) {
      const { events, cues, haptics, bow } = play.follow(frame, buttons);
      const taken = cues.findLast(({ type }) => type === 'taken')?.side ?? null;
      view.hear(events, cues);
      const bowSide = bow?.bowSide ?? taken ?? settings().bowSide;
      return { haptics: [...haptics, ...eventHaptics(events, bowSide)], taken, eventful: events.length > 0 };
    },
    show(head, bow) {
      const { newest } = play;
      if (newest) view.show(newest.state, bow ? newest.bow : null, newest.time, head);
    },
    restartAt: ({ origin, direction }) => view.result.restartAt(origin, direction),
    setHovered: (hovered) => view.result.setHovered(hovered),
    grasp(side, wrist, holding, target) {
      const bow = play.newest?.bow;
      if (!bow) return false;
      if (bow.bowSide === side) {
        copyVec3(bow.bow.position, grip.at);
        rotate(bow.bow.orientation, up, grip.axis);
        holding.rod(side, wrist, grip, target);
        return true;
      }
      // The other hand has the string while an arrow is on it.
      if (!bow.arrow || settings().oneHanded) return false;
      copyVec3(bow.arrow.nock, string.at);
      rotate(bow.bow.orientation, up, string.axis);
      holding.rod(side, wrist, string, target);
      return true;
    },
    round() {
      const { newest } = play;
      if (!newest) return null;
      const { state, time } = newest;
      const waits = state.phase === 'ready' || (state.phase === 'running' && !state.inZone);
      return { ...roundOf(newest), waiting: waits ? `${lineOf(state, time)}.` : null };
    },
    probe: () => play.newest && probeOf(play.newest),
    dispose() {
      view.bow.removeFromParent();
      surroundings.setSurroundings(null);
      view.dispose();
    },
  };
}
