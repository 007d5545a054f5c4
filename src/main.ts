import { PerspectiveCamera, Raycaster, Vector2 } from 'three';
import { createArcheryPlay, probeOf, roundOf } from './archery-play';
import { type Avatar, createAvatar } from './avatar/avatar';
import { createDebugSkeleton } from './avatar/debug-skeleton';
import { createHeadLoss } from './avatar/head-loss';
import { loadAvatar } from './avatar/load-avatar';
import { createMirror } from './avatar/mirror';
import { palettes } from './avatar/palettes';
import { validateInWorker } from './avatar/validate-in-worker';
import type { BallActivity } from './ball-activity';
import {
  armSpanFromFingertipSpan,
  armSpanRange,
  type Calibration,
  calibrationComplaint,
  defaultCalibration,
  eyeHeightFromStature,
  fingertipSpanFromArmSpan,
  provisionalCalibration,
  statureFromEyeHeight,
  statureRange,
} from './core/body/calibration';
import { createEstimator } from './core/estimation/estimators';
import type { EstimatorName } from './core/estimation/pose-estimator';
import { allReleased, type Buttons } from './core/games/button-presses';
import type { Pose } from './core/math/pose';
import { identity } from './core/math/quat';
import { zero } from './core/math/vec3';
import type { TrackingFrame } from './core/tracking/tracking-frame';
import { createEstimatorChoice, reasonOf } from './estimator-choice';
import { createFrameLoop, withTiming } from './frame-loop';
import { createFrameTiming, stageNames } from './frame-timing';
import type { ArcheryView } from './games/archery/archery-view';
import { eventHaptics } from './games/archery/haptics';
import { exposeProbe } from './probe';
import { createRecorder } from './recorder';
import { createArena } from './scene/arena';
import { createDesktopView, type ViewName, viewNames } from './scene/desktop-view';
import { affordableQuality, createRenderer, easeEmulatedPicture, fitToWindow } from './scene/renderer';
import { createVignette } from './scene/vignette';
import type { TaskPlace } from './study/task-runner';
import type { StudyRun } from './study-run';
import { type CalibrationStep, createCalibrationDialog } from './ui/calibration-dialog';
import { createCalibrationGuide } from './ui/calibration-guide';
import { offerDownload } from './ui/downloads';
import { acceptDroppedFiles } from './ui/dropped-files';
import { pageElement } from './ui/element';
import { createEnterButton } from './ui/enter-button';
import { estimatorOrder, estimatorTexts } from './ui/estimator-texts';
import { createMouseAim } from './ui/mouse-aim';
import { createNotices } from './ui/notices';
import { createOverlay, type FrameReport } from './ui/overlay';
import { createPanel } from './ui/panel';
import { type ActivityName, createPlayBar } from './ui/play-bar';
import { browserStorage, createPreferenceStore } from './ui/preferences';
import { createProgress } from './ui/progress';
import { listenToShortcuts } from './ui/shortcuts';
import { readSwitches } from './ui/switches';
import { createVrMenu } from './ui/vr-menu';
import { createVrPointers } from './ui/vr-pointers';
import { createActor } from './xr/actor';
import { type Emulator, installEmulator } from './xr/emulator';
import { buzz } from './xr/haptics';
import { describeXrSupport, requestVrSession } from './xr/session';
import { createTracker, type Tracker } from './xr/tracker';

/** Where our own networks and avatar lie, on our own server. */
const modelsAt = '/models/';
const ownAvatarAt = '/avatars/mannequin.vrm';

/** Milliseconds between two looks at the ring buffers: fast enough to follow, slow enough to read. */
const reportEveryMs = 250;
/** The rate [Hz] at which a window, and the emulator in it, draws. */
const windowRateHz = 60;
/** Seconds of tracked frames after which the headset's height says something about who wears it. */
const settleSeconds = 0.7;
/** What the mannequin's mirror and the menu are placed by: the user stands at the origin and looks along −Z. */
const mirrorDistance = 1.5;
/** Beside the range the mirror stands out of the arrows' way, on the side the archer's chest faces [m, rad]. */
const mirrorByTheRange = { x: 1.95, z: -0.1, turned: -1.3 };
/** The room's floor is the range's: its zone lies about the origin, the targets ahead. */
const floorFromArena = { position: zero, orientation: identity };
/** Parts of the court's middle, from where a spectator looks at first, arena frame. */
const courtMiddle = { x: 0, y: 1, z: -2.4 };
/** How much larger the menu in the headset is for who wants larger text. */
const largerMenu = 1.3;
/** How far one push of a stick turns [rad]. */
const snapAngle = Math.PI / 6;
const nothingPressed: Buttons = { left: allReleased, right: allReleased };

type Triple = readonly [number, number, number];
const triple = ({ x, y, z }: { readonly x: number; readonly y: number; readonly z: number }): Triple => [x, y, z];

interface ActiveSession {
  readonly xr: XRSession;
  readonly tracker: Tracker;
  /** When the first frame was tracked [s]; 'done' once the height of the headset was taken. */
  settledSince: number | 'done' | null;
}

const firstLine = (text: string): string => text.split('\n')[0] ?? text;

/** Resolves at the first animation frame at which the condition holds. */
function until(condition: () => boolean): Promise<void> {
  return new Promise((resolve) => {
    const look = () => (condition() ? resolve() : requestAnimationFrame(look));
    look();
  });
}

