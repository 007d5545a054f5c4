import type { Object3D } from 'three';
import { createPageClock, firstLine, type PaperMethod, TrackingDegradation } from 'threepoint/core';
import { GazeTargets } from 'threepoint/internal/three';
import { sides } from 'threepoint/math';
import { type Avatar, BodyTracker } from 'threepoint/three';
import { Pointing } from 'threepoint/webxr';
import { createMouseAim, pageElement, pageFolder, ServerPresence } from 'threepoint-ui';
import { createActor } from '../emulator/actor';
import { createEmulatorBar } from '../emulator/emulator-bar';
import { OfflineCopy } from '../offline/offline-copy';
import { uploadToGpu } from '../scene/gpu-upload';
import { affordableQuality } from '../scene/renderer';
import { Recorder } from '../studio/recorder';
import { activities as registeredActivities } from './activity-registry';
import { followActivity } from './follow-activity';
import type { InputParts } from './input/input-parts';
import { createMousePointer, pressSheetsByMouse } from './input/mouse-pointer';
import { Pointers } from './input/pointers';
import { TrackingSource } from './input/tracking-source';
import { PageFrame } from './page-frame';
import { Controls } from './panels/controls';
import { exposeProbe, readProbe } from './probe';
import { Emitter } from './session/emitter';
import { estimatorTexts } from './session/estimator-texts';
import { FrameTiming } from './session/frame-timing';
import { Headset } from './session/headset';
import { createNetworkLoader } from './session/network-loading';
import type { PageContext } from './session/page-context';
import type { PageLoading } from './session/page-loading';
import type { SessionParts } from './session/session-parts';
import { SessionChanges } from './session-changes';
import { Activities } from './stage/activities';
import { AvatarLoader, fetchBuiltInAvatar } from './stage/avatar-loader';
import { BoneMapStore } from './stage/bone-map-store';
import { DeviceDifference } from './stage/device-difference';
import type { DrawingParts } from './stage/drawing-parts';
import { LazyMocap } from './stage/lazy-mocap';
import { PassthroughHost } from './stage/passthrough-host';
import { Stage } from './stage/stage';
import type { StageParts } from './stage/stage-parts';
import { UserAvatar } from './stage/user-avatar';
import { UserCalibration } from './stage/user-calibration';

/** Returns the options of the body that the address and the stored settings decide. */
const bodyOptions = ({ store, switches }: PageContext) => ({
  avatar: null,
  pointing: (session: XRSession) => new Pointing(session),
  estimator: 'ik' as const,
  calibration: store.preferences.calibration ?? ('auto' as const),
  // A study measures its participants itself.
  autoGrow: switches.study === null,
});

/** Creates all parts of the page, each from those before it. */
function createParts(context: PageContext, loading: PageLoading) {
  const { switches, settings, store, changes, notices } = context;
  const onChange = changes.emit;
  const timing = new FrameTiming(() => performance.now());
  // Downloads start before anything is built.
  const builtInAvatar = fetchBuiltInAvatar(settings.builtInBody, (part) => loading.report('the avatar', part));
  const networks = createNetworkLoader({ provider: switches.ep, notices, loading });

  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const stage = new Stage(canvas, quality);
  loading.mark('scene');

  const { renderer } = stage;
  const { scene } = stage.studio;
  const clock = createPageClock(() => performance.now());
  const tracker = new BodyTracker<Avatar | null, PaperMethod>(renderer, {
    ...bodyOptions(context),
    networks,
    clock,
    profiler: timing,
  });
  if (store.preferences.gripOffsets) tracker.body.setGripOffsets(store.preferences.gripOffsets);
  scene.add(tracker.object);
  const sessionParts: SessionParts = {
    ...context,
    quality,
    clock,
    loading,
    timing,
    tracker,
    body: tracker.body,
    networks,
    headset: new Headset(context, tracker, renderer, quality),
    study: { run: null, runners: {} },
    server: new ServerPresence(pageFolder(), onChange),
    calm: matchMedia('(prefers-reduced-motion: reduce)'),
    gazeTargets: new GazeTargets(),
    onChange,
  };
  const { headset } = sessionParts;

  const prepare = (object: Object3D) => uploadToGpu(renderer, scene, object);
  const boneMaps = new BoneMapStore(store);
  const avatar = new UserAvatar(sessionParts, new AvatarLoader(boneMaps, prepare));
  const avatarShown = avatar.openBuiltIn(builtInAvatar);
  const recorder = new Recorder(onChange);
  const pointers = new Pointers(sessionParts);
  const mouse = createMouseAim(canvas);
  const mousePointer = createMousePointer(mouse, stage.view);
  const captions = new Emitter<[text: string]>();
  const arrivals = new Emitter();
  const drawingParts: DrawingParts = { ...sessionParts, stage, avatar, recorder };
  const activities = new Activities({
    ...drawingParts,
    activities: registeredActivities,
    seed: switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31),
    mouse,
    pointer: () => (headset.worn ? pointers.steering : settings.mouse ? mousePointer() : null),
    fetchBuiltInAvatar,
    onCaption: captions.emit,
    onArrival: arrivals.emit,
  });
  const stageParts: StageParts = {
    ...drawingParts,
    activities,
    mocap: new LazyMocap({ ...drawingParts, activities }, boneMaps, prepare),
    userCalibration: new UserCalibration(sessionParts, stage),
    degradation: new TrackingDegradation(),
    difference: new DeviceDifference(),
  };

  const actor = createActor(() => sessionParts.calm.matches);
  const parts: InputParts = { ...stageParts, pointers, source: new TrackingSource(stageParts, pointers, actor) };
  const controls = new Controls(parts);
  const isCovered = () => controls.isPointedAt || sides.some((side) => headset.tracking?.inputs.buttons[side].taken);
  if (switches.cameras) parts.degradation.configure({ cameraView: true });
  const passthrough = new PassthroughHost(parts, isCovered);
  const frame = new PageFrame(parts, controls, passthrough);
  const kept = new OfflineCopy();
  return { ...parts, controls, passthrough, frame, kept, avatarShown, actor, captions, arrivals };
}

