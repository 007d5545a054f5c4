import {
  type Buttons,
  type HapticPulse,
  type MutableHandShape,
  nothingPressed,
  type PointerTarget,
  type TrackingFrame,
} from 'threepoint/core';
import type { ObjectHolds } from 'threepoint/internal/three';
import { copyVec3, type Pose, type Ray, rotate, type Side, up, vec3 } from 'threepoint/math';
import type { SimulatedInput } from 'threepoint-games';
import type { ActivityPanel, OpenActivity } from '../activity/activity';
import type { ActivityContext } from '../activity/activity-context';
import type { ActivityMenu, MenuEntry } from '../activity/activity-menu';
import type { CameraScene } from '../scene/desktop-view';
import { type ArcheryRound, type ArcheryRules, createArcheryPanel } from './archery-panel';
import { ArcheryPlay, type ArcheryProbe, probeOf, roundOf } from './archery-play';
import { type ArcheryView, createArcheryView } from './archery-view';
import { statusLine } from './boards/scoreboard';
import { eventHaptics } from './sound/archery-haptics';

/** The view past the archer to the targets. */
export const rangeScene: CameraScene = {
  'third-person': { offset: { x: -1.35, y: 0.95, z: 3.3 }, aim: { x: 0.15, y: -0.2, z: -2 }, fovDegrees: 46 },
  front: { offset: { x: 1.6, y: 0.35, z: -2.7 }, aim: { x: 0, y: 0, z: 0 }, fovDegrees: 46 },
};

/** The view over the shoulder of the string hand, for a mouse that aims. */
const shoulderScene: CameraScene = {
  ...rangeScene,
  'third-person': {
    offset: { x: 0.72, y: 1.1, z: 1.6 },
    aim: { x: 0.1, y: 0.45, z: -5 },
    fovDegrees: 50,
    sides: 0.5,
  },
};

/** The leather of the bow's grip, as thick as its riser is there [m]. */
const grip = { at: vec3(0, 0, 0), axis: vec3(0, 1, 0), radius: 0.019 };
/** The string, with the arrow's nock on it, where fingers hook it [m]. */
const string = { at: vec3(0, 0, 0), axis: vec3(0, 1, 0), radius: 0.005 };

export const createArcheryActivity = (context: ActivityContext): ArcheryActivity => new ArcheryActivity(context);

/** Archery in the page: the range, the bow, and the current round. */
export class ArcheryActivity implements OpenActivity {
  readonly play: ArcheryPlay;
  readonly #context: ActivityContext;
  readonly #view: ArcheryView;
  #newestFrame: TrackingFrame | null = null;

