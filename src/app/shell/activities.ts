import type { Calibration } from '../../core/body/calibration';
import { firstLine, reasonOf } from '../../core/errors/reasons';
import { type Buttons, nothingPressed } from '../../core/games/button-presses';
import type { Ray } from '../../core/math/ray';
import type { Side } from '../../core/math/side';
import type { Vec3 } from '../../core/math/vec3';
import type { PageClock } from '../../core/tracking/page-clock';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import type { Quality } from '../../scene/renderer';
import { readLimited } from '../../ui/limited-files';
import type { MouseAim } from '../../ui/mouse-aim';
import type { Notices } from '../../ui/notices';
import type { Pulse } from '../../xr/haptics';
import type { ArcheryActivity } from '../archery/archery-activity';
import type { Performance } from '../archery/archery-play';
import type { BallActivity } from '../ball/ball-activity';
import type { StudyRun } from '../study/study-run';
import type { TaskPlace } from '../study/task-runner';
import type { Headset } from './headset';
import type { ActivityName, Shooter } from './play-bar';
import type { PreferenceStore } from './preferences';
import type { Settings } from './settings';
import { avatarFile, ownAvatarAt } from './shown-avatar';
import type { Stage, Watched } from './stage';
import type { ArcheryRunner } from './study-archery';
import type { BallRunner } from './study-ball';
import type { Switches } from './switches';

/** The court's middle, where a spectator looks at first, floor frame. */
const courtMiddle: Vec3 = { x: 0, y: 1, z: -2.4 };
/** How far hands close that carry a basket: they lie round its rim. */
const basketGrip = 0.8;

/** A study on this page, and what it hears of the games it plays. */
export interface JoinedStudy {
  readonly run: StudyRun;
  /** Every frame of the round on the page. */
  readonly archery: Pick<ArcheryRunner, 'played'>;
  /** Every frame of the match on the page. */
  readonly ball: Pick<BallRunner, 'played'>;
}

export interface ActivitiesOptions {
  readonly quality: Quality;
  readonly switches: Switches;
  readonly settings: Settings;
  readonly store: PreferenceStore;
  readonly notices: Pick<Notices, 'show'>;
  readonly clock: PageClock;
  readonly stage: Pick<Stage, 'studio' | 'view' | 'placeMirror'>;
  readonly mouse: MouseAim;
  readonly headset: Pick<Headset, 'worn' | 'emulator'>;
  /** Of whoever moves. */
  body(): Calibration;
  /** The newest tracked frame; null: none yet. */
  newestFrame(): TrackingFrame | null;
  /** null: nobody takes part in a study here. */
  study(): JoinedStudy | null;
  /** The colours of a seat for the own body; null: the user's own. */
  wear(palette: string | null): void;
  onCaption(text: string): void;
  /** Somewhere else now: filters and clocks begin again. */
  onArrival(): void;
  onChange(): void;
}

/** What people do here: look at themselves in the studio, shoot on the range, or play on the court. Games load when first played. */
export interface Activities {
  readonly name: ActivityName;
  /** On the way to a game that is still loading. */
  readonly arriving: boolean;
  readonly archery: ArcheryActivity | null;
  readonly ball: BallActivity | null;
  goTo(next: ActivityName): Promise<void>;
  /** Into the room again that this page has left or lost. */
  rejoin(): Promise<void>;
  /** The court in a study's room, on this participant's seat. */
  goToMatch(place: TaskPlace): Promise<void>;
  /** Another round, where rounds are not a study's. */
  restartRound(): void;
  /** A study's round: this layout, this long [s], from its signal on. */
  startRound(layout: number, seconds: number): void;
  /** Makes the round on the page one that waits. */
  resetRound(): void;
  /** A change of hands or rules; a round under way goes on unless it is counted differently. */
  rule(change: Partial<Pick<Settings, 'bowSide' | 'oneHanded' | 'everyHitCounts'>>): void;
  /** A hand for the bow, for this visit. */
  setBowSide(side: Side): void;
  setSound(on: boolean): void;
  /** The mouse or the actor plays, where nobody wears a headset. */
  chooseShooter(shooter: Shooter): void;
  /** With whom a spectator's camera goes; null: with nobody. */
  follow(seat: number | null): void;
  /** Whom the camera shows instead of an own body; null: there is one. */
  watched(): Watched | null;
  /** Once a frame, first. */
  begin(time: number): void;
  /** Head, hands and buttons of whoever plays by themselves, or by the mouse; null: nobody, here. */
  act(time: number): Performance | null;
  /** The tracked frame as play; what the hands feel of it. */
  play(frame: TrackingFrame, buttons: Buttons): readonly Pulse[];
  /** How far a hand is closed, 0 to 1. */
  grip(side: Side, buttons: Buttons): number;
  show(time: number, frame: TrackingFrame | null): void;
  /** What a ray meets of a game's sheets: the distance [m]; null: nothing. `press`: does what it says. */
  point(ray: Ray, press: boolean): number | null;
}

