import type { BodySolver } from 'threepoint/api/body-solver';
import { Holding } from 'threepoint/avatar/hands/holding';
import type { HandGeometry } from 'threepoint/core/body/hand-geometry';
import type { MutableHandShape } from 'threepoint/core/body/hand-shape';
import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import { type Buttons, nothingPressed } from 'threepoint/core/input/button-presses';
import type { Pose } from 'threepoint/core/math/pose';
import type { Ray } from 'threepoint/core/math/ray';
import type { Side } from 'threepoint/core/math/side';
import type { Vec3 } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { Pulse } from 'threepoint/xr/haptics';
import type { TaskPlace } from 'threepoint-study/participant/task-runner';
import type { MouseAim } from 'threepoint-ui/mouse-aim';
import type { Notices } from 'threepoint-ui/notices';
import type { ArcheryActivity } from '../archery/archery-activity';
import type { Performance } from '../archery/archery-play';
import type { BallActivity } from '../ball/ball-activity';
import type { Recorder } from '../studio/recorder';
import type { Games } from './games';
import type { Headset } from './headset';
import type { PageStudy } from './page-study';
import type { ActivityName, ChosenShooter } from './play-bar';
import type { Settings, SettingsWriter } from './settings';
import type { Stage, Watched } from './stage';
import { wakeSound } from './wake-sound';

/** The court's middle, where a spectator looks at first, floor frame. */
const courtMiddle: Vec3 = { x: 0, y: 1, z: -2.4 };

/** A choice of hands or rules. */
export type RuleChange = Partial<Pick<Settings, 'bowSide' | 'oneHanded' | 'everyHitCounts'>>;

export interface ActivitiesOptions {
  readonly settings: Settings;
  readonly writer: Pick<SettingsWriter, 'change' | 'keep'>;
  readonly notices: Pick<Notices, 'show'>;
  readonly games: Games;
  /** Of the first round's layout. */
  readonly seed: number;
  readonly stage: {
    readonly studio: Pick<Stage['studio'], 'setMarkVisible'>;
    readonly view: Pick<Stage['view'], 'setScene' | 'setOrbit' | 'pose' | 'rayThrough'>;
    readonly placeMirror: Stage['placeMirror'];
  };
  readonly mouse: MouseAim;
  readonly headset: Pick<Headset, 'worn'>;
  readonly recorder: Pick<Recorder, 'giveWay'>;
  readonly body: Pick<BodySolver, 'calibration'>;
  readonly study: Pick<PageStudy, 'joined' | 'idle' | 'paused'>;
  /** The colours of a seat for the own body; null: the user's own. */
  wear(palette: string | null): void;
  onCaption(text: string): void;
  /** Somewhere else now: filters and clocks begin again. */
  onArrival(): void;
  onChange(): void;
}

/** What people do here: look at themselves in the studio, shoot on the range, or play on the court. Games load when first played. */
export class Activities {
  readonly #options: ActivitiesOptions;
  readonly #holding = new Holding();
  #archery: ArcheryActivity | null = null;
  #ball: BallActivity | null = null;
  #arriving = false;
  /** Where a study plays the ball game; null: where the address says. */
  #studyPlace: TaskPlace | null = null;
  #seed: number;
  /** Whether the camera stands where a spectator watches from. */
  #inTheStands = false;
  /** The colours of the own seat, as far as the own body wears them. */
  #worn: string | null = null;
  #newestFrame: TrackingFrame | null = null;
  /** Waits no longer for a touch that lets the game be heard. */
  #letSoundSleep: () => void = () => undefined;

  constructor(options: ActivitiesOptions) {
    this.#options = options;
    this.#seed = options.seed;
  }

  get name(): ActivityName {
    return this.#archery ? 'archery' : this.#ball ? 'ball' : 'studio';
  }

  /** On the way to a game that is still loading. */
  get arriving(): boolean {
    return this.#arriving;
  }

  get archery(): ArcheryActivity | null {
    return this.#archery;
  }

  get ball(): BallActivity | null {
    return this.#ball;
  }

