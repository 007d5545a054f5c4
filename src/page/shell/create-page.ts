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
import { prepareFirstPicture } from '../scene/first-picture';
import { affordableQuality } from '../scene/renderer';
import { Recorder } from '../studio/recorder';
import { Activities } from './activities/activities';
import { activities as registeredActivities } from './activity-registry';
import { fetchBuiltInAvatar } from './avatar-loader';
import { Controls } from './controls/controls';
import { Emitter } from './emitter';
import { DeviceDifference } from './frame/device-difference';
import { createMousePointer } from './frame/mouse-pointer';
import { PageFrame } from './frame/page-frame';
import { Pointers } from './frame/pointers';
import { pressSheetsByMouse } from './frame/sheet-pointing';
import { TrackingSource } from './frame/tracking-source';
import { createFrameTiming } from './frame-timing';
import { Headset } from './headset';
import { KnownBones } from './known-bones';
import { createPageBody } from './page-body';
import type { PageContext } from './page-context';
import { handleLostGraphics } from './page-faults';
import type { PageLoading } from './page-loading';
import { PageMocap } from './page-mocap';
import { exposeProbe, readProbe } from './probe';
import { PassthroughHost } from './session/passthrough-host';
import { SessionChanges } from './session/session-changes';
import { ShownAvatar } from './shown-avatar';
import { createStage } from './stage';
import { PageStudy } from './study/page-study';
import { UserCalibration } from './user-calibration';

export interface PageOptions {
  readonly context: PageContext;
  readonly notices: Notices;
  readonly loading: PageLoading;
}

/** Creates the stage with the user's body, avatar and headset. */
function createBase({ context, notices, loading }: PageOptions) {
  const { switches, settings, store, changes } = context;
  const timing = createFrameTiming(() => performance.now());
  // Downloads start before anything is built.
  const builtInAvatar = fetchBuiltInAvatar(settings.builtInBody, (part) => loading.report('the avatar', part));
  const pageBody = createPageBody({ context, notices, loading, timing });
  const { body } = pageBody;

  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const stage = createStage(canvas, quality);
  loading.mark('scene');

  const { renderer, studio } = stage;
  const { scene } = studio;
  const prepare = (object: Object3D) => prepareFirstPicture(renderer, scene, object);
  const knownBones = new KnownBones(store);
  const avatar = new ShownAvatar({ scene, settings, body, notices, knownBones, prepare, onChange: changes.emit });
  const avatarShown = avatar.openBuiltIn(builtInAvatar);
  const recorder = new Recorder(changes.emit);
  const headset = new Headset({ renderer, quality, switches, settings, notices });
  return { pageBody, canvas, quality, timing, stage, recorder, avatar, avatarShown, headset, prepare };
}

type Base = ReturnType<typeof createBase>;

/** Creates the activities, and what moves the body in them. */
function createPlay({ context, notices }: PageOptions, base: Base) {
  const { switches, settings, writer, store, changes } = context;
  const { canvas, quality, stage, avatar, headset, recorder, pageBody } = base;
  const { body, clock } = pageBody;
  const study = new PageStudy();
  const impaired = new TrackingDegradation();
  const server = new ServerPresence(pageFolder(), changes.emit);
  const actor = createActor();
  const mouse = createMouseAim(canvas);
  const mousePointer = createMousePointer(mouse, stage.view);
  const pointers = new Pointers({ headset, settings });
  const captions = new Emitter<[text: string]>();
  const arrivals = new Emitter();
  const activities = new Activities({
    activities: registeredActivities,
    services: {
      quality,
      clock,
      settings,
      writer,
      switches,
      stage,
      pointer: () => (headset.worn ? pointers.steering : settings.mouse ? mousePointer() : null),
      headset,
      body,
      avatar,
      fetchBuiltInAvatar,
      server,
      notices,
      study,
      onCaption: captions.emit,
      onChange: changes.emit,
    },
    seed: switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31),
    stage,
    mouse,
    recorder,
    body,
    study,
    wear: (palette) => avatar.wear(palette),
    onArrival: arrivals.emit,
  });
  const userCalibration = new UserCalibration({ body, headset, view: stage.view, writer, store, notices });
  const source = new TrackingSource({ settings, headset, recorder, body, actor, activities, study, pointers });
  actor.calibrate(body.calibration);
  pageBody.calibrated.listen((calibration, from) => {
    userCalibration.measured(from);
    actor.calibrate(calibration);
    activities.current?.calibrate?.(calibration);
    avatar.current?.setCalibration(calibration);
  });
  pageBody.outgrown.listen((difference) => userCalibration.outgrown(difference));
  pageBody.discontinuity.listen(() => {
    impaired.reset();
    activities.current?.discontinuity?.();
  });
  return { study, impaired, server, activities, captions, arrivals, userCalibration, source, pointers };
}

