import type { Object3D } from 'three';
import { BodySolver, type CalibrationSource } from 'threepoint/api/body-solver';
import type { Calibration } from 'threepoint/core/body/calibration';
import { firstLine } from 'threepoint/core/errors/reasons';
import { createPageClock } from 'threepoint/core/tracking/page-clock';
import { TrackingDegradation } from 'threepoint/core/tracking/tracking-degradation';
import { ServerPresence } from 'threepoint-http/server-presence';
import { pageElement } from 'threepoint-ui/element';
import { createMouseAim } from 'threepoint-ui/mouse-aim';
import type { Notices } from 'threepoint-ui/notices';
import { pageFolder } from 'threepoint-ui/page-folder';
import { createActor } from '../emulator/actor';
import { KeptPage } from '../offline/kept-page';
import { prepareFirstPicture } from '../scene/first-picture';
import { affordableQuality } from '../scene/renderer';
import { Recorder } from '../studio/recorder';
import { Activities } from './activities';
import { activities as registeredActivities } from './activity-registry';
import { Controls } from './controls/controls';
import { DeviceDifference } from './device-difference';
import { Emitter } from './emitter';
import { estimatorTexts } from './estimator-texts';
import { createFrameTiming, type FrameTiming } from './frame-timing';
import { Headset } from './headset';
import { KnownBones } from './known-bones';
import { createNetworkLoader } from './network-loading';
import { surviveLostGraphics } from './page-faults';
import { PageFrame } from './page-frame';
import type { PageLoading } from './page-loading';
import { PageMocap } from './page-mocap';
import { PageStudy } from './page-study';
import { exposeProbe, readProbe } from './probe';
import { SessionChanges } from './session-changes';
import { pressSheetsByMouse } from './sheet-pointing';
import { fetchOwnAvatar, ShownAvatar } from './shown-avatar';
import { createStage } from './stage';
import { TrackingSource } from './tracking-source';
import type { Visit } from './visit';
import { Wearer } from './wearer';

export interface PageOptions {
  readonly visit: Visit;
  readonly notices: Notices;
  readonly loading: PageLoading;
}

/** Creates the body that head and hands move, and the events that it emits to parts of the page that are built later. */
function createBody({ visit, notices, loading }: PageOptions, timing: FrameTiming) {
  const { switches, store, changes } = visit;
  const clock = createPageClock(() => performance.now());
  const calibrated = new Emitter<[calibration: Calibration, source: CalibrationSource]>();
  const outgrown = new Emitter<[difference: number]>();
  const jumps = new Emitter();
  const networks = createNetworkLoader({ provider: switches.executionProvider, notices, loading });
  const body = new BodySolver({
    estimator: 'ik',
    calibration: store.preferences.calibration ?? 'auto',
    // A study measures its participants itself.
    autoGrow: switches.study === null,
    networks,
    clock,
    profiler: timing,
    events: {
      calibrated: calibrated.emit,
      heightmismatch: outgrown.emit,
      discontinuity: jumps.emit,
      changed: changes.emit,
      fallback(name, reason) {
        const { label } = estimatorTexts[name];
        notices.show('warning', `${label} could not be used (${firstLine(reason)}): inverse kinematics takes over.`);
      },
    },
  });
  return { body, networks, clock, calibrated, outgrown, jumps };
}

/** What a visit needs for the studio and for every game: a stage, a body on it, and the headset that may move it. */
function createGround(options: PageOptions) {
  const { visit, notices, loading } = options;
  const { switches, settings, store, changes } = visit;
  const timing = createFrameTiming(() => performance.now());

  // Everything that travels starts at once; only then is anything built.
  const ownAvatar = fetchOwnAvatar(settings.ownBody, (part) => loading.report('the avatar', part));
  const ground = createBody(options, timing);

  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const stage = createStage(canvas, quality);
  loading.mark('scene');

  const onChange = changes.emit;
  const recorder = new Recorder(onChange);
  const difference = new DeviceDifference();
  const { body } = ground;
  const knownBones = new KnownBones(store);
  const { scene } = stage.studio;
  const prepare = (object: Object3D) => prepareFirstPicture(stage.renderer, scene, object);
  const avatar = new ShownAvatar({ scene, settings, body, notices, knownBones, prepare, onChange });
  const avatarShown = avatar.openOwn(ownAvatar);
  const headset = new Headset({ renderer: stage.renderer, quality, switches, settings, notices });
  return { ...ground, canvas, quality, timing, stage, recorder, difference, avatar, avatarShown, headset, prepare };
}

