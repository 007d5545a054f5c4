import type { Object3D } from 'three';
import { sides } from 'threepoint/core/math/side';
import { TrackingDegradation } from 'threepoint/core/tracking/tracking-degradation';
import { ServerPresence } from 'threepoint-http/server-presence';
import { pageElement } from 'threepoint-ui/element';
import { createMouseAim } from 'threepoint-ui/mouse-aim';
import type { Notices } from 'threepoint-ui/notices';
import { pageFolder } from 'threepoint-ui/page-folder';
import { createActor } from '../emulator/actor';
import { OfflineCopy } from '../offline/offline-copy';
import { uploadToGpu } from '../scene/gpu-upload';
import { affordableQuality } from '../scene/renderer';
import { Recorder } from '../studio/recorder';
import { Activities } from './activities/activities';
import { activities as registeredActivities } from './activity-registry';
import { fetchBuiltInAvatar } from './avatar-loader';
import { BoneMapStore } from './bone-map-store';
import { Controls } from './controls/controls';
import { Emitter } from './emitter';
import { DeviceDifference } from './frame/device-difference';
import { createMousePointer, pressSheetsByMouse } from './frame/mouse-pointer';
import { PageFrame } from './frame/page-frame';
import { Pointers } from './frame/pointers';
import { TrackingSource } from './frame/tracking-source';
import { FrameTiming } from './frame-timing';
import { Headset } from './headset';
import { LazyMocap } from './lazy-mocap';
import { handleLostGraphics } from './lost-graphics';
import { createPageBody } from './page-body';
import type { PageContext } from './page-context';
import type { PageLoading } from './page-loading';
import { exposeProbe, readProbe } from './probe';
import { PassthroughHost } from './session/passthrough-host';
import { SessionChanges } from './session/session-changes';
import { Stage } from './stage';
import { PageStudy } from './study/page-study';
import { UserAvatar } from './user-avatar';
import { UserCalibration } from './user-calibration';

export interface PageOptions extends PageContext {
  readonly notices: Notices;
  readonly loading: PageLoading;
}

/** Creates the stage with the user's body, avatar and headset. */
function createBase(options: PageOptions) {
  const { switches, settings, store, changes, loading } = options;
  const timing = new FrameTiming(() => performance.now());
  // Downloads start before anything is built.
  const builtInAvatar = fetchBuiltInAvatar(settings.builtInBody, (part) => loading.report('the avatar', part));
  const pageBody = createPageBody({ ...options, timing });

  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const stage = new Stage(canvas, quality);
  loading.mark('scene');

  const { renderer, studio, view } = stage;
  const { scene } = studio;
  const prepare = (object: Object3D) => uploadToGpu(renderer, scene, object);
  const onChange = changes.emit;
  const boneMaps = new BoneMapStore(store);
  const drawn = { canvas, quality, stage, renderer, studio, view, scene, prepare };
  const parts = { ...options, ...pageBody, ...drawn, timing, boneMaps };
  const avatar = new UserAvatar({ ...parts, onChange });
  const avatarShown = avatar.openBuiltIn(builtInAvatar);
  const recorder = new Recorder(onChange);
  return { ...parts, onChange, avatar, avatarShown, recorder, headset: new Headset(parts) };
}

/** Creates the activities, and what moves the body in them. */
function createPlay(base: ReturnType<typeof createBase>) {
  const { switches, settings, canvas, view, avatar, headset, body, bodyEvents, onChange } = base;
  const study = new PageStudy();
  const degradation = new TrackingDegradation();
  const server = new ServerPresence(pageFolder(), onChange);
  const actor = createActor();
  const mouse = createMouseAim(canvas);
  const mousePointer = createMousePointer(mouse, view);
  const pointers = new Pointers(base);
  const captions = new Emitter<[text: string]>();
  const arrivals = new Emitter();
  const activities = new Activities({
    ...base,
    activities: registeredActivities,
    services: {
      ...base,
      pointer: () => (headset.worn ? pointers.steering : settings.mouse ? mousePointer() : null),
      fetchBuiltInAvatar,
      server,
      study,
      onCaption: captions.emit,
    },
    seed: switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31),
    mouse,
    study,
    setPalette: (palette) => avatar.setSeatPalette(palette),
    onArrival: arrivals.emit,
  });
  const userCalibration = new UserCalibration(base);
  const source = new TrackingSource({ ...base, actor, activities, study, pointers });
  actor.calibrate(body.calibration);
  bodyEvents.calibrated.listen((calibration, from) => {
    userCalibration.measured(from);
    actor.calibrate(calibration);
    activities.current?.calibrate?.(calibration);
    avatar.current?.setCalibration(calibration);
  });
  bodyEvents.outgrown.listen((difference) => userCalibration.outgrown(difference));
  bodyEvents.discontinuity.listen(() => {
    degradation.reset();
    activities.current?.discontinuity?.();
  });
  return { ...base, study, degradation, server, activities, captions, arrivals, userCalibration, source, pointers };
}

/** Creates the controls, motion capture and the steps of a frame. */
function createInterface(play: ReturnType<typeof createPlay>) {
  const { headset } = play;
  const difference = new DeviceDifference();
  const mocap = new LazyMocap(play);
  const controls = new Controls({ ...play, mocap, difference });
  const passthrough = new PassthroughHost({
    ...play,
    isCovered: () => controls.isPointedAt || sides.some((side) => headset.tracking?.inputs.buttons[side].taken),
  });
  const frame = new PageFrame({ ...play, passthrough, difference, controls, mocap });
  return { ...play, mocap, controls, frame, passthrough, kept: new OfflineCopy() };
}

/** Creates all parts of the page and connects them. Nothing runs yet. */
export function createPage(options: PageOptions) {
  const page = createInterface(createPlay(createBase(options)));
  const { settings, changes, stage, recorder, headset, body, timing, activities, controls, captions, arrivals } = page;
  const sessions = new SessionChanges(page);
  headset.listen(sessions);
  sessions.followWindow();
  changes.listen(() => controls.show());
  captions.listen((text) => {
    controls.caption(text);
    // In the headset a caption lies in front of the game: it is for players without sound.
    stage.caption(settings.sound ? '' : text);
  });
  arrivals.listen(() => {
    recorder.stop();
    if (activities.current) controls.setPanelOpen(false);
    body.discontinuity();
    timing.reset();
    controls.show();
  });
  pressSheetsByMouse(page);
  handleLostGraphics(page);
  exposeProbe(() => readProbe(page));
  return page;
}

/** The parts of the page, none of them running yet. */
export type Page = ReturnType<typeof createPage>;
