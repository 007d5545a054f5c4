import { palettes } from '../../avatar/palettes';
import {
  armSpanFromFingertipSpan,
  armSpanRange,
  type Calibration,
  calibrationComplaint,
  defaultCalibration,
  eyeHeightFromStature,
  fingertipSpanFromArmSpan,
  statureFromEyeHeight,
  statureRange,
} from '../../core/body/calibration';
import { firstLine, reasonOf } from '../../core/errors/reasons';
import type { EstimatorName } from '../../core/estimation/pose-estimator';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import type { EstimatorChoice } from '../../lib/estimator-choice';
import { type ViewName, viewNames } from '../../scene/desktop-view';
import { type CalibrationStep, createCalibrationDialog } from '../../ui/calibration-dialog';
import { createCalibrationGuide } from '../../ui/calibration-guide';
import { offerDownload } from '../../ui/downloads';
import { acceptDroppedFiles } from '../../ui/dropped-files';
import { pageElement } from '../../ui/element';
import { createInvitation, type Invitation } from '../../ui/invitation';
import { type FileKind, nameOf, readLimited } from '../../ui/limited-files';
import type { Notices } from '../../ui/notices';
import { createOverlay, type FrameReport } from '../../ui/overlay';
import { listenToShortcuts } from '../../ui/shortcuts';
import { createVrPointers } from '../../ui/vr-pointers';
import type { Recorder } from '../studio/recorder';
import type { StudyRun } from '../study/study-run';
import type { Activities } from './activities';
import { estimatorOrder, estimatorTexts } from './estimator-texts';
import { type FrameTiming, stageNames } from './frame-timing';
import type { Headset } from './headset';
import { createPanel } from './panel';
import { createPlayBar } from './play-bar';
import type { PreferenceStore } from './preferences';
import type { Settings } from './settings';
import type { ShownAvatar } from './shown-avatar';
import type { Stage } from './stage';
import type { Switches } from './switches';
import { createVrMenu } from './vr-menu';

/** Milliseconds between two looks at the ring buffers: fast enough to follow, slow enough to read. */
const reportEveryMs = 250;
/** How much larger the menu in the headset is for who wants larger text. */
const largerMenu = 1.3;
/** Of a window [CSS pixels], up to which the controls lie below the picture instead of beside it. */
const narrowest = 760;
/** Between the body and the button that enters VR [CSS pixels]. */
const besideEnter = 8;
/** Twice what the recorder keeps at most. */
const recordingFile: FileKind = { what: 'a recording', megabytes: 100 };
/** Of an address that has just opened a room for others. */
const invitingHash = '#invite';
const roomLetters = 'abcdefghjkmnpqrstuvwxyz';

export interface ControlsOptions {
  readonly switches: Switches;
  readonly settings: Settings;
  readonly store: PreferenceStore;
  readonly notices: Notices;
  readonly timing: FrameTiming;
  readonly stage: Stage;
  readonly choice: EstimatorChoice;
  readonly recorder: Recorder;
  readonly headset: Headset;
  readonly avatar: ShownAvatar;
  readonly activities: Activities;
  /** null: nobody takes part in a study here. */
  study(): StudyRun | null;
  calibrate(calibration: Calibration, source: string, remember: boolean): void;
  /** The body of whoever is replayed from now on; null: the user's own. */
  replays(body: Calibration | null): void;
  /** Whoever moves is somebody else now: everything fits them. */
  refit(): void;
  recentre(): void;
}

/** Everything a person can press, read or type, on the desktop and in the headset; it keeps no state of the page's own. */
export interface Controls {
  /** Brings on the screen what the page is doing. */
  show(): void;
  /** The headset is on: the menu is there, and the panel out of the way; or off again. */
  setWorn(worn: boolean): void;
  setPanelOpen(open: boolean): void;
  caption(text: string): void;
  layOut(): void;
  /** Every tracked frame: somebody may be measured. */
  observe(frame: TrackingFrame): void;
  /** Rays and finger tips in the headset: the study or the menu first, then the sheets of a game. */
  point(): void;
  /** Replays a file of this device, or what an address answers. */
  openRecording(source: string | File): Promise<void>;
}

