import type { Object3D } from 'three';
import { TrackingDegradation } from 'threepoint/core';
import { sides } from 'threepoint/math';
import { createMouseAim, pageElement, pageFolder, ServerPresence } from 'threepoint-ui';
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
import type { PageParts } from './page-parts';
import { exposeProbe, readProbe } from './probe';
import { PassthroughHost } from './session/passthrough-host';
import { SessionChanges } from './session/session-changes';
import { Stage } from './stage';
import type { PageStudy } from './study/page-study';
import { UserAvatar } from './user-avatar';
import { UserCalibration } from './user-calibration';

/** Creates all parts of the page, each from those before it. */
function createParts(context: PageContext, loading: PageLoading) {
  const { switches, settings, store, changes, notices } = context;
  const onChange = changes.emit;
  const timing = new FrameTiming(() => performance.now());
  // Downloads start before anything is built.
  const builtInAvatar = fetchBuiltInAvatar(settings.builtInBody, (part) => loading.report('the avatar', part));
  const { body, networks, clock, bodyEvents } = createPageBody(context, loading, timing);

  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const stage = new Stage(canvas, quality);
  loading.mark('scene');

  const { renderer, studio } = stage;
  const { scene } = studio;
  const prepare = (object: Object3D) => uploadToGpu(renderer, scene, object);
  const boneMaps = new BoneMapStore(store);
  const shown = { scene, settings, body, notices, boneMaps, prepare, onChange };
  const avatar = new UserAvatar(shown);
  const avatarShown = avatar.openBuiltIn(builtInAvatar);
  const recorder = new Recorder(onChange);
  const mocap = new LazyMocap({ ...shown, recorder, networks, store });
  const headset = new Headset({ renderer, quality, switches, settings, notices });
  const pointers = new Pointers({ headset, settings });

  const study: PageStudy = { run: null, runners: {} };
  const server = new ServerPresence(pageFolder(), onChange);
  const base = { ...context, timing, body, stage, avatar, recorder, headset, pointers, study, server, onChange };
  const mouse = createMouseAim(canvas);
  const mousePointer = createMousePointer(mouse, stage.view);
  const captions = new Emitter<[text: string]>();
  const arrivals = new Emitter();
  const activities = new Activities({
    ...base,
    activities: registeredActivities,
    services: {
      ...base,
      clock,
      quality,
      fetchBuiltInAvatar,
      pointer: () => (headset.worn ? pointers.steering : settings.mouse ? mousePointer() : null),
      onCaption: captions.emit,
    },
    seed: switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31),
    mouse,
    setPalette: (palette) => avatar.setSeatPalette(palette),
    onArrival: arrivals.emit,
  });

  const actor = createActor();
  const parts: PageParts = {
    ...base,
    loading,
    networks,
    activities,
    mocap,
    source: new TrackingSource({ ...base, actor, activities }),
    degradation: new TrackingDegradation(),
    userCalibration: new UserCalibration(base),
    difference: new DeviceDifference(),
  };
  const controls = new Controls(parts);
  const passthrough = new PassthroughHost({
    ...parts,
    quality,
    isCovered: () => controls.isPointedAt || sides.some((side) => headset.tracking?.inputs.buttons[side].taken),
  });
  const frame = new PageFrame({ ...parts, controls, passthrough });
  const kept = new OfflineCopy();
  return { ...parts, controls, passthrough, frame, kept, avatarShown, actor, bodyEvents, captions, arrivals };
}

/** The parts of the page, none of them running yet. */
export type Page = ReturnType<typeof createParts>;

/** Connects what happens to the body, to the session and to the activities with the parts that it changes. */
function connectParts(page: Page): void {
  const { settings, changes, timing, stage, avatar, recorder, headset, body, bodyEvents, actor } = page;
  const { degradation, activities, userCalibration, controls, captions, arrivals } = page;
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
}

/** Creates all parts of the page and connects them. Nothing runs yet. */
export function createPage(context: PageContext, loading: PageLoading): Page {
  const page = createParts(context, loading);
  connectParts(page);
  exposeProbe(() => readProbe(page));
  return page;
}