type Play = ReturnType<typeof createPlay>;

/** Creates the controls, motion capture and the steps of a frame. */
function createInterface({ context, notices }: PageOptions, base: Base, play: Play) {
  const { switches, settings, writer, store, changes } = context;
  const { timing, stage, recorder, avatar, headset, prepare, quality } = base;
  const { body, networks } = base.pageBody;
  const { study, server, activities, userCalibration, source, impaired, pointers } = play;
  const { scene } = stage.studio;
  const difference = new DeviceDifference();
  const onChange = changes.emit;
  const mocap: PageMocap = new PageMocap({
    scene,
    recorder,
    settings,
    store,
    body,
    networks,
    notices,
    prepare,
    onChange,
    onCovered: () => controls.layOut(),
  });
  const controls = new Controls({
    switches,
    settings,
    writer,
    store,
    notices,
    onChange,
    mocap,
    timing,
    difference,
    stage,
    recorder,
    headset,
    avatar,
    activities,
    body,
    networks,
    userCalibration,
    study,
    server,
    pointers,
  });
  const passthrough = new PassthroughHost({
    quality,
    headset,
    stage,
    activities,
    store,
    notices,
    isCovered: () => controls.isPointedAt || sides.some((side) => headset.tracking?.inputs.buttons[side].taken),
  });
  const frame = new PageFrame({
    settings,
    passthrough,
    notices,
    timing,
    source,
    impaired,
    body,
    recorder,
    difference,
    avatar,
    headset,
    activities,
    controls,
    study,
    stage,
    mocap,
  });
  return { mocap, controls, frame, passthrough };
}

/** Creates all parts of the page and connects them. Nothing runs yet. */
export function createPage(options: PageOptions) {
  const { context, notices, loading } = options;
  const { settings, changes } = context;
  const base = createBase(options);
  const play = createPlay(options, base);
  const { mocap, controls, frame, passthrough } = createInterface(options, base, play);
  const { canvas, timing, stage, recorder, avatar, avatarShown, headset } = base;
  const { body } = base.pageBody;
  const { study, impaired, activities, userCalibration, source } = play;
  const { view } = stage;

  const changed = { headset, recorder, timing, view, body, activities, controls, study, passthrough };
  const sessions = new SessionChanges(changed);
  headset.listen(sessions);
  sessions.followWindow();
  changes.listen(() => controls.show());
  play.captions.listen((text) => {
    controls.caption(text);
    // In the headset a caption lies in front of the game: it is for players without sound.
    stage.caption(settings.sound ? '' : text);
  });
  play.arrivals.listen(() => {
    recorder.stop();
    if (activities.current) controls.setPanelOpen(false);
    body.discontinuity();
    timing.reset();
    controls.show();
  });
  pressSheetsByMouse({ canvas, view, headset, study, activities });
  handleLostGraphics({ canvas, notices, headset, studio: stage.studio, timing });
  const kept = new OfflineCopy();
  const probed = { loading, kept, settings, notices, timing, frame, source, body, avatar, headset, recorder };
  exposeProbe(() => readProbe({ ...probed, activities, study, stage, passthrough }));
  return {
    activities,
    avatar,
    avatarShown,
    body,
    controls,
    frame,
    headset,
    impaired,
    kept,
    mocap,
    recorder,
    stage,
    study,
    timing,
    userCalibration,
  };
}

/** The parts of the page, none of them running yet. */
export type Page = ReturnType<typeof createPage>;
