import { type Calibration, provisionalCalibration } from '../core/body/calibration';
import { firstLine, reasonOf } from '../core/errors/reasons';
import { createEstimator } from '../core/estimation/estimators';
import { type Buttons, nothingPressed } from '../core/games/button-presses';
import { createHeightWatch } from '../core/tracking/height-watch';
import { createPageClock } from '../core/tracking/page-clock';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { createInferenceWorker } from '../inference/create-inference-worker';
import { createAfterFrame } from '../lib/after-frame';
import { createEstimatorChoice } from '../lib/estimator-choice';
import { affordableQuality } from '../scene/renderer';
import { pageElement } from '../ui/element';
import { createEnterButton } from '../ui/enter-button';
import { createMouseAim } from '../ui/mouse-aim';
import { createNotices } from '../ui/notices';
import { createProgress } from '../ui/progress';
import { createActor } from '../xr/actor';
import { createActivities, type JoinedStudy } from './shell/activities';
import { createControls } from './shell/controls';
import { estimatorTexts } from './shell/estimator-texts';
import { createFrameLoop, withTiming } from './shell/frame-loop';
import { createFrameTiming } from './shell/frame-timing';
import { createHeadset } from './shell/headset';
import { joinStudy } from './shell/join-study';
import { browserStorage, createPreferenceStore } from './shell/preferences';
import { exposeProbe } from './shell/probe';
import { createSettings } from './shell/settings';
import { createShownAvatar } from './shell/shown-avatar';
import { createStage, type Shot } from './shell/stage';
import { readSwitches } from './shell/switches';
import { createRecorder } from './studio/recorder';

/** Where our own networks lie, on our own server. */
const modelsAt = '/models/';

type Triple = readonly [number, number, number];
const triple = ({ x, y, z }: { readonly x: number; readonly y: number; readonly z: number }): Triple => [x, y, z];

/** Resolves at the first animation frame at which the condition holds. */
function until(condition: () => boolean): Promise<void> {
  return new Promise((resolve) => {
    const look = () => (condition() ? resolve() : requestAnimationFrame(look));
    look();
  });
}