  constructor(context: ActivityContext) {
    const { quality, stage, body, settings, layout, onCaption } = context;
    this.#context = context;
    this.play = new ArcheryPlay(
      body.calibration,
      () => settings,
      () => layout.seed,
    );
    const distances = this.play.targets.map(({ distance }) => distance);
    this.#view = createArcheryView({ quality, distances, onCaption });
    stage.studio.setSurroundings(this.#view.range);
    stage.studio.scene.add(this.#view.bow);
  }

  get sound(): ArcheryView['sound'] {
    return this.#view.sound;
  }

  get scene(): CameraScene {
    return this.#byMouse ? shoulderScene : rangeScene;
  }

  get #byMouse(): boolean {
    return this.#context.inputSource === 'mouse';
  }

  /** The side that the archer's chest faces. */
  get mirrorSide(): Side {
    return this.#context.settings.bowSide === 'left' ? 'right' : 'left';
  }

  act(time: number): SimulatedInput {
    const { headset, pointer } = this.#context;
    const steering = pointer();
    if (!steering) return this.play.act(time);
    const head = headset.worn ? this.#newestFrame?.head.position : undefined;
    return this.play.steer(time, steering, head && vec3(head.x, 0, head.z));
  }

  update(frame: TrackingFrame, allButtons: Buttons): readonly HapticPulse[] | null {
    const { clock, study, settings, writer, onChange } = this.#context;
    this.#newestFrame = frame;
    if (study.run?.paused) return null;
    const buttons = study.run?.idle ? nothingPressed : allButtons;
    // After a pause a hand may have let go long ago: a drawn arrow waits for it.
    if (clock.paused) this.play.replaceHands();
    const { events, cues, haptics, bow } = this.play.follow(frame, buttons);
    const taken = cues.findLast(({ type }) => type === 'taken')?.side ?? null;
    this.#view.playEvents(events, cues);
    const bowSide = bow?.bowSide ?? taken ?? settings.bowSide;
    if (taken) writer.keep({ bowSide: taken });
    if (events.length > 0) onChange();
    return [...haptics, ...eventHaptics(events, bowSide)];
  }

  grasp(side: Side, wrist: Pose<'floor'>, holding: ObjectHolds, target: MutableHandShape): boolean {
    const { study, settings } = this.#context;
    const bow = this.play.newest?.bow;
    if (!bow || study.run?.idle) return false;
    if (bow.bowSide === side) {
      copyVec3(bow.bow.position, grip.at);
      rotate(bow.bow.orientation, up, grip.axis);
      holding.rod(side, wrist, grip, target);
      return true;
    }
    // The other hand has the string while an arrow is on it.
    if (!bow.arrow || settings.oneHanded) return false;
    copyVec3(bow.arrow.nock, string.at);
    rotate(bow.bow.orientation, up, string.axis);
    holding.rod(side, wrist, string, target);
    return true;
  }

  show(_time: number, frame: TrackingFrame | null): void {
    const { newest } = this.play;
    if (!frame || !newest) return;
    this.#view.showScoreboard(this.#context.headset.worn);
    this.#view.show(newest.state, this.#context.study.run?.idle ? null : newest.bow, newest.time, frame.head);
    this.#view.showAim(newest.state, newest.bow, this.#byMouse ? this.play.aim : null);
  }

  point({ origin, direction }: Ray, press: boolean): PointerTarget | null {
    const distance = this.#view.result.restartAt(origin, direction);
    this.#view.result.setHovered(distance !== null);
    if (distance === null) return null;
    if (press) this.restart();
    return { distance, owner: 'result', id: 'restart' };
  }

  discontinuity(): void {
    this.play.discontinuity();
  }

  sessionChanged(): void {
    this.play.replaceHands();
  }

  createPanel(): ActivityPanel {
    return createArcheryPanel(this, this.#context);
  }

  menu(): ActivityMenu {
    const { bowSide, oneHanded } = this.#context.settings;
    const entries: readonly MenuEntry[] = [
      { id: 'restart', label: 'New round', act: () => this.restart() },
      {
        id: 'bow',
        label: `Bow: ${bowSide} hand`,
        act: () => this.setRules({ bowSide: bowSide === 'left' ? 'right' : 'left' }),
      },
      {
        id: 'one-handed',
        label: oneHanded ? 'Draw: one hand' : 'Draw: both hands',
        act: () => this.setRules({ oneHanded: !oneHanded }),
      },
    ];
    return { entries, sheet: null, notice: null, hint: null };
  }

  round(): ArcheryRound | null {
    const { newest } = this.play;
    if (!newest) return null;
    const { state, time } = newest;
    const waits = state.phase === 'ready' || (state.phase === 'running' && !state.inZone);
    return { ...roundOf(newest), waiting: waits ? `${statusLine(state, time)}.` : null };
  }

  probe(): ArcheryProbe | null {
    return this.play.newest && probeOf(this.play.newest);
  }

  /** Starts another round with another layout, except in a study, which starts its rounds itself. */
  restart(): void {
    if (this.#context.study.run) return;
    this.#context.layout.seed += 1;
    this.resetRound();
  }

  /** Starts a study's round by its signal, with this layout and length [s]. */
  startRound(layout: number, seconds: number): void {
    this.#context.writer.change({ seconds, everyHitCounts: false });
    this.#context.layout.seed = layout;
    this.resetRound();
    this.play.signal();
  }

  /** Replaces the round by one that waits for its start. */
  resetRound(): void {
    const { body, headset, onCaption, onChange } = this.#context;
    // The targets are as high relative to the eyes for a seated player as for a standing one.
    const eyeHeight = headset.worn ? this.#newestFrame?.head.position.y : undefined;
    this.play.restart(body.calibration, eyeHeight);
    onCaption('');
    onChange();
  }

  /**
   * Changes hands or rules. The current round continues unless the change affects its score or its simulated archer.
   */
  setRules(rules: ArcheryRules): void {
    const { writer, settings } = this.#context;
    writer.keep(rules);
    if (rules.everyHitCounts !== undefined || settings.actor) this.restart();
  }

  /** Lets the mouse or the simulated archer shoot, in a new round. */
  chooseShooter(shooter: 'mouse' | 'actor'): void {
    this.#context.chooseInput(shooter);
    this.restart();
  }

  dispose(): void {
    this.#context.stage.studio.setSurroundings(null);
    this.#view.dispose();
  }
}