/** The parts of the page, none of them running yet. */
export type Page = ReturnType<typeof createParts>;

const pictureLost = 'The graphics device was lost. The picture returns when the browser restores it.';
const sessionLost = 'The graphics device was lost, and VR has ended. Your game continues. Enter VR again.';

/** Keeps the page alive when the graphics device is lost, and notifies the user. */
function handleLostGraphics({ stage, notices, headset, timing }: StageParts): void {
  const canvas = stage.renderer.domElement;
  canvas.addEventListener('webglcontextlost', () => {
    if (headset.worn) notices.show('warning', sessionLost, 'session');
    else notices.show('warning', pictureLost, 'graphics');
    // What the headset shows was drawn by the lost device; a session cannot be given another one.
    headset.exit();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    stage.studio.restore();
    timing.reset();
    notices.show('info', 'The graphics device is back.', 'graphics');
  });
}

/** Connects what happens to the body, to the session and to the activities with the parts that it changes. */
function connectParts(page: Page): void {
  const { settings, changes, notices, timing, stage, recorder, headset, tracker, actor } = page;
  const { degradation, activities, userCalibration, controls, captions, arrivals } = page;
  actor.calibrate(tracker.calibration);
  tracker.addEventListener('calibrated', ({ calibration, source }) => {
    userCalibration.measured(source);
    actor.calibrate(calibration);
    activities.current?.calibrate?.(calibration);
  });
  tracker.addEventListener('heightmismatch', ({ difference }) => userCalibration.outgrown(difference));
  tracker.addEventListener('estimatorchange', changes.emit);
  tracker.addEventListener('fallback', (event) => {
    event.preventDefault();
    const { estimator, reason } = event;
    const { label } = estimatorTexts[estimator];
    const text = `${label} could not be used, so inverse kinematics takes over. Reason: ${firstLine(reason)}`;
    notices.show('warning', text, 'estimator');
  });
  tracker.addEventListener('discontinuity', () => {
    degradation.reset();
    activities.current?.discontinuity?.();
  });
  const sessions = new SessionChanges(page, controls, page.passthrough);
  headset.listen(sessions);
  sessions.followWindow();
  const emulatorBar = createEmulatorBar(pageElement('emulator', HTMLElement), {
    setActor: (on) => headset.setActor(on),
    lookAround: () => headset.emulator?.lookAround(),
  });
  changes.listen(() => {
    controls.show();
    const { actor } = settings;
    emulatorBar.show(headset.worn && headset.emulator && !page.study.run ? { actor } : null);
  });
  captions.listen((text) => {
    controls.caption(text);
    // In the headset a caption lies in front of the game: it is for players without sound.
    stage.caption(settings.sound ? '' : text);
  });
  arrivals.listen(() => {
    recorder.stop();
    if (activities.current) controls.setPanelOpen(false);
    tracker.body.discontinuity();
    timing.reset();
    controls.show();
  });
  arrivals.listen(followActivity(activities, page.switches.study !== null));
  pressSheetsByMouse(page);
  handleLostGraphics(page);
}

/** Creates all parts of the page and connects them. Nothing runs yet. */
export function createPage(context: PageContext, loading: PageLoading): Page {
  const page = createParts(context, loading);
  connectParts(page);
  exposeProbe(() => readProbe(page, page.frame, page.passthrough, page.kept));
  return page;
}