/** Builds the page and introduces its parts to each other; resolves when everything has loaded. */
async function start(): Promise<void> {
  const marks: Record<string, number> = {};
  const mark = (name: string) => {
    marks[name] ??= Math.round(performance.now());
  };
  mark('script');

  const notices = createNotices(pageElement('notices', HTMLElement));
  const { switches, complaints } = readSwitches(location.search);
  const store = createPreferenceStore(browserStorage(), (sentence) => notices.show('warning', sentence));
  for (const complaint of [...complaints, store.complaint]) if (complaint) notices.show('warning', complaint);
  const wentWrong = (text: string) => notices.show('error', `Something went wrong: ${firstLine(text)}`);
  window.addEventListener('error', ({ message }) => wentWrong(message));
  window.addEventListener('unhandledrejection', ({ reason }) => wentWrong(reasonOf(reason)));
  const settings = createSettings(switches, store);

  const progress = createProgress([
    { name: 'the avatar', weight: 3 },
    { name: 'the network', weight: 3 },
    { name: 'the first picture', weight: 1 },
  ]);

  // Everything that travels starts at once; only then is anything built.
  const avatar = createShownAvatar({
    scene: () => studio.scene,
    settings,
    body: bodyNow,
    notices,
    onChange: () => controls.show(),
  });
  const avatarArrives = avatar.openOwn((part) => progress.report('the avatar', part));
  const inferenceArrives = import('../inference/load-regressor');
  inferenceArrives.catch(() => undefined);

  const timing = createFrameTiming(() => performance.now());
  const clock = createPageClock(() => performance.now());
  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const stage = createStage(canvas, quality);
  const { studio, view, renderer } = stage;
  mark('scene');

  const choice = createEstimatorChoice({
    calibration: settings.calibration,
    create: createEstimator,
    async load(name) {
      const { loadRegressor } = await inferenceArrives;
      const loaded = await loadRegressor(`${modelsAt}${name}.json`, {
        provider: switches.executionProvider,
        createWorker: createInferenceWorker,
        onProgress: (part) => progress.report('the network', 0.9 * part),
        onProviderFallback: (reason) => notices.show('warning', reason),
      });
      return withTiming(loaded, timing);
    },
    onChange: () => controls.show(),
    onFault(name, reason) {
      const { label } = estimatorTexts[name];
      notices.show('warning', `${label} could not be used (${firstLine(reason)}): inverse kinematics takes over.`);
    },
  });

  // Who moves the body: a session, a replay, the actor, or the emulator that somebody steers.
  const recorder = createRecorder();
  const actor = createActor();
  const heightWatch = createHeightWatch();
  /** The calibration that its wearer has been told is too small. */
  let toldTooSmall: Calibration | null = null;
  let replayedBody: Calibration | null = null;
  /** What the hands of the newest frame press. */
  let buttons: Buttons = nothingPressed;
  let newestFrame: TrackingFrame | null = null;
  /** A study that the address asks for; it decides what is played and with which body. */
  let study: JoinedStudy | null = null;

  /** The body that fits whoever moves: a recording brings its own person along. */
  function bodyNow(): Calibration {
    return (recorder.mode === 'replaying' && replayedBody) || settings.calibration;
  }

  function refit(): void {
    const calibration = bodyNow();
    choice.calibrate(calibration);
    actor.calibrate(calibration);
    activities.ball?.play.calibrate(calibration);
    avatar.current?.fitTo(calibration);
  }

  function calibrate(calibration: Calibration, source: string, remember: boolean): void {
    settings.calibration = calibration;
    settings.calibrationSource = source;
    if (remember) store.remember({ calibration });
    refit();
    controls.show();
  }

  /** The floor lies elsewhere from one frame to the next: nothing may be drawn on the way. */
  function jumped(): void {
    activities.ball?.play.jumped();
    choice.reset();
    heightWatch.reset();
  }

  function sessionChanged(): void {
    timing.setRate(headset.pictureRateHz);
    timing.reset();
    choice.reset();
    heightWatch.reset();
    refit();
    controls.show();
    study?.run.sessionChanged();
  }

  const headset = createHeadset({
    renderer,
    quality,
    switches,
    settings,
    notices,
    onEnter() {
      recorder.stop();
      controls.setWorn(true);
      sessionChanged();
    },
    onLeave() {
      controls.setWorn(false);
      view.setView(view.view);
      controls.layOut();
      sessionChanged();
    },
    onRefused: sessionChanged,
    onJump: jumped,
    onVisibility(state) {
      timing.reset();
      activities.ball?.play.away(state === 'hidden');
    },
    onEmulator: () => controls.show(),
  });

  const activities = createActivities({
    quality,
    switches,
    settings,
    store,
    notices,
    clock,
    stage,
    mouse: createMouseAim(canvas),
    headset,
    body: bodyNow,
    newestFrame: () => newestFrame,
    study: () => study,
    wear: avatar.wear,
    onCaption(text) {
      controls.caption(text);
      // In the headset words would lie before the game: for whoever plays without sound.
      stage.caption(settings.sound ? '' : text);
    },
    onArrival() {
      recorder.stop();
      if (activities.name !== 'studio') controls.setPanelOpen(false);
      choice.reset();
      timing.reset();
      controls.show();
    },
    onChange: () => controls.show(),
  });

  const controls = createControls({
    switches,
    settings,
    store,
    notices,
    timing,
    stage,
    choice,
    recorder,
    headset,
    avatar,
    activities,
    study: () => study?.run ?? null,
    calibrate,
    replays(body) {
      replayedBody = body;
    },
    refit,
    recentre() {
      if (headset.worn) headset.recentre();
      else view.recentre();
      jumped();
    },
  });
  // Ours stands there until another has arrived, and stays where that does not.
  if (switches.avatar) void avatar.open(switches.avatar);
  const enterButton = createEnterButton(pageElement('enter', HTMLDivElement), () => void headset.enter());

  /** Somebody who needs nobody: the players built into the games, else the actor. */
  const perform = (time: number) => activities.act(time) ?? { frame: actor.frameAt(time), buttons: nothingPressed };

  function track(time: number, deviceFrame: XRFrame | undefined): TrackingFrame | null {
    const { emulator } = headset;
    buttons = nothingPressed;
    activities.begin(time);
    if (headset.worn) {
      if (emulator && settings.actor && !study?.run.idle) {
        // What the actor does now is seen with the next frame: the device froze this one before it called.
        const performed = perform(time);
        emulator.drive(performed.frame, performed.buttons);
      }
      const tracked = headset.read(deviceFrame, time);
      buttons = headset.buttons;
      return tracked;
    }
    const replayed = recorder.sample(time);
    if (replayed) return replayed;
    if (activities.watched()) return null;
    if (!settings.actor && emulator) return emulator.read(time);
    const performed = perform(time);
    buttons = performed.buttons;
    return performed.frame;
  }

  /** Somebody who never calibrated is as tall as their headset hangs high, once it hangs there calmly. */
  function settle(frame: TrackingFrame): void {
    if (store.preferences.calibration || study?.run.measured) return;
    const height = headset.settledHeight(frame);
    if (height !== null) calibrate(provisionalCalibration(height), 'from the headset’s height', false);
  }

  /** Whoever never calibrated and stands up straight grows; whoever did is told, once; a study keeps the body that it measured. */
  function grow(frame: TrackingFrame): void {
    const { calibration } = settings;
    if (!headset.worn || switches.study || calibration === toldTooSmall) return;
    const grown = heightWatch.observe(frame, calibration);
    if (!grown) return;
    if (!store.preferences.calibration) calibrate(grown, 'corrected, because you stood taller', false);
    else {
      toldTooSmall = calibration;
      const centimetres = Math.round(100 * (grown.eyeHeight - calibration.eyeHeight));
      notices.show(
        'info',
        `You stand ${centimetres} cm taller than your calibration says: you may want to calibrate again.`,
      );
    }
  }

  let frameCount = 0;
  let lastFault = '';
  const loop = createFrameLoop<XRFrame>(
    {
      resumed: jumped,
      track,
      observe(frame) {
        newestFrame = frame;
        recorder.observe(frame);
        controls.observe(frame);
        settle(frame);
        grow(frame);
        headset.buzz(activities.play(frame, buttons));
      },
      estimator: () => choice.current,
      afterwards: createAfterFrame(),
      skin(pose, frame) {
        const grips = { left: activities.grip('left', buttons), right: activities.grip('right', buttons) };
        for (const side of ['left', 'right'] as const) avatar.current?.setGrip(side, grips[side]);
        avatar.current?.apply(pose, frame.time);
        activities.ball?.send(frame, pose, grips);
      },
      render(time, frame) {
        frameCount += 1;
        study?.run.frame(time, frame);
        if (headset.visibility === 'visible') controls.point();
        if (headset.turnByStick()) {
          stage.vignette.close(time);
          jumped();
        }
        const mirror = activities.name === 'archery' ? 'always' : 'unless-behind';
        const shot: Shot = {
          time,
          frame,
          avatar: avatar.current,
          inSession: headset.worn,
          watched: activities.watched(),
          mirror: settings.mirror && activities.name !== 'ball' ? mirror : 'never',
        };
        stage.look(shot);
        activities.show(time, frame);
        stage.draw(shot);
      },
      fail(error) {
        const text = firstLine(reasonOf(error));
        if (text !== lastFault) notices.show('error', `A frame could not be drawn: ${text}`);
        lastFault = text;
      },
    },
    timing,
    clock,
  );

  function pointAt({ clientX, clientY }: MouseEvent, press: boolean): number | null {
    if (headset.worn || study) return null;
    const { width, height } = canvas.getBoundingClientRect();
    return activities.point(view.rayThrough((2 * clientX) / width - 1, 1 - (2 * clientY) / height), press);
  }
  /** Whether the button of the mouse went down on a sheet of a game: one that came under a throw is not meant. */
  let pressing = false;
  canvas.addEventListener('pointerdown', (event) => {
    pressing = pointAt(event, false) !== null;
  });
  canvas.addEventListener('click', (event) => {
    if (pressing) pointAt(event, true);
  });
  const pictureLost = 'The graphics device was lost. The picture comes back as soon as the browser gives it back.';
  canvas.addEventListener('webglcontextlost', () => {
    notices.show(
      'warning',
      headset.worn ? 'The graphics device was lost, and VR with it. Your game goes on: enter VR again.' : pictureLost,
    );
    // What the headset shows was drawn by the lost device; a session cannot be given another one.
    headset.exit();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    studio.restore();
    timing.reset();
    notices.withdraw(pictureLost);
    notices.show('info', 'The graphics device is back.');
  });
  document.addEventListener('visibilitychange', () => {
    timing.reset();
    activities.ball?.play.away(document.hidden);
  });

  let ready = false;
  exposeProbe(() => {
    const { archery, ball } = activities;
    const joints = Object.entries(avatar.current?.jointPositions() ?? {});
    return {
      ready,
      activity: headset.worn ? 'vr' : ready ? 'desktop' : 'loading',
      estimator: choice.current.name,
      provider: choice.regressor?.provider ?? 'none',
      frame: { ...timing.summary(), count: frameCount },
      avatar: { name: avatar.name, joints: Object.fromEntries(joints.map(([name, at]) => [name, triple(at)])) },
      tracking: newestFrame && {
        time: newestFrame.time,
        head: triple(newestFrame.head.position),
        leftHand: newestFrame.leftHand && triple(newestFrame.leftHand.position),
        rightHand: newestFrame.rightHand && triple(newestFrame.rightHand.position),
      },
      calibration: { ...bodyNow(), source: settings.calibrationSource },
      session: { state: headset.visibility, emulated: headset.emulator !== null },
      view: view.view,
      recorder: { mode: recorder.mode, frames: recorder.frameCount, seconds: recorder.seconds },
      notices: notices.current(),
      loading: { ...marks },
      drawing: {
        ...renderer.info.memory,
        programs: renderer.info.programs?.length ?? 0,
        darkness: stage.vignette.darkness,
      },
      players: ball?.players() ?? [],
      game: archery?.probe() ?? ball?.probe() ?? null,
      study: study?.run.probe() ?? null,
    };
  });

  /** What entering would mean: a real headset, or why not and the emulated one. */
  async function prepareSessions(): Promise<void> {
    const { real, sentence } = await headset.prepare();
    enterButton.show({
      label: real ? 'Enter VR' : 'Enter VR (emulated)',
      sentence: sentence && `${sentence} An emulated headset takes its place.`,
      enabled: true,
    });
  }

  // The way to the first body: the chosen network loads beside the avatar, and IK draws until it is there.
  controls.setPanelOpen(switches.panel);
  if (switches.view) view.setView(switches.view);
  controls.layOut();
  renderer.setAnimationLoop((timestampMs, deviceFrame) => loop(timestampMs, deviceFrame ?? undefined));
  const sessionsPrepared = prepareSessions();
  const chosen = choice.choose(switches.estimator ?? store.preferences.estimator ?? 'learned');
  void chosen.then(() => progress.report('the network', 1));
  await avatarArrives;
  mark('avatar');
  progress.report('the avatar', 1);
  const drawn = frameCount;
  await until(() => frameCount > drawn);
  progress.report('the first picture', 1);
  progress.showBody();
  mark('firstBody');
  if (switches.replay) void controls.openRecording(switches.replay);
  await Promise.all([chosen, sessionsPrepared, activities.goTo(switches.play)]);
  if (switches.study) {
    study = await joinStudy({
      asked: switches.study,
      switches,
      settings,
      choice,
      headset,
      activities,
      timing,
      calibrate: (calibration) => calibrate(calibration, 'measured', false),
    });
    studio.scene.add(study.run.object);
  }
  mark('estimator');
  progress.finish();
  ready = true;
  // Compiling shaders is loading, not drawing.
  timing.reset();
  controls.show();
}

start().catch((error: unknown) => {
  const text = document.createElement('p');
  text.className = 'fault';
  text.setAttribute('role', 'alert');
  text.textContent = `threepoint cannot start: ${firstLine(reasonOf(error))}`;
  document.body.replaceChildren(text);
});