/** What people do on that stage: the games, and the body that plays them. */
function createPlay({ visit, notices }: PageOptions, ground: ReturnType<typeof createGround>) {
  const { switches, settings, writer, store, changes } = visit;
  const { canvas, quality, stage, body, clock, avatar, headset, recorder } = ground;
  const study = new PageStudy();
  const impaired = new TrackingDegradation();
  const server = new ServerPresence(pageFolder(), changes.emit);
  const actor = createActor();
  const mouse = createMouseAim(canvas);
  const captions = new Emitter<[text: string]>();
  const arrivals = new Emitter();
  const services = {
    quality,
    clock,
    settings,
    writer,
    switches,
    stage,
    mouse,
    headset,
    body,
    avatar,
    fetchOwnAvatar,
    server,
    notices,
    study,
    onCaption: captions.emit,
    onChange: changes.emit,
  };
  const activities = new Activities({
    activities: registeredActivities,
    services,
    seed: switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31),
    stage,
    mouse,
    recorder,
    body,
    study,
    wear: (palette) => avatar.wear(palette),
    onArrival: arrivals.emit,
  });
  const wearer = new Wearer({ body, headset, view: stage.view, writer, store, notices });
  const source = new TrackingSource({ settings, headset, recorder, body, actor, activities, study });
  actor.calibrate(body.calibration);
  ground.calibrated.listen((calibration, source) => {
    wearer.measured(source);
    actor.calibrate(calibration);
    activities.current?.calibrate?.(calibration);
    avatar.current?.setCalibration(calibration);
  });
  ground.outgrown.listen((difference) => wearer.outgrown(difference));
  ground.jumps.listen(() => {
    impaired.reset();
    activities.current?.jumped?.();
  });
  return { study, impaired, server, activities, captions, arrivals, wearer, source };
}

/** Builds the parts of the page and introduces them to each other. */
export function createPage(options: PageOptions) {
  const { visit, notices, loading } = options;
  const { switches, settings, writer, store } = visit;
  const ground = createGround(options);
  const play = createPlay(options, ground);
  const { body, networks, canvas, timing, stage, recorder, difference, avatar, headset, prepare } = ground;
  const { study, impaired, server, activities, wearer, source } = play;
  const { scene } = stage.studio;
  const onChange = visit.changes.emit;
  const onCovered = () => controls.layOut();
  const mocap = new PageMocap({
    ...{ scene, recorder, settings, store, body, networks, notices, prepare },
    ...{ onChange, onCovered },
  });
  const controls = new Controls({
    ...{ switches, settings, writer, store, notices, onChange, mocap },
    ...{ timing, difference, stage, recorder, headset, avatar, activities, body, networks, wearer, study, server },
  });
  const sessions = new SessionChanges({
    headset,
    recorder,
    timing,
    view: stage.view,
    body,
    activities,
    controls,
    study,
  });
  const frame = new PageFrame({
    ...{
      settings,
      notices,
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
    },
    stage,
    mocap,
  });

  headset.listen(sessions);
  sessions.followWindow();
  visit.changes.listen(() => controls.show());
  play.captions.listen((text) => {
    controls.caption(text);
    // In the headset words would lie before the game: they are for players without sound.
    stage.caption(settings.sound ? '' : text);
  });
  play.arrivals.listen(() => {
    recorder.stop();
    if (activities.current) controls.setPanelOpen(false);
    body.discontinuity();
    timing.reset();
    controls.show();
  });
  pressSheetsByMouse({ canvas, view: stage.view, headset, study, activities });
  surviveLostGraphics({ canvas, notices, headset, studio: stage.studio, timing });
  const kept = new KeptPage();
  const probed = { loading, kept, settings, notices, timing, frame, source, body, avatar, headset, recorder };
  exposeProbe(() => readProbe({ ...probed, activities, study, stage }));
  return { ...ground, ...play, controls, frame, kept, mocap };
}

/** The parts of the page, all built and none of them running. */
export type Page = ReturnType<typeof createPage>;
