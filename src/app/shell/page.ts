import { firstLine } from '../../core/errors/reasons';
import { createEstimator } from '../../core/estimation/estimators';
import { createPageClock } from '../../core/tracking/page-clock';
import { createEstimatorChoice } from '../../lib/estimator-choice';
import { ServerPresence } from '../../net/server-presence';
import { affordableQuality } from '../../scene/renderer';
import { pageElement } from '../../ui/element';
import { createMouseAim } from '../../ui/mouse-aim';
import type { Notices } from '../../ui/notices';
import { pageFolder } from '../../ui/page-folder';
import { createActor } from '../../xr/actor';
import { Recorder } from '../studio/recorder';
import { Activities } from './activities';
import { Controls } from './controls/controls';
import { Emitter } from './emitter';
import { estimatorTexts } from './estimator-texts';
import { createFrameTiming } from './frame-timing';
import { PageGames } from './games';
import { Headset } from './headset';
import { Measures } from './measures';
import { createNetworkLoader } from './network-loading';
import { surviveLostGraphics } from './page-faults';
import { PageFrame } from './page-frame';
import type { PageLoading } from './page-loading';
import { PageStudy } from './page-study';
import { exposeProbe, readProbe } from './probe';
import { SessionChanges } from './session-changes';
import { pressSheetsByMouse } from './sheet-pointing';
import { createShownAvatar, fetchOwnAvatar } from './shown-avatar';
import { createStage } from './stage';
import { TrackedBody } from './tracked-body';
import { TrackingSource } from './tracking-source';
import type { Visit } from './visit';

export interface PageOptions {
  readonly visit: Visit;
  readonly notices: Notices;
  readonly loading: PageLoading;
}

/** What a visit needs for the studio and for every game: a stage, a body on it, and the headset that may move it. */
function createGround({ visit, notices, loading }: PageOptions) {
  const { switches, settings, changes } = visit;
  const timing = createFrameTiming(() => performance.now());

  // Everything that travels starts at once; only then is anything built.
  const ownAvatar = fetchOwnAvatar((part) => loading.report('the avatar', part));
  const load = createNetworkLoader({ provider: switches.executionProvider, timing, notices, loading });

  const canvas = pageElement('stage', HTMLCanvasElement);
  const quality = switches.quality ?? affordableQuality();
  document.body.classList.toggle('low-quality', quality === 'low');
  const stage = createStage(canvas, quality);
  loading.mark('scene');

  const recorder = new Recorder();
  const measures = new Measures(settings, recorder);
  const onChange = changes.emit;
  const avatar = createShownAvatar({ scene: stage.studio.scene, settings, measures, notices, onChange });
  const avatarShown = avatar.openOwn(ownAvatar);
  const choice = createEstimatorChoice({
    calibration: settings.calibration,
    create: createEstimator,
    load,
    onChange,
    onFault(name, reason) {
      const { label } = estimatorTexts[name];
      notices.show('warning', `${label} could not be used (${firstLine(reason)}): inverse kinematics takes over.`);
    },
  });
  const headset = new Headset({ renderer: stage.renderer, quality, switches, settings, notices });
  return { canvas, quality, timing, stage, recorder, measures, avatar, avatarShown, choice, headset };
}

/** What people do on that stage: the games, and the body that plays them. */
function createPlay({ visit, notices }: PageOptions, ground: ReturnType<typeof createGround>) {
  const { switches, settings, writer, store, changes } = visit;
  const { canvas, quality, stage, measures, avatar, choice, headset, recorder } = ground;
  const study = new PageStudy();
  const server = new ServerPresence(pageFolder(), changes.emit);
  const actor = createActor();
  const clock = createPageClock(() => performance.now());
  const mouse = createMouseAim(canvas);
  const captions = new Emitter<[text: string]>();
  const arrivals = new Emitter();
  const onCaption = captions.emit;
  const activities = new Activities({
    settings,
    writer,
    notices,
    games: new PageGames({ quality, switches, settings, clock, stage, mouse, headset, measures, server, onCaption }),
    seed: switches.seed ?? Math.floor(performance.timeOrigin % 2 ** 31),
    stage,
    mouse,
    headset,
    measures,
    study,
    wear: avatar.wear,
    onCaption,
    onArrival: arrivals.emit,
    onChange: changes.emit,
  });
  const body = new TrackedBody({
    ...{ measures, choice, headset, view: stage.view, settings, writer, store, notices, study },
    inStudy: switches.study !== null,
    follower: {
      calibrate(calibration) {
        actor.calibrate(calibration);
        activities.ball?.play.calibrate(calibration);
        avatar.current?.fitTo(calibration);
      },
      jumped: () => activities.jumped(),
    },
  });
  const source = new TrackingSource({ settings, headset, recorder, actor, activities, study });
  return { study, server, clock, activities, captions, arrivals, body, source };
}

/** Builds the parts of the page and introduces them to each other. */
export function createPage(options: PageOptions) {
  const { visit, notices, loading } = options;
  const { switches, settings, writer, store } = visit;
  const ground = createGround(options);
  const play = createPlay(options, ground);
  const { canvas, timing, stage, recorder, measures, avatar, choice, headset } = ground;
  const { study, server, activities, body, source } = play;
  const controls = new Controls({
    ...{ switches, settings, writer, store, notices, onChange: visit.changes.emit },
    ...{ timing, stage, choice, recorder, headset, avatar, activities, body, study, server },
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
    ...{ settings, notices, source, body, choice, recorder, avatar, headset, activities, controls, study, stage },
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
    if (activities.name !== 'studio') controls.setPanelOpen(false);
    choice.reset();
    timing.reset();
    controls.show();
  });
  pressSheetsByMouse({ canvas, view: stage.view, headset, study, activities });
  surviveLostGraphics({ canvas, notices, headset, studio: stage.studio, timing });
  const probed = { loading, settings, measures, notices, timing, frame, source, choice, avatar, headset, recorder };
  exposeProbe(() => readProbe({ ...probed, activities, study, stage }));
  return { ...ground, ...play, controls, frame };
}

/** The parts of the page, all built and none of them running. */
export type Page = ReturnType<typeof createPage>;