export function createControls(options: ControlsOptions): Controls {
  const { switches, settings, store, notices, timing, stage, choice, recorder, headset, avatar, activities } = options;
  const { study, calibrate, recentre } = options;
  const { studio, view } = stage;

  function remembered(change: Partial<Pick<Settings, 'mirror' | 'upperBodyOnly' | 'overlay' | 'largerText'>>): void {
    Object.assign(settings, change);
    store.remember(change);
    show();
  }

  function passing(change: Partial<Settings>): void {
    Object.assign(settings, change);
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

  // Measuring whoever stands there.
  const dialog = createCalibrationDialog(
    () => guide.cancel(),
    () => guide.start(),
  );
  let calibrationStep: CalibrationStep | null = null;
  const guide = createCalibrationGuide({
    onStep(step) {
      calibrationStep = step;
      if (!headset.worn && step) dialog.show(step);
      else dialog.hide();
      showInHeadset();
    },
    onMeasured: (calibration) => calibrate(calibration, 'measured', true),
    closesItself: () => headset.worn,
  });

  function startGuide(): void {
    if (headset.worn || !settings.actor) guide.start();
    else notices.show('info', 'This measures whoever wears the headset: enter VR first, or type your measures.');
  }

  // Files.
  async function openAvatar(source: string | File): Promise<void> {
    if (await avatar.open(source)) notices.show('info', `${avatar.name} is your avatar now.`);
  }

  /** Ours, also after a reload. */
  function showOwnAvatar(): void {
    const address = new URL(location.href);
    address.searchParams.delete('avatar');
    history.replaceState(null, '', address);
    void avatar.openOwn();
  }

  async function openRecording(source: string | File): Promise<void> {
    const name = nameOf(source);
    try {
      const recording = recorder.open(name, new TextDecoder().decode(await readLimited(source, recordingFile)));
      options.replays(recording.calibration);
      replay();
    } catch (error) {
      const reason = firstLine(reasonOf(error)).replace(`${name}: `, '');
      notices.show('error', `${name} could not be replayed: ${reason}`);
    }
  }

  function replay(): void {
    recorder.replay();
    choice.reset();
    options.refit();
    show();
  }

  function openFile(file: File): void {
    if (/\.json$/i.test(file.name)) void openRecording(file);
    else void openAvatar(file);
  }
  acceptDroppedFiles(openFile);

  // Others.
  let invitation: Invitation | null = null;
  function invite(): void {
    invitation ??= createInvitation();
    if (switches.room) invitation.open(switches.room);
  }
  if (location.hash === invitingHash) {
    history.replaceState(null, '', `${location.pathname}${location.search}`);
    invite();
  }

  const playBar = createPlayBar(pageElement('play', HTMLElement), {
    goTo: (activity) => void activities.goTo(activity),
    restart: activities.restartRound,
    chooseShooter: activities.chooseShooter,
    setBowSide: (side) => activities.rule({ bowSide: side }),
    setOneHanded: (on) => activities.rule({ oneHanded: on }),
    setEveryHitCounts: (on) => activities.rule({ everyHitCounts: on }),
    setSound: activities.setSound,
    ball: {
      ready: (on) => activities.ball?.play.ready(on),
      rotate: (on) => activities.ball?.play.rotate(on),
      sit: (seat) => activities.ball?.play.sit(seat),
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
        const random = crypto.getRandomValues(new Uint8Array(6));
        const name = Array.from(random, (byte) => roomLetters[byte % roomLetters.length]).join('');
        location.assign(`?play=ball&room=${name}${invitingHash}`);
      },
      invite,
      rejoin: () => void activities.rejoin(),
      follow: activities.follow,
      steer: (on) => activities.chooseShooter(on ? 'mouse' : 'actor'),
    },
  });

  const panelRegion = pageElement('controls', HTMLElement);
  const panel = createPanel(
    panelRegion,
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
      setMirror: (mirror) => remembered({ mirror }),
      setUpperBodyOnly: (upperBodyOnly) => remembered({ upperBodyOnly }),
      setOverlay: (overlay) => remembered({ overlay }),
      setLargerText: (largerText) => remembered({ largerText }),
      setDebugSkeleton: (debugSkeleton) => passing({ debugSkeleton }),
      choosePalette(palette) {
        settings.palette = palette;
        store.remember({ palette });
        avatar.wear(null);
        show();
      },
      openAvatarFile: openFile,
      openAvatarUrl: (url) => void openAvatar(url),
      showOwnAvatar,
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
        else void headset.ensureEmulator().then((there) => there?.release());
      },
      setEmulatorPanel(on) {
        void headset.emulator?.setPanelVisible(on);
        passing({ emulatorPanel: on });
      },
      recentre,
      exitVr: headset.exit,
      record() {
        const driven = headset.emulator || !headset.worn ? 'emulated headset' : 'headset';
        recorder.record({
          device: !headset.worn && settings.actor ? 'actor' : driven,
          rateHz: timing.summary().rateHz,
          calibration: settings.calibration,
        });
        show();
      },
      stop() {
        recorder.stop();
        options.refit();
        show();
      },
      replay,
      download() {
        const file = recorder.file();
        if (file) offerDownload(file.name, 'application/json', file.text);
      },
      openRecording: (file) => void openRecording(file),
      setLoop(on) {
        recorder.setLoop(on);
        show();
      },
    },
  );
  let panelOpenBefore = false;

  listenToShortcuts(
    {
      ...Object.fromEntries(estimatorOrder.map((name, index) => [String(index + 1), () => chooseEstimator(name)])),
      v: () => chooseView(viewNames[(viewNames.indexOf(view.view) + 1) % viewNames.length] ?? 'third-person'),
      c: startGuide,
      r: recentre,
      m: () => remembered({ mirror: !settings.mirror }),
      b: () => passing({ debugSkeleton: !settings.debugSkeleton }),
      u: () => remembered({ upperBodyOnly: !settings.upperBodyOnly }),
      o: () => remembered({ overlay: !settings.overlay }),
      p: () => panel.setOpen(!panel.open),
    },
    () => !headset.worn && !dialog.visible && study() === null,
  );

  // In the headset.
  const pointers = createVrPointers(stage.renderer);
  const menu = createVrMenu({
    chooseEstimator,
    calibrate: () => guide.start(),
    cancelCalibration: () => guide.cancel(),
    recentre,
    setOverlay(on) {
      settings.vrOverlay = on;
      showInHeadset();
    },
    goTo: (activity) => void activities.goTo(activity),
    setBowSide: (side) => activities.rule({ bowSide: side }),
    restart: activities.restartRound,
    ready: (on) => activities.ball?.play.ready(on),
    exit: headset.exit,
  });
  pointers.objects.visible = false;
  studio.scene.add(menu.object, pointers.objects);

  const overlay = createOverlay(pageElement('overlay', HTMLElement));
  const banner = pageElement('banner', HTMLElement);
  const enter = pageElement('enter', HTMLElement);

  /** Controls cover a part of the window: the body stands in the middle of the rest. */
  function layOut(): void {
    const narrow = window.innerWidth <= narrowest;
    const right = narrow || !panel.open ? 0 : 352;
    document.body.classList.toggle('panel-open', panel.open);
    document.body.style.setProperty('--panel-inset', `${right}px`);
    const covered = window.innerHeight - enter.getBoundingClientRect().top + besideEnter;
    const bottom = narrow && panel.open ? window.innerHeight * 0.48 : enter.offsetHeight > 0 ? covered : 0;
    stage.layOut({ left: 0, right, bottom });
  }
  window.addEventListener('resize', layOut);
  new ResizeObserver(layOut).observe(enter);
  panelRegion.addEventListener('toggle', layOut);

  function showInHeadset(): void {
    const { ball, archery } = activities;
    const ballRound = ball?.round() ?? null;
    menu.show({
      estimator: choice.current.name,
      unavailable: choice.unavailable,
      calibration: calibrationStep,
      overlay: settings.vrOverlay,
      activity: activities.name,
      bowSide: settings.bowSide,
      roundOver: archery?.round()?.over ?? false,
      ready:
        ballRound && ballRound.ended === null && ballRound.seat !== null && ballRound.phase !== 'running'
          ? ballRound.ready
          : null,
      notice: ball?.banner() ?? notices.current().at(-1)?.text ?? ballRound?.waiting ?? ballRound?.connection ?? null,
    });
  }

  /** Score and settings of the round, beside the picture. */
  function showPlay(): void {
    const { ball, archery, name, arriving } = activities;
    playBar.show({
      activity: name,
      arriving,
      ball: ball && {
        round: ball.round(),
        room: switches.room,
        bots: settings.bots,
        acting: settings.actor && !settings.mouse && !headset.worn,
        mouse: headset.worn || !settings.actor ? null : settings.mouse,
        name: settings.name,
        guestName: settings.guestName,
        following: settings.following,
      },
      round: archery?.round() ?? null,
      shooter: headset.worn || (!settings.actor && headset.emulator) ? 'headset' : settings.mouse ? 'mouse' : 'actor',
      bowSide: settings.bowSide,
      oneHanded: settings.oneHanded,
      everyHitCounts: settings.everyHitCounts,
      sound: settings.sound,
      inSession: headset.worn,
    });
  }

  function show(): void {
    const { eyeHeight, armSpan } = settings.calibration;
    document.body.classList.toggle('larger-text', settings.largerText);
    document.body.classList.toggle('in-session', headset.worn);
    document.body.classList.toggle('on-the-range', activities.name !== 'studio');
    overlay.setVisible(settings.overlay);
    menu.object.scale.setScalar(settings.largerText ? largerMenu : 1);
    stage.setSkeletonVisible(settings.debugSkeleton);
    avatar.current?.setUpperBodyOnly(settings.upperBodyOnly);
    panel.show({
      ...settings,
      estimator: choice.wanted,
      unavailable: choice.unavailable,
      view: view.view,
      avatarName: avatar.current ? avatar.name : 'None yet',
      avatarPending: avatar.pending,
      ownAvatarOffered: !avatar.own || avatar.pending !== null || avatar.current === null,
      palette: avatar.own ? settings.palette : null,
      heightCm: 100 * statureFromEyeHeight(eyeHeight),
      armSpanCm: 100 * fingertipSpanFromArmSpan(armSpan),
      eyeHeightCm: 100 * eyeHeight,
      emulated: headset.emulator !== null,
      inSession: headset.worn,
      recorder,
    });
    showPlay();
    showInHeadset();
  }

  /** What a person should know of the connection to others. */
  function showBanner(): void {
    const text = activities.ball?.banner() ?? '';
    if (banner.textContent === text) return;
    banner.textContent = text;
    banner.hidden = text === '';
  }

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
    else if (activities.name !== 'studio') showPlay();
    if (activities.ball) showInHeadset();
    showBanner();
  }, reportEveryMs);

  return {
    show,
    setWorn(worn) {
      // A study's sheet takes the place of the menu.
      menu.setVisible(worn && study() === null);
      pointers.objects.visible = worn;
      if (worn) panelOpenBefore = panel.open;
      else guide.cancel();
      panel.setOpen(!worn && panelOpenBefore);
    },
    setPanelOpen: (open) => panel.setOpen(open && window.innerWidth > narrowest),
    caption: playBar.caption,
    layOut,
    observe: (frame) => guide.observe(frame),
    point() {
      const hands = pointers.take();
      const run = study();
      if (run) {
        run.point(hands);
        return;
      }
      menu.point(hands);
      for (const { origin, direction, pressed, showRay } of hands) {
        const distance = activities.point({ origin: { ...origin }, direction: { ...direction } }, pressed);
        if (distance === null) continue;
        showRay(distance);
        // One hand's ray is lit; the other's would put the light out again.
        break;
      }
    },
    openRecording,
  };
}