export function createActivities(options: ActivitiesOptions): Activities {
  const { quality, switches, settings, store, notices, mouse, headset, body, study, onCaption, onChange } = options;
  const { studio, view, placeMirror } = options.stage;
  let archery: ArcheryActivity | null = null;
  let ball: BallActivity | null = null;
  let arriving = false;
  /** Where a study plays the ball game; null: where the address says. */
  let studyPlace: TaskPlace | null = null;
  let seed = switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31);
  /** Whether the camera stands where somebody without a body watches from. */
  let inTheStands = false;
  let worn: string | null = null;

  const name = (): ActivityName => (archery ? 'archery' : ball ? 'ball' : 'studio');
  const watching = () => ball !== null && !headset.worn && ball.play.newest !== null && ball.play.newest.me === null;
  const mirrorAside = () => placeMirror(archery ? settings.bowSide : null);

  function placeCamera(): void {
    inTheStands = watching();
    steerByMouse();
    const inCourt = inTheStands && settings.following === null ? 'stands' : 'court';
    view.setScene(archery ? 'range' : ball ? inCourt : 'studio');
  }

  /** A mouse that aims does not turn the camera. */
  function steerByMouse(): void {
    const steering = (archery !== null || ball !== null) && settings.mouse && !headset.worn && !watching();
    mouse.setEnabled(steering);
    view.setOrbit(!steering);
  }

  /** Browsers let a page sound only once somebody has touched it. */
  function wakeSound({ sound }: Pick<ArcheryActivity | BallActivity, 'sound'>): void {
    sound.setMuted(!settings.sound);
    if (!settings.sound) return;
    const silent = (error: unknown) => notices.show('info', `There is no sound: ${firstLine(reasonOf(error))}`);
    const wake = () => void sound.unlock().catch(silent);
    if (navigator.userActivation?.hasBeenActive) wake();
    else for (const event of ['pointerdown', 'keydown']) window.addEventListener(event, wake, { once: true });
  }

  function restart(): void {
    // Whoever plays seated shoots at targets as high for the eyes as everybody's.
    archery?.play.restart(body(), headset.worn ? options.newestFrame()?.head.position.y : undefined);
    onCaption('');
    onChange();
  }

  function restartRound(): void {
    if (study()) return;
    seed += 1;
    restart();
  }

  function leave(): void {
    archery?.dispose();
    archery = null;
    ball?.dispose();
    ball = null;
    options.wear(null);
    worn = null;
  }

  async function openRange(): Promise<void> {
    const { createArcheryActivity } = await import('../archery/archery-activity');
    archery = createArcheryActivity({
      quality,
      surroundings: studio,
      calibration: body(),
      settings: () => settings,
      seed: () => seed,
      onCaption,
    });
    wakeSound(archery);
  }

  async function openCourt(): Promise<void> {
    const place = studyPlace;
    const [{ createBallActivity }, { assignedSeat, connectionsFor }, mannequin] = await Promise.all([
      import('../ball/ball-activity'),
      import('../ball/ball-connections'),
      readLimited(ownAvatarAt, avatarFile),
    ]);
    ball = createBallActivity({
      quality,
      surroundings: studio,
      mannequin,
      connect: place
        ? await assignedSeat(place.seat, options.clock)
        : await connectionsFor(switches.room, {
            seed,
            clock: options.clock,
            ...(switches.seconds && { seconds: switches.seconds }),
            ...(switches.balls && { balls: switches.balls }),
          }),
      visitor: {
        name: place?.participant || settings.name || settings.guestName,
        calibration: body(),
        ...(place && { seat: place.members.indexOf(place.participant) }),
        ...(switches.spectate && { spectate: true }),
      },
      unnamed: !place && !settings.name,
      bots: () => settings.bots && place === null,
      acting: () => place === null && settings.actor && (!headset.worn || headset.emulator !== null),
      steering: () =>
        settings.mouse && !headset.worn
          ? { ray: view.rayThrough(mouse.x, mouse.y), pressed: mouse.pressed, cancelled: mouse.cancelled }
          : null,
      seed,
      onCaption,
    });
    wakeSound(ball);
  }

  async function goTo(next: ActivityName): Promise<void> {
    if (arriving || next === name()) return;
    leave();
    if (next !== 'studio') {
      arriving = true;
      onChange();
      try {
        await (next === 'archery' ? openRange() : openCourt());
      } catch (error) {
        const place = next === 'archery' ? 'The archery range' : 'The ball court';
        notices.show('error', `${place} could not be opened: ${firstLine(reasonOf(error))}`);
      }
      arriving = false;
    }
    settings.following = null;
    placeCamera();
    studio.setMarkVisible(name() === 'studio');
    mirrorAside();
    steerByMouse();
    onCaption('');
    options.onArrival();
  }

  return {
    get name() {
      return name();
    },
    get arriving() {
      return arriving;
    },
    get archery() {
      return archery;
    },
    get ball() {
      return ball;
    },
    goTo,
    async rejoin() {
      if (!ball || arriving) return;
      leave();
      await goTo('ball');
    },
    async goToMatch(place) {
      if (ball) await goTo('studio');
      studyPlace = place;
      await goTo('ball');
    },
    restartRound,
    startRound(layout, seconds) {
      Object.assign(settings, { seconds, everyHitCounts: false });
      seed = layout;
      restart();
      archery?.play.signal();
    },
    resetRound: restart,
    rule(change) {
      Object.assign(settings, change);
      store.remember(change);
      mirrorAside();
      if (change.everyHitCounts !== undefined || settings.actor) restartRound();
      onChange();
    },
    setBowSide(side) {
      settings.bowSide = side;
      mirrorAside();
    },
    setSound(on) {
      settings.sound = on;
      store.remember({ sound: on });
      for (const game of [archery, ball]) if (game) wakeSound(game);
      onChange();
    },
    chooseShooter(shooter) {
      settings.actor = true;
      settings.mouse = shooter === 'mouse';
      steerByMouse();
      restartRound();
    },
    follow(seat) {
      settings.following = seat;
      placeCamera();
      onChange();
    },
    watched() {
      if (!watching()) return null;
      const followed = settings.following === null ? null : ball?.bodyOf(settings.following);
      return followed ?? { pelvis: courtMiddle, eyes: view.pose };
    },
    begin: (time) => ball?.begin(time),
    act(time) {
      if (study()?.run.idle) return null;
      const player = ball?.act(time, !headset.worn);
      if (player || !archery) return player ?? null;
      if (!settings.mouse || headset.worn) return archery.play.act(time);
      return archery.play.steer(time, view.rayThrough(mouse.x, mouse.y), mouse);
    },
    play(frame, allButtons) {
      const joined = study();
      const buttons = joined?.run.idle ? nothingPressed : allButtons;
      if (archery && !joined?.run.paused) {
        const { haptics, taken, eventful } = archery.follow(frame, buttons);
        if (archery.play.newest) joined?.archery.played(archery.play.newest);
        if (taken) {
          settings.bowSide = taken;
          store.remember({ bowSide: taken });
          mirrorAside();
        }
        if (eventful) onChange();
        return haptics;
      }
      if (!ball) return [];
      const haptics = ball.follow(frame, buttons);
      if (ball.play.newest) joined?.ball.played(ball.play.newest);
      return haptics;
    },
    grip(side, buttons) {
      if (!study()?.run.idle && archery?.holds(side)) return 1;
      if (ball?.play.newest?.role === 'holder') return basketGrip;
      const { trigger, grip, pinch } = buttons[side];
      return Math.max(trigger, grip, pinch);
    },
    show(time, frame) {
      if (archery && frame) archery.show(frame.head, !study()?.run.idle);
      if (!ball) return;
      const eyes = watching() ? view.pose : (frame ?? options.newestFrame())?.head;
      ball.show(time, eyes ?? view.pose, frame !== null);
      if (worn !== ball.palette) {
        worn = ball.palette;
        options.wear(worn);
      }
      if (watching() !== inTheStands) placeCamera();
    },
    point(ray, press) {
      if (!archery) return ball?.point(ray, press) ?? null;
      const distance = archery.restartAt(ray);
      archery.setHovered(distance !== null);
      if (distance !== null && press) restartRound();
      return distance;
    },
  };
}