async function start(): Promise<void> {
  const marks: Record<string, number> = {};
  const mark = (name: string) => {
    marks[name] ??= Math.round(performance.now());
  };
  mark('script');

  const notices = createNotices(pageElement('notices', HTMLElement));
  const { switches, complaints } = readSwitches(location.search);
  const store = createPreferenceStore(browserStorage());
  for (const complaint of [...complaints, store.complaint]) if (complaint) notices.show('warning', complaint);
  window.addEventListener('error', ({ message }) =>
    notices.show('error', `Something went wrong: ${firstLine(message)}`),
  );
  window.addEventListener('unhandledrejection', ({ reason }) =>
    notices.show('error', `Something went wrong: ${firstLine(reasonOf(reason))}`),
  );

  const progress = createProgress([
    { name: 'the avatar', weight: 3 },
    { name: 'the network', weight: 3 },
    { name: 'the first picture', weight: 1 },
  ]);

  // Everything that travels starts at once; only then is anything built.
  const avatarArrives = loadAvatar(switches.avatar ?? ownAvatarAt, {
    onProgress: (part) => progress.report('the avatar', part),
    ...(switches.avatar && { validate: validateInWorker }),
  });
  avatarArrives.catch(() => undefined);
  const inferenceArrives = import('./inference/load-regressor');
  inferenceArrives.catch(() => undefined);

  const timing = createFrameTiming(() => performance.now());
  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const renderer = createRenderer(canvas, quality);
  const arena = createArena(renderer, quality);
  const view = createDesktopView(canvas);
  const mirror = createMirror({
    distance: mirrorDistance,
    ...(quality === 'low' && { resolution: 400, samples: 0 }),
  });
  const skeletonLines = createDebugSkeleton();
  const headLoss = createHeadLoss();
  const vignette = createVignette();
  arena.scene.add(mirror.object, skeletonLines.object, vignette.object);
  mark('scene');

  // What the user set; `show` brings it on the screen.
  const settings = {
    mirror: store.preferences.mirror ?? true,
    upperBodyOnly: store.preferences.upperBodyOnly ?? false,
    debugSkeleton: false,
    overlay: store.preferences.overlay ?? window.innerWidth > 760,
    vrOverlay: false,
    largerText: store.preferences.largerText ?? false,
    palette: store.preferences.palette ?? 'porcelain',
    actor: switches.actor,
    /** On the range, without a headset: the mouse shoots instead of the archer. */
    mouse: false,
    emulatorPanel: true,
    bowSide: store.preferences.bowSide ?? ('left' as const),
    oneHanded: store.preferences.oneHanded ?? false,
    everyHitCounts: store.preferences.everyHitCounts ?? false,
    ...(switches.seconds && { seconds: switches.seconds }),
    sound: store.preferences.sound ?? true,
    bots: switches.bots ?? (switches.room ? false : (store.preferences.bots ?? true)),
    name: switches.name ?? store.preferences.name ?? '',
    /** Whom a spectator's camera follows: a seat, or null: free. */
    following: null as number | null,
    calibration: store.preferences.calibration ?? defaultCalibration,
    calibrationSource: store.preferences.calibration ? 'remembered' : 'not calibrated yet',
  };
  const calibrated = () => store.preferences.calibration !== undefined;

  const choice = createEstimatorChoice({
    calibration: settings.calibration,
    create: createEstimator,
    async load(name) {
      const { loadRegressor } = await inferenceArrives;
      const loaded = await loadRegressor(`${modelsAt}${name}.json`, {
        provider: switches.executionProvider,
        onProgress: (part) => progress.report('the network', 0.9 * part),
        onProviderFallback: (reason) => notices.show('warning', reason),
      });
      return withTiming(loaded, timing);
    },
    onChange: () => show(),
    onFault(name, reason) {
      const { label } = estimatorTexts[name];
      notices.show('warning', `${label} could not be used (${firstLine(reason)}): inverse kinematics takes over.`);
    },
  });

  // Who moves the body: a session, a replay, the actor, or the emulator that somebody steers.
  const recorder = createRecorder();
  const actor = createActor();
  let emulator: Emulator | null = null;
  let session: ActiveSession | null = null;
  let replayedBody: Calibration | null = null;

  const mouse = createMouseAim(canvas);
  const pointing = new Raycaster();
  /** What the hands of the newest frame press. */
  let buttons: Buttons = nothingPressed;

  /** Somebody who needs nobody: the actor in the studio, the archer on the range. */
  function perform(time: number): { readonly frame: TrackingFrame; readonly buttons: Buttons } {
    const player = study?.idle ? null : ball?.act(time, session === null);
    if (player) return player;
    if (!archery || study?.idle) return { frame: actor.frameAt(time), buttons: nothingPressed };
    if (!settings.mouse || session) return archery.play.act(time);
    pointing.setFromCamera(new Vector2(mouse.x, mouse.y), view.camera);
    const { origin, direction } = pointing.ray;
    return archery.play.steer(time, { origin: { ...origin }, direction: { ...direction } }, mouse);
  }

  function track(timeMs: number, deviceFrame: XRFrame | undefined): TrackingFrame | null {
    const time = timeMs / 1000;
    buttons = nothingPressed;
    ball?.begin(time);
    if (session) {
      if (emulator && settings.actor && !study?.idle) {
        // What the actor does now is seen with the next frame: the device froze this one before it called.
        const performed = perform(time);
        emulator.drive(performed.frame, performed.buttons);
      }
      const tracked = deviceFrame ? session.tracker.read(deviceFrame, time) : null;
      buttons = session.tracker.buttons;
      return tracked;
    }
    const replayed = recorder.sample(time);
    if (replayed) return replayed;
    if (watching()) return null;
    if (!settings.actor && emulator) return emulator.read(time);
    const performed = perform(time);
    buttons = performed.buttons;
    return performed.frame;
  }

  /** The body that fits whoever moves: a recording brings its own person along. */
  const bodyNow = () => (recorder.mode === 'replaying' && replayedBody) || settings.calibration;

  // Archery: loaded when somebody first goes there; null in the studio.
  let archery: { readonly play: ReturnType<typeof createArcheryPlay>; readonly view: ArcheryView } | null = null;
  /** The ball game, likewise. */
  let ball: BallActivity | null = null;
  const activity = (): ActivityName => (archery ? 'archery' : ball ? 'ball' : 'studio');
  /** Without a seat and without a headset there is no body of one's own. */
  const watching = () => ball !== null && !session && ball.play.newest !== null && ball.play.newest.me === null;
  let arriving = false;
  /** A study that the address asks for; it decides what is played and with which body. */
  let study: StudyRun | null = null;
  let seed = switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31);

  const banner = pageElement('banner', HTMLElement);
  const playBar = createPlayBar(pageElement('play', HTMLElement), {
    goTo: (activity) => void goTo(activity),
    restart: () => restartRound(),
    chooseShooter(shooter) {
      settings.actor = true;
      settings.mouse = shooter === 'mouse';
      steerByMouse();
      restartRound();
    },
    setBowSide: (side) => rule({ bowSide: side }),
    setOneHanded: (on) => rule({ oneHanded: on }),
    setEveryHitCounts: (on) => rule({ everyHitCounts: on }),
    setSound(on) {
      settings.sound = on;
      store.remember({ sound: on });
      archery?.view.sound.setMuted(!on);
      ball?.sound.setMuted(!on);
      if (archery) wakeSound(archery.view);
      if (ball) wakeSound(ball);
      show();
    },
    ball: {
      ready: (on) => ball?.play.ready(on),
      rotate: (on) => ball?.play.rotate(on),
      sit: (seat) => ball?.play.sit(seat),
      setBots(on) {
        settings.bots = on;
        store.remember({ bots: on });
      },
      setName(name) {
        settings.name = name;
        store.remember({ name });
        notices.show('info', 'The others see your new name when you join the next time.');
      },
      openRoom() {
        const letters = Array.from(
          crypto.getRandomValues(new Uint8Array(6)),
          (byte) => 'abcdefghjkmnpqrstuvwxyz'[byte % 23],
        );
        location.search = `?play=ball&room=${letters.join('')}`;
      },
      follow(seat) {
        settings.following = seat;
        placeCamera();
        show();
      },
    },
  });

  const silent = (error: unknown) => notices.show('info', `There is no sound: ${firstLine(reasonOf(error))}`);

  /** Browsers let a page sound only once somebody has touched it. */
  function wakeSound(of: Pick<ArcheryView, 'sound'>): void {
    if (!settings.sound) return;
    const wake = () => void of.sound.unlock().catch(silent);
    if (navigator.userActivation?.hasBeenActive) wake();
    else for (const event of ['pointerdown', 'keydown']) window.addEventListener(event, wake, { once: true });
  }

  /** A change of hands or rules; a round under way goes on unless it is counted differently. */
  function rule(change: Partial<Pick<typeof settings, 'bowSide' | 'oneHanded' | 'everyHitCounts'>>): void {
    Object.assign(settings, change);
    store.remember(change);
    placeMirror();
    if (change.everyHitCounts !== undefined || settings.actor) restartRound();
    show();
  }

  function restartRound(): void {
    // In a study rounds are the study's.
    if (study) return;
    seed += 1;
    restartPlay();
  }

  function restartPlay(): void {
    // Whoever plays seated shoots at targets as high for the eyes as everybody's.
    archery?.play.restart(bodyNow(), session ? newestFrame?.head.position.y : undefined);
    playBar.caption('');
    show();
  }

  /** A mouse that aims does not turn the camera. */
  function steerByMouse(): void {
    const steering = archery !== null && settings.mouse && !session;
    mouse.setEnabled(steering);
    view.setOrbit(!steering);
  }

  function placeMirror(): void {
    const { x, z, turned } = mirrorByTheRange;
    const side = settings.bowSide === 'left' ? 1 : -1;
    if (archery) mirror.place(side * x, z, side * turned);
    else mirror.place(0, -mirrorDistance, 0);
  }

  /** Leaves the range or the court for the studio. */
  function goBack(): void {
    archery?.view.bow.removeFromParent();
    archery?.view.dispose();
    archery = null;
    ball?.dispose();
    ball = null;
    arena.setSurroundings(null);
    if (avatar && ownAvatarShown) avatar.setPalette(settings.palette);
  }

  async function openRange(): Promise<void> {
    const { createArcheryView } = await import('./games/archery/archery-view');
    const play = createArcheryPlay(
      bodyNow(),
      () => settings,
      () => seed,
    );
    const view = createArcheryView({
      quality,
      floorFromArena,
      distances: play.targets.map(({ distance }) => distance),
      onCaption: (text) => playBar.caption(text),
    });
    view.sound.setMuted(!settings.sound);
    wakeSound(view);
    arena.setSurroundings(view.range);
    arena.scene.add(view.bow);
    archery = { play, view };
  }

  /** Where a study plays the ball game; null: where the address says. */
  let studyPlace: TaskPlace | null = null;

  async function openCourt(): Promise<void> {
    const place = studyPlace;
    const [{ createBallActivity }, { connectionsFor }, mannequin] = await Promise.all([
      import('./ball-activity'),
      import('./ball-connections'),
      fetch(ownAvatarAt).then((response) => {
        if (!response.ok) throw new Error(`the server answers ${response.status} to ${ownAvatarAt}`);
        return response.arrayBuffer();
      }),
    ]);
    ball = createBallActivity({
      quality,
      arena,
      mannequin,
      connect: await connectionsFor(place?.room ?? switches.room, {
        seed,
        ...(switches.seconds && { seconds: switches.seconds }),
        ...(switches.balls && { balls: switches.balls }),
      }),
      visitor: {
        name: place?.participant || settings.name || (settings.actor && !session ? 'Demo' : 'Player'),
        calibration: bodyNow(),
        ...(place && { seat: place.members.indexOf(place.participant) }),
        ...(switches.spectate && { spectate: true }),
      },
      bots: () => settings.bots && place === null,
      acting: () => place === null && settings.actor && (session === null || emulator !== null),
      seed,
      onCaption: (text) => playBar.caption(text),
    });
    ball.sound.setMuted(!settings.sound);
    wakeSound(ball);
  }

  async function goTo(next: ActivityName): Promise<void> {
    if (arriving || next === activity()) return;
    goBack();
    if (next !== 'studio') {
      arriving = true;
      show();
      try {
        await (next === 'archery' ? openRange() : openCourt());
      } catch (error) {
        const place = next === 'archery' ? 'The archery range' : 'The ball court';
        notices.show('error', `${place} could not be opened: ${firstLine(reasonOf(error))}`);
      }
      arriving = false;
    }
    recorder.stop();
    if (activity() !== 'studio') panel.setOpen(false);
    settings.following = null;
    placeCamera();
    document.body.classList.toggle('on-the-range', activity() !== 'studio');
    arena.setMarkVisible(activity() === 'studio');
    placeMirror();
    steerByMouse();
    playBar.caption('');
    choice.reset();
    timing.reset();
    show();
  }

  function placeCamera(): void {
    view.setScene(
      archery ? 'range' : ball ? (watching() && settings.following === null ? 'stands' : 'court') : 'studio',
    );
  }

  function fit(): void {
    const calibration = bodyNow();
    choice.calibrate(calibration);
    actor.calibrate(calibration);
    ball?.play.calibrate(calibration);
    avatar?.fitTo(calibration);
  }

  function calibrate(calibration: Calibration, source: string, remember: boolean): void {
    settings.calibration = calibration;
    settings.calibrationSource = source;
    if (remember) store.remember({ calibration });
    fit();
    show();
  }

  const dialog = createCalibrationDialog(
    () => guide.cancel(),
    () => guide.start(),
  );
  let calibrationStep: CalibrationStep | null = null;
  const guide = createCalibrationGuide({
    onStep(step) {
      calibrationStep = step;
      if (!session && step) dialog.show(step);
      else dialog.hide();
      showInHeadset();
    },
    onMeasured: (calibration) => calibrate(calibration, 'measured', true),
    closesItself: () => session !== null,
  });

  // The avatar. One is shown at a time; another takes its place only when it has arrived whole.
  let avatar: Avatar | null = null;
  let avatarName = 'Mannequin';
  let ownAvatarShown = true;

  function showAvatar(next: Avatar, name: string, own: boolean): void {
    if (avatar) {
      arena.scene.remove(avatar.object);
      avatar.dispose();
    }
    avatar = next;
    avatarName = name;
    ownAvatarShown = own;
    arena.scene.add(avatar.object);
    if (own) avatar.setPalette(settings.palette);
    avatar.setUpperBodyOnly(settings.upperBodyOnly);
    avatar.fitTo(bodyNow());
    show();
  }

  async function openAvatar(source: string | File, name: string, own = false): Promise<void> {
    try {
      showAvatar(createAvatar(await loadAvatar(source, own ? {} : { validate: validateInWorker })), name, own);
      if (!own) notices.show('info', `${name} is your avatar now.`);
    } catch (error) {
      notices.show('error', `${name} could not be shown: ${firstLine(reasonOf(error))}`);
    }
  }

  async function openRecording(name: string, text: Promise<string>): Promise<void> {
    try {
      const recording = recorder.open(name, await text);
      replayedBody = recording.calibration;
      replay();
    } catch (error) {
      notices.show('error', `${name} could not be replayed: ${firstLine(reasonOf(error))}`);
    }
  }

  function replay(): void {
    recorder.replay();
    choice.reset();
    fit();
    show();
  }

  function openFile(file: File): void {
    if (/\.json$/i.test(file.name)) void openRecording(file.name, file.text());
    else void openAvatar(file, file.name);
  }

  /** The floor lies elsewhere from one frame to the next: nothing may be drawn on the way. */
  function jumped(): void {
    ball?.play.jumped();
    choice.reset();
  }

  function recentre(): void {
    if (session) session.tracker.recentre();
    else view.recentre();
    jumped();
  }

  /** A push of a stick turns whoever stands there, behind a vignette. */
  function turnByStick(time: number): void {
    const way = session?.tracker.takeTurn() ?? 0;
    if (way === 0) return;
    session?.tracker.turn(way * snapAngle);
    vignette.close(time);
    jumped();
  }

  function toggle(name: 'mirror' | 'upperBodyOnly' | 'overlay' | 'largerText', on: boolean): void {
    settings[name] = on;
    store.remember({ [name]: on });
    show();
  }

  function chooseEstimator(name: EstimatorName): void {
    store.remember({ estimator: name });
    void choice.choose(name);
  }

  function chooseView(name: ViewName): void {
    view.setView(name);
    show();
  }

  const setDebugSkeleton = (on: boolean) => {
    settings.debugSkeleton = on;
    show();
  };

  function startGuide(): void {
    if (session || !settings.actor) guide.start();
    else notices.show('info', 'This measures whoever wears the headset: enter VR first, or type your measures.');
  }

  const panel = createPanel(
    pageElement('controls', HTMLElement),
    {
      palettes,
      height: { min: 100 * statureRange.min, max: 100 * statureRange.max },
      armSpan: {
        min: 100 * fingertipSpanFromArmSpan(armSpanRange.min),
        max: 100 * fingertipSpanFromArmSpan(armSpanRange.max),
      },
    },
    {
      chooseEstimator,
      chooseView,
      setMirror: (on) => toggle('mirror', on),
      setUpperBodyOnly: (on) => toggle('upperBodyOnly', on),
      setOverlay: (on) => toggle('overlay', on),
      setLargerText: (on) => toggle('largerText', on),
      setDebugSkeleton,
      choosePalette(name) {
        settings.palette = name;
        store.remember({ palette: name });
        avatar?.setPalette(name);
        show();
      },
      openAvatarFile: openFile,
      openAvatarUrl: (url) => void openAvatar(url, url.split('/').at(-1) ?? url),
      showOwnAvatar: () => void openAvatar(ownAvatarAt, 'Mannequin', true),
      calibrate: startGuide,
      setMeasures({ heightCm, armSpanCm }) {
        const calibration = {
          eyeHeight: eyeHeightFromStature(heightCm / 100),
          armSpan: armSpanFromFingertipSpan(armSpanCm / 100),
        };
        const complaint = calibrationComplaint(calibration);
        if (complaint) notices.show('warning', complaint);
        else calibrate(calibration, 'by hand', true);
      },
      resetCalibration() {
        store.remember({ calibration: undefined });
        calibrate(defaultCalibration, 'not calibrated yet', false);
      },
      setActor(on) {
        settings.actor = on;
        choice.reset();
        // Without the actor somebody must hold the headset: a real one, or the emulated one.
        if (on) show();
        else void ensureEmulator().then((there) => there?.release());
      },
      setEmulatorPanel(on) {
        settings.emulatorPanel = on;
        void emulator?.setPanelVisible(on);
        show();
      },
      recentre,
      exitVr: () => void session?.xr.end(),
      record() {
        recorder.record({
          device: session ? (emulator ? 'emulated headset' : 'headset') : settings.actor ? 'actor' : 'emulated headset',
          rateHz: timing.summary().rateHz,
          calibration: settings.calibration,
        });
        show();
      },
      stop() {
        recorder.stop();
        fit();
        show();
      },
      replay,
      download() {
        const file = recorder.file();
        if (file) offerDownload(file.name, 'application/json', file.text);
      },
      openRecording: (file) => void openRecording(file.name, file.text()),
      setLoop(on) {
        recorder.setLoop(on);
        show();
      },
    },
  );
  const overlay = createOverlay(pageElement('overlay', HTMLElement));

  // In the headset.
  const headsetCamera = new PerspectiveCamera(70, 1, 0.05, 90);
  const pointers = createVrPointers(renderer);
  const menu = createVrMenu({
    chooseEstimator,
    calibrate: () => guide.start(),
    cancelCalibration: () => guide.cancel(),
    recentre,
    setOverlay(on) {
      settings.vrOverlay = on;
      showInHeadset();
    },
    goTo: (activity) => void goTo(activity),
    setBowSide: (side) => rule({ bowSide: side }),
    restart: restartRound,
    ready: (on) => ball?.play.ready(on),
    exit: () => void session?.xr.end(),
  });
  pointers.objects.visible = false;
  arena.scene.add(menu.object, pointers.objects);

  function showInHeadset(): void {
    const ballRound = ball?.round() ?? null;
    menu.show({
      estimator: choice.current.name,
      unavailable: choice.unavailable,
      calibration: calibrationStep,
      overlay: settings.vrOverlay,
      activity: activity(),
      bowSide: settings.bowSide,
      roundOver: archery?.play.newest?.state.phase === 'over',
      ready: ballRound && ballRound.seat !== null && ballRound.phase !== 'running' ? ballRound.ready : null,
      notice: ball?.banner() ?? notices.current().at(-1)?.text ?? null,
    });
  }

  async function joinStudy(asked: NonNullable<typeof switches.study>): Promise<StudyRun> {
    const { createStudyRun } = await import('./study-run');
    const run = createStudyRun(asked, {
      enterVr: enter,
      inSession: () => session !== null,
      calibration: () => settings.calibration,
      setCalibration: (calibration) => calibrate(calibration, 'measured', false),
      chooseEstimator: (name) => choice.choose(name),
      estimator: () => choice.current.name,
      setActor(on) {
        settings.actor = on && switches.actor;
      },
      setBowSide(side) {
        settings.bowSide = side;
        placeMirror();
      },
      async goToArchery() {
        await goTo('archery');
        if (!archery) throw new Error('The archery range could not be opened.');
      },
      async goToBall(place) {
        if (ball) await goTo('studio');
        studyPlace = place;
        await goTo('ball');
        if (!ball) throw new Error('The ball court could not be opened.');
      },
      ball: () => ball?.play ?? null,
      leaveBall: () => void goTo('studio'),
      startRound(layout, seconds) {
        Object.assign(settings, { seconds, everyHitCounts: false });
        seed = layout;
        restartPlay();
        archery?.play.signal();
      },
      resetRound: restartPlay,
      assists: () => (settings.oneHanded ? ['one hand'] : []),
      device: () => ({
        name: (emulator ? `emulated headset in ${navigator.userAgent}` : navigator.userAgent).slice(0, 160),
        refreshRateHz: session?.xr.frameRate ?? (emulator ? windowRateHz : null),
        input: settings.actor ? 'simulated' : emulator ? 'emulated' : (session?.tracker.input ?? 'controllers'),
      }),
      listenToFrames: (listener) => timing.listen(listener),
    });
    arena.scene.add(run.object);
    return run;
  }

  const enterButton = createEnterButton(pageElement('enter', HTMLDivElement), () => void enter());

  /** Controls cover a part of the window: the body stands in the middle of the rest. */
  function layOut(): void {
    const narrow = window.innerWidth <= 760;
    const right = narrow || !panel.open ? 0 : 352;
    document.body.classList.toggle('panel-open', panel.open);
    document.body.style.setProperty('--panel-inset', `${right}px`);
    const bottom = !narrow ? 110 : panel.open ? window.innerHeight * 0.48 : 130;
    view.setInsets({ left: 0, right, bottom });
    view.resize();
    fitToWindow(renderer, quality);
  }
  window.addEventListener('resize', layOut);
  pageElement('controls', HTMLElement).addEventListener('toggle', layOut);

  function show(): void {
    const { calibration } = settings;
    overlay.setVisible(settings.overlay);
    document.body.classList.toggle('larger-text', settings.largerText);
    menu.object.scale.setScalar(settings.largerText ? largerMenu : 1);
    skeletonLines.setVisible(settings.debugSkeleton);
    avatar?.setUpperBodyOnly(settings.upperBodyOnly);
    panel.show({
      ...settings,
      estimator: choice.wanted,
      unavailable: choice.unavailable,
      view: view.view,
      avatarName,
      palette: ownAvatarShown ? settings.palette : null,
      heightCm: 100 * statureFromEyeHeight(calibration.eyeHeight),
      armSpanCm: 100 * fingertipSpanFromArmSpan(calibration.armSpan),
      eyeHeightCm: 100 * calibration.eyeHeight,
      emulated: emulator !== null,
      inSession: session !== null,
      recorder,
    });
    showPlay();
    showInHeadset();
  }

  /** Score and settings of the round, beside the picture. */
  function showPlay(): void {
    const round = archery?.play.newest;
    playBar.show({
      activity: activity(),
      arriving,
      ball: ball && {
        round: ball.round(),
        room: switches.room,
        bots: settings.bots,
        acting: settings.actor && !session,
        name: settings.name,
        following: settings.following,
      },
      round: round ? roundOf(round) : null,
      shooter: session || (!settings.actor && emulator) ? 'headset' : settings.mouse ? 'mouse' : 'actor',
      bowSide: settings.bowSide,
      oneHanded: settings.oneHanded,
      everyHitCounts: settings.everyHitCounts,
      sound: settings.sound,
      inSession: session !== null,
    });
  }

  listenToShortcuts(
    {
      ...Object.fromEntries(estimatorOrder.map((name, index) => [String(index + 1), () => chooseEstimator(name)])),
      v: () => chooseView(viewNames[(viewNames.indexOf(view.view) + 1) % viewNames.length] ?? 'third-person'),
      c: startGuide,
      r: recentre,
      m: () => toggle('mirror', !settings.mirror),
      b: () => setDebugSkeleton(!settings.debugSkeleton),
      u: () => toggle('upperBodyOnly', !settings.upperBodyOnly),
      o: () => toggle('overlay', !settings.overlay),
      p: () => panel.setOpen(!panel.open),
    },
    () => session === null && !dialog.visible && study === null,
  );
  acceptDroppedFiles(openFile);

  function frameReport(): FrameReport {
    const summary = timing.summary();
    return {
      ...summary,
      stages: stageNames.map((name) => ({ name, ...summary.stages[name] })),
      estimator: estimatorTexts[choice.current.name].label,
      provider: choice.regressor?.provider ?? 'no network',
    };
  }
  setInterval(() => {
    choice.check();
    const report = frameReport();
    overlay.show(report);
    menu.showReport(report);
    if (recorder.mode !== 'idle') show();
    else if (archery || ball) showPlay();
    if (ball) showInHeadset();
    showBanner();
  }, reportEveryMs);

  // Entering and leaving.
  let realHeadset = false;
  let panelOpenBefore = false;

  /** The emulator where there is no headset, loaded when it is first needed; null and a notice where it fails. */
  async function ensureEmulator(): Promise<Emulator | null> {
    if (realHeadset || emulator) return emulator;
    try {
      emulator = await installEmulator();
    } catch (error) {
      notices.show('error', `The emulated headset could not be loaded: ${firstLine(reasonOf(error))}`);
    }
    show();
    return emulator;
  }

  async function enter(): Promise<void> {
    try {
      if (!realHeadset) {
        const there = await ensureEmulator();
        if (!there) return;
        await there.setPanelVisible(settings.emulatorPanel);
      }
      const xrSession = await requestVrSession();
      await renderer.xr.setSession(xrSession);
      const space = renderer.xr.getReferenceSpace();
      if (!space) throw new Error('the headset offers no floor to stand on (local-floor)');
      if (emulator) easeEmulatedPicture(renderer, quality);
      recorder.stop();
      const tracker = createTracker(xrSession, space, (moved) => renderer.xr.setReferenceSpace(moved));
      session = { xr: xrSession, tracker, settledSince: null };
      xrSession.addEventListener('end', leave);
      xrSession.addEventListener('visibilitychange', () => {
        timing.reset();
        ball?.play.away(xrSession.visibilityState === 'hidden');
      });
      space.addEventListener('reset', jumped);
      timing.setRate(emulator ? windowRateHz : (xrSession.frameRate ?? 72));
      if (!settings.actor) emulator?.release();
      menu.setVisible(study === null);
      pointers.objects.visible = true;
      document.body.classList.add('in-session');
      panelOpenBefore = panel.open;
      panel.setOpen(false);
    } catch (error) {
      notices.show('error', `VR could not be entered: ${firstLine(reasonOf(error))}. The desktop view goes on.`);
    }
    timing.reset();
    choice.reset();
    fit();
    show();
    study?.sessionChanged();
  }

  function leave(): void {
    session = null;
    guide.cancel();
    menu.setVisible(false);
    pointers.objects.visible = false;
    document.body.classList.remove('in-session');
    panel.setOpen(panelOpenBefore);
    timing.setRate(windowRateHz);
    timing.reset();
    choice.reset();
    view.setView(view.view);
    layOut();
    show();
    study?.sessionChanged();
  }

  /** Somebody who never calibrated is as tall as their headset hangs high, once it hangs there calmly. */
  function settle(frame: TrackingFrame): void {
    if (!session || calibrated() || study?.measured || session.settledSince === 'done') return;
    session.settledSince ??= frame.time;
    if (frame.time - session.settledSince < settleSeconds) return;
    session.settledSince = 'done';
    calibrate(provisionalCalibration(frame.head.position.y), 'from the headset’s height', false);
  }

  /** The frame as play: seen with the picture, heard and felt at once. */
  function playRound(frame: TrackingFrame): void {
    if (!archery) return;
    if (study?.paused) return;
    const { events, cues, haptics } = archery.play.follow(frame, study?.idle ? nothingPressed : buttons);
    if (archery.play.newest) study?.played(archery.play.newest);
    const taken = cues.findLast(({ type }) => type === 'taken');
    if (taken) {
      settings.bowSide = taken.side;
      store.remember({ bowSide: taken.side });
      placeMirror();
    }
    archery.view.hear(events, cues);
    const bowSide = archery.play.newest?.bow?.bowSide ?? settings.bowSide;
    if (session) buzz(session.xr, [...haptics, ...eventHaptics(events, bowSide)]);
    if (events.length > 0) show();
  }

  /** The same of the ball game. */
  function playBall(frame: TrackingFrame): void {
    if (!ball) return;
    const pulses = ball.follow(frame, study?.idle ? nothingPressed : buttons);
    if (ball.play.newest) study?.playedBall(ball.play.newest);
    if (session) buzz(session.xr, pulses);
  }

  /** What a person should know of the connection to others. */
  function showBanner(): void {
    const text = ball?.banner() ?? '';
    if (banner.textContent === text) return;
    banner.textContent = text;
    banner.hidden = text === '';
  }

  /** From where and whereto the window's camera looks. */
  function cameraPose(): Pose<'floor'> {
    const { position, quaternion } = view.camera;
    const { x, y, z, w } = quaternion;
    return { position: { x: position.x, y: position.y, z: position.z }, orientation: { x, y, z, w } };
  }

  /** Whom the camera of somebody without a body looks at. */
  function lookedAt(): { readonly pelvis: { x: number; y: number; z: number }; readonly eyes: Pose<'floor'> } {
    const followed = settings.following === null ? null : ball?.bodyOf(settings.following);
    if (followed) return followed;
    return { pelvis: courtMiddle, eyes: cameraPose() };
  }

  /** How far a hand is closed: as its buttons say; round the bow it always is. */
  function gripOf(side: 'left' | 'right'): number {
    if (!study?.idle && archery?.play.newest?.bow?.bowSide === side) return 1;
    // Hands that carry a basket lie round its rim.
    if (ball?.play.newest?.role === 'holder') return 0.8;
    const { trigger, grip, pinch } = buttons[side];
    return Math.max(trigger, grip, pinch);
  }

  // A click on the result's button is another round.
  canvas.addEventListener('click', ({ clientX, clientY }) => {
    if ((!archery && !ball) || session || study) return;
    const { width, height } = canvas.getBoundingClientRect();
    pointing.setFromCamera(new Vector2((2 * clientX) / width - 1, 1 - (2 * clientY) / height), view.camera);
    const { origin, direction } = pointing.ray;
    if (archery && archery.view.result.restartAt(origin, direction) !== null) restartRound();
    ball?.point({ origin: { ...origin }, direction: { ...direction } }, true);
  });

  let scene = '';
  let palette: string | null = null;
  /** The match as it stands in this frame, and the own body in its seat's colours. */
  function showCourt(time: number, frame: TrackingFrame | null): void {
    if (!ball) return;
    const camera = cameraPose();
    const eyes = watching() ? camera : (frame ?? newestFrame)?.head;
    ball.show(time, eyes ?? camera, frame !== null);
    if (palette !== ball.palette) {
      palette = ball.palette;
      if (ownAvatarShown) avatar?.setPalette(palette ?? settings.palette);
    }
    const now = watching() ? 'stands' : 'court';
    if (now === scene) return;
    scene = now;
    placeCamera();
  }

  let frameCount = 0;
  let newestFrame: TrackingFrame | null = null;
  let lastTime = 0;
  let lastFault = '';

  const loop = createFrameLoop<XRFrame>(
    {
      track,
      observe(frame) {
        newestFrame = frame;
        recorder.observe(frame);
        guide.observe(frame);
        settle(frame);
        playRound(frame);
        playBall(frame);
      },
      estimator: () => choice.current,
      inferenceSettlesInFrame: () => choice.regressor?.resolvesInFrame ?? false,
      skin(pose, frame) {
        for (const side of ['left', 'right'] as const) avatar?.setGrip(side, gripOf(side));
        avatar?.apply(pose, frame.time);
        ball?.send(frame, pose, { left: gripOf('left'), right: gripOf('right') });
      },
      render(timeMs, frame) {
        const elapsed = Math.min(0.1, Math.max(0, (timeMs - lastTime) / 1000));
        lastTime = timeMs;
        frameCount += 1;
        const joints = avatar?.jointPositions() ?? {};
        skeletonLines.show(joints);
        const { hips } = joints;
        study?.frame(timeMs / 1000, frame);
        if (hips && !watching()) arena.follow(hips.x, hips.z);
        else if (watching()) arena.follow(courtMiddle.x, 100);
        if (session) {
          if (session.xr.visibilityState === 'visible') point();
          turnByStick(timeMs / 1000);
        } else if (watching()) {
          const { pelvis, eyes } = lookedAt();
          view.update(pelvis, eyes, elapsed);
        } else if (frame) {
          view.update(hips ?? { ...frame.head.position, y: frame.head.position.y * 0.58 }, frame.head, elapsed);
        }
        const played = archery?.play.newest;
        if (archery && played && frame) {
          archery.view.show(played.state, study?.idle ? null : played.bow, played.time, frame.head);
        }
        if (ball) showCourt(timeMs / 1000, frame);
        if (avatar) avatar.object.visible = !watching();
        avatar?.setOpacity(headLoss.follow(timeMs / 1000, frame !== null));
        vignette.show(timeMs / 1000, session && frame ? frame.head : null);
        const inside = session !== null || view.view === 'first-person';
        avatar?.setFirstPerson(inside);
        // Whoever looks from behind the mirror wants to see the body, not its back.
        mirror.setVisible(
          settings.mirror &&
            ball === null &&
            (inside || archery !== null || view.camera.position.z > 0.1 - mirrorDistance),
        );
        renderer.render(arena.scene, session ? headsetCamera : view.camera);
      },
      fail(error) {
        const text = firstLine(reasonOf(error));
        if (text !== lastFault) notices.show('error', `A frame could not be drawn: ${text}`);
        lastFault = text;
      },
    },
    timing,
  );

  /** What entering would mean: a real headset, or why not and the emulated one. */
  async function prepareSessions(): Promise<void> {
    const support = await describeXrSupport();
    realHeadset = support.kind === 'device' && !switches.emulate;
    enterButton.show({
      label: realHeadset ? 'Enter VR' : 'Enter VR (emulated)',
      sentence: realHeadset || switches.emulate ? null : `${support.sentence} An emulated headset takes its place.`,
      enabled: true,
    });
    if (switches.emulate || !settings.actor) await ensureEmulator();
  }

  canvas.addEventListener('webglcontextlost', () => {
    notices.show(
      'warning',
      session
        ? 'The graphics device was lost, and VR with it. Your game goes on: enter VR again.'
        : 'The graphics device was lost. The picture comes back as soon as the browser gives it back.',
    );
    // What the headset shows was drawn by the lost device; a session cannot be given another one.
    void session?.xr.end();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    arena.restore();
    timing.reset();
    notices.show('info', 'The graphics device is back.');
  });
  document.addEventListener('visibilitychange', () => {
    timing.reset();
    ball?.play.away(document.hidden);
  });

  let ready = false;
  exposeProbe(() => {
    const summary = timing.summary();
    const joints = avatar?.jointPositions() ?? {};
    return {
      ready,
      activity: session ? 'vr' : ready ? 'desktop' : 'loading',
      estimator: choice.current.name,
      provider: choice.regressor?.provider ?? 'none',
      frame: { ...summary, count: frameCount },
      avatar: {
        name: avatarName,
        joints: Object.fromEntries(Object.entries(joints).map(([name, at]) => [name, triple(at)])),
      },
      tracking: newestFrame && {
        time: newestFrame.time,
        head: triple(newestFrame.head.position),
        leftHand: newestFrame.leftHand && triple(newestFrame.leftHand.position),
        rightHand: newestFrame.rightHand && triple(newestFrame.rightHand.position),
      },
      calibration: { ...bodyNow(), source: settings.calibrationSource },
      session: { state: session?.xr.visibilityState ?? 'none', emulated: emulator !== null },
      view: view.view,
      recorder: { mode: recorder.mode, frames: recorder.frameCount, seconds: recorder.seconds },
      notices: notices.current(),
      loading: { ...marks },
      drawing: { ...renderer.info.memory, programs: renderer.info.programs?.length ?? 0, darkness: vignette.darkness },
      players: ball?.players() ?? [],
      game: archery?.play.newest ? probeOf(archery.play.newest) : (ball?.probe() ?? null),
      study: study?.probe() ?? null,
    };
  });

  /** Rays and finger tips: the menu first, then the result of a round. */
  function point(): void {
    const hands = pointers.take();
    if (study) {
      study.point(hands);
      return;
    }
    menu.point(hands);
    let hovered = false;
    for (const { origin, direction, pressed, showRay } of hands) {
      const distance = archery?.view.result.restartAt(origin, direction) ?? null;
      if (distance === null) continue;
      hovered = true;
      showRay(distance);
      if (pressed) restartRound();
    }
    archery?.view.result.setHovered(hovered);
    for (const { origin, direction, pressed, showRay } of hands) {
      const distance = ball?.point({ origin: { ...origin }, direction: { ...direction } }, pressed) ?? null;
      if (distance === null) continue;
      showRay(distance);
      // One hand's ray is lit; the other's would put the light out again.
      break;
    }
  }

  // The way to the first body: the chosen network loads beside the avatar, and IK draws until it is there.
  panel.setOpen(switches.panel && window.innerWidth > 760);
  if (switches.view) view.setView(switches.view);
  layOut();
  renderer.setAnimationLoop((timeMs, deviceFrame) => void loop(timeMs, deviceFrame ?? undefined));
  const sessionsPrepared = prepareSessions();
  const chosen = choice.choose(switches.estimator ?? store.preferences.estimator ?? 'learned');
  void chosen.then(() => progress.report('the network', 1));
  try {
    showAvatar(createAvatar(await avatarArrives), switches.avatar ?? 'Mannequin', switches.avatar === null);
  } catch (error) {
    notices.show('error', `The avatar could not be shown: ${firstLine(reasonOf(error))}`);
  }
  mark('avatar');
  progress.report('the avatar', 1);
  const drawn = frameCount;
  await until(() => frameCount > drawn);
  progress.report('the first picture', 1);
  progress.showBody();
  mark('firstBody');
  if (switches.replay) {
    const address = switches.replay;
    void openRecording(
      address,
      fetch(address).then((response) => {
        if (!response.ok) throw new Error(`the server answers ${response.status}`);
        return response.text();
      }),
    );
  }
  await Promise.all([chosen, sessionsPrepared, goTo(switches.play)]);
  if (switches.study) study = await joinStudy(switches.study);
  mark('estimator');
  progress.finish();
  ready = true;
  // Compiling shaders is loading, not drawing.
  timing.reset();
  show();
}

start().catch((error: unknown) => {
  const text = document.createElement('p');
  text.className = 'fault';
  text.setAttribute('role', 'alert');
  text.textContent = `threepoint cannot start: ${firstLine(reasonOf(error))}`;
  document.body.replaceChildren(text);
});