  async goTo(next: ActivityName): Promise<void> {
    if (this.#arriving || next === this.name) return;
    this.#leave();
    if (next !== 'studio') await this.#open(next);
    this.#options.writer.change({ following: null });
    this.#placeCamera();
    this.#options.stage.studio.setMarkVisible(this.name === 'studio');
    this.#placeMirror();
    this.#options.onCaption('');
    this.#options.onArrival();
  }

  /** Into the room again that this page has left or lost. */
  async rejoin(): Promise<void> {
    if (!this.#ball || this.#arriving) return;
    this.#leave();
    await this.goTo('ball');
  }

  /** The court in a study's room, on this participant's seat. */
  async goToMatch(place: TaskPlace): Promise<void> {
    if (this.#ball) await this.goTo('studio');
    this.#studyPlace = place;
    await this.goTo('ball');
  }

  async #open(game: 'archery' | 'ball'): Promise<void> {
    const { games, settings, notices, onChange } = this.#options;
    const opening = { seed: () => this.#seed, place: this.#studyPlace };
    this.#arriving = true;
    onChange();
    try {
      if (game === 'archery') this.#archery = await games.archery(opening);
      else this.#ball = await games.ball(opening);
      const opened = this.#archery ?? this.#ball;
      if (opened) this.#letSoundSleep = wakeSound(opened.sound, settings.sound, notices);
    } catch (error) {
      const place = game === 'archery' ? 'The archery range' : 'The ball court';
      notices.show('error', `${place} could not be opened: ${firstLine(reasonOf(error))}`);
    }
    this.#arriving = false;
  }

  #leave(): void {
    // Who comes back begins a new round.
    if (this.name !== 'studio') this.#seed += 1;
    this.#letSoundSleep();
    this.#archery?.dispose();
    this.#archery = null;
    this.#ball?.dispose();
    this.#ball = null;
    this.#options.wear(null);
    this.#worn = null;
  }

  /** Another round, where rounds are not a study's. */
  restartRound(): void {
    if (this.#options.study.joined) return;
    this.#seed += 1;
    this.resetRound();
  }

  /** A study's round: this layout, this long [s], from its signal on. */
  startRound(layout: number, seconds: number): void {
    this.#options.writer.change({ seconds, everyHitCounts: false });
    this.#seed = layout;
    this.resetRound();
    this.#archery?.play.signal();
  }

  /** Makes the round on the page one that waits. */
  resetRound(): void {
    const { body, headset, onCaption, onChange } = this.#options;
    // A player who sits shoots at targets as high for the eyes as those of a player who stands.
    const eyeHeight = headset.worn ? this.#newestFrame?.head.position.y : undefined;
    this.#archery?.play.restart(body.calibration, eyeHeight);
    onCaption('');
    onChange();
  }

  /** A change of hands or rules; a round under way goes on unless it is counted differently. */
  rule(change: RuleChange): void {
    const { writer, settings } = this.#options;
    writer.keep(change);
    this.#placeMirror();
    if (change.everyHitCounts !== undefined || settings.actor) this.restartRound();
  }

  /** A hand for the bow, for this visit. */
  setBowSide(side: Side): void {
    this.#options.writer.change({ bowSide: side });
    this.#placeMirror();
  }

  setSound(on: boolean): void {
    const { writer, notices } = this.#options;
    writer.keep({ sound: on });
    const game = this.#archery ?? this.#ball;
    this.#letSoundSleep();
    if (game) this.#letSoundSleep = wakeSound(game.sound, on, notices);
  }

  /** The mouse or the actor plays, where no headset is worn. A replay would hold the body that shoots: it is over. */
  chooseShooter(shooter: ChosenShooter): void {
    this.#options.recorder.giveWay();
    this.#options.writer.change({ actor: true, mouse: shooter === 'mouse' });
    this.#steerByMouse();
    this.restartRound();
  }

  /** With whom a spectator's camera goes; null: it is free. */
  follow(seat: number | null): void {
    this.#options.writer.change({ following: seat });
    this.#placeCamera();
  }

  /** The floor lies elsewhere from one frame to the next: there is no way between, for hands and for others. */
  jumped(): void {
    this.#archery?.play.jumped();
    this.#ball?.play.jumped();
  }

  /** A headset is worn, or no longer: other hands play from the next frame on. */
  sessionChanged(): void {
    this.#archery?.play.handedOver();
    this.#steerByMouse();
  }

  /** Whom the camera shows instead of an own body; null: there is one. */
  watched(): Watched | null {
    if (!this.#watching) return null;
    const { settings, stage } = this.#options;
    const followed = settings.following === null ? null : this.#ball?.bodyOf(settings.following);
    return followed ?? { pelvis: courtMiddle, eyes: stage.view.pose };
  }

  /** Once a frame, first. */
  begin(time: number): void {
    this.#ball?.begin(time);
  }

  /** Head, hands and buttons of a built-in player, or of one whom the mouse steers; null: neither is here. */
  act(time: number): Performance | null {
    const { study, headset, settings, stage, mouse } = this.#options;
    if (study.idle) return null;
    const player = this.#ball?.act(time, !headset.worn);
    if (player || !this.#archery) return player ?? null;
    if (!settings.mouse || headset.worn) return this.#archery.play.act(time);
    return this.#archery.play.steer(time, stage.view.rayThrough(mouse.x, mouse.y), mouse);
  }

  /** The tracked frame as play; what the hands feel of it. */
  play(frame: TrackingFrame, allButtons: Buttons): readonly Pulse[] {
    const { study } = this.#options;
    this.#newestFrame = frame;
    const buttons = study.idle ? nothingPressed : allButtons;
    if (this.#archery && !study.paused) return this.#shoot(this.#archery, frame, buttons);
    if (!this.#ball) return [];
    const haptics = this.#ball.follow(frame, buttons);
    const { newest } = this.#ball.play;
    if (newest) study.joined?.ball.played(newest);
    return haptics;
  }

  #shoot(archery: ArcheryActivity, frame: TrackingFrame, buttons: Buttons): readonly Pulse[] {
    const { study, writer, onChange } = this.#options;
    const { haptics, taken, eventful } = archery.follow(frame, buttons);
    const { newest } = archery.play;
    if (newest) study.joined?.archery.played(newest);
    if (taken) {
      writer.keep({ bowSide: taken });
      this.#placeMirror();
    }
    if (eventful) onChange();
    return haptics;
  }

  /**
   * Closes a hand, whose wrist is there in the floor frame, round what it holds; false: it holds nothing. `hand`: of the avatar that is drawn; null:
   * not known.
   */
  grasp(side: Side, wrist: Pose<'floor'>, hand: HandGeometry | null, target: MutableHandShape): boolean {
    this.#holding.fitTo(side, hand, this.#options.body.calibration.eyeHeight);
    if (!this.#options.study.idle && this.#archery?.grasp(side, wrist, this.#holding, target)) return true;
    return this.#ball?.grasp(side, wrist, this.#holding, target) ?? false;
  }

  /** Draws the newest frame of play; frame: what was tracked, null where nothing was. */
  show(time: number, frame: TrackingFrame | null): void {
    const { study, stage, wear } = this.#options;
    if (this.#archery && frame) this.#archery.show(frame.head, !study.idle);
    if (!this.#ball) return;
    const eyes = this.#watching ? stage.view.pose : (frame ?? this.#newestFrame)?.head;
    this.#ball.show(time, eyes ?? stage.view.pose, frame !== null);
    if (this.#worn !== this.#ball.palette) {
      this.#worn = this.#ball.palette;
      wear(this.#worn);
    }
    if (this.#watching !== this.#inTheStands) this.#placeCamera();
  }

  /** What a ray meets of a game's sheets: the distance [m]; null: nothing. `press`: does what it says. */
  point(ray: Ray, press: boolean): number | null {
    if (!this.#archery) return this.#ball?.point(ray, press) ?? null;
    const distance = this.#archery.restartAt(ray);
    this.#archery.setHovered(distance !== null);
    if (distance !== null && press) this.restartRound();
    return distance;
  }

  get #watching(): boolean {
    const newest = this.#ball?.play.newest ?? null;
    return newest !== null && newest.me === null && !this.#options.headset.worn;
  }

  #placeMirror(): void {
    const { stage, settings } = this.#options;
    stage.placeMirror(this.#archery ? settings.bowSide : null);
  }

  #placeCamera(): void {
    const { stage, settings } = this.#options;
    this.#inTheStands = this.#watching;
    this.#steerByMouse();
    const inCourt = this.#inTheStands && settings.following === null ? 'stands' : 'court';
    stage.view.setScene(this.#archery ? 'range' : this.#ball ? inCourt : 'studio');
  }

  /** A mouse that aims does not turn the camera. */
  #steerByMouse(): void {
    const { settings, headset, mouse, stage } = this.#options;
    const steering = this.name !== 'studio' && settings.mouse && !headset.worn && !this.#watching;
    mouse.setEnabled(steering);
    stage.view.setOrbit(!steering);
  }
}
