import type { BodySolver } from 'threepoint/api/body-solver';
import type { Calibration } from 'threepoint/core/body/calibration';
import type { FingerName } from 'threepoint/core/body/hand-shape';
import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import type { Side } from 'threepoint/core/math/side';
import type { Vec3 } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { Savings } from 'threepoint/xr/frame-rate';
import type { StudyProbe } from 'threepoint-study/participant/study-run';
import type { Notices } from 'threepoint-ui/notices';
import type { PlayerProbe } from '../activity/activity';
import type { OfflineCopy, OfflineCopyState } from '../offline/offline-copy';
import type { Recorder } from '../studio/recorder';
import type { Activities } from './activities/activities';
import type { GameProbe } from './activity-registry';
import type { TrackingSource } from './frame/tracking-source';
import type { FrameSummary, FrameTiming } from './frame-timing';
import type { Headset } from './headset';
import type { PageLoading } from './page-loading';
import type { PassthroughHost } from './session/passthrough-host';
import type { Settings } from './settings';
import type { ShownAvatar } from './shown-avatar';
import type { DrawnCounts, Stage } from './stage';
import type { PageStudy } from './study/page-study';

type Triple = readonly [number, number, number];

/** The state of the page as plain data, for tests and tools; read-only. */
export interface Probe {
  /** The first body is drawn. */
  readonly ready: boolean;
  /** 'loading', 'desktop', 'vr'. */
  readonly activity: 'loading' | 'desktop' | 'vr';
  readonly estimator: EstimatorName;
  readonly provider: string;
  readonly frame: Pick<FrameSummary, 'p50Ms' | 'p95Ms' | 'stages' | 'missed' | 'frames' | 'rateHz'> & {
    /** Frames drawn since the page opened. */
    readonly count: number;
  };
  /** Joints of the avatar's bones as drawn, floor frame [m]. */
  readonly avatar: {
    readonly name: string;
    readonly joints: Readonly<Record<string, Triple>>;
    /** The positions of the finger tips. */
    readonly fingertips: Readonly<Record<Side, Readonly<Partial<Record<FingerName, Triple>>>>>;
  };
  /** What was tracked in the newest frame, floor frame [m]; null: not seen. */
  readonly tracking: {
    /** The frame's own time [s]: what estimators and filters go by. */
    readonly time: number;
    readonly head: Triple;
    readonly leftHand: Triple | null;
    readonly rightHand: Triple | null;
  } | null;
  readonly calibration: Calibration & { readonly source: string };
  readonly session: { readonly state: 'none' | 'visible' | 'visible-blurred' | 'hidden'; readonly emulated: boolean };
  /** The user's own room; null: no session shows it. */
  readonly passthrough: {
    readonly showsRoom: boolean;
    readonly mirror: { readonly x: number; readonly y: number; readonly z: number; readonly turned: number };
    readonly anchored: boolean;
  } | null;
  readonly view: string;
  readonly recorder: { readonly mode: string; readonly frames: number; readonly seconds: number };
  readonly notices: readonly { readonly level: string; readonly text: string }[];
  /** Milliseconds from opening the page to each mark of loading. */
  readonly loading: Readonly<Record<string, number>>;
  /** What this browser keeps of the page for a visit without a network. */
  readonly kept: OfflineCopyState;
  /** What the graphics device holds for us, and how dark the edges of the picture are (0 to 1). */
  readonly drawing: {
    readonly geometries: number;
    readonly textures: number;
    readonly programs: number;
    readonly darkness: number;
    /** What the newest picture asked of the graphics device. */
    readonly mirror: DrawnCounts;
    readonly scene: DrawnCounts;
    /** What the pictures of a session give up so that its frames are in time. */
    readonly savings: Savings;
  };
  /** The others as they are drawn here. */
  readonly players: readonly PlayerProbe[];
  /** The round being played; null in the studio. */
  readonly game: GameProbe | null;
  /** The state of the study; null: there is none. */
  readonly study: StudyProbe | null;
}

/** The parts of the page that a probe reads. */
export interface ProbeParts {
  readonly loading: PageLoading;
  readonly kept: Pick<OfflineCopy, 'state'>;
  readonly settings: Pick<Settings, 'calibrationSource'>;
  readonly notices: Pick<Notices, 'current'>;
  readonly timing: Pick<FrameTiming, 'summary'>;
  readonly frame: { readonly count: number };
  readonly source: Pick<TrackingSource, 'newest'>;
  readonly body: Pick<BodySolver, 'estimator' | 'provider' | 'calibration'>;
  readonly avatar: Pick<ShownAvatar, 'current' | 'name'>;
  readonly headset: Pick<Headset, 'worn' | 'visibility' | 'emulator'>;
  readonly recorder: Pick<Recorder, 'mode' | 'frameCount' | 'seconds'>;
  readonly activities: Pick<Activities, 'current'>;
  readonly study: Pick<PageStudy, 'run'>;
  readonly stage: Pick<Stage, 'renderer' | 'view' | 'vignette' | 'drawn' | 'savings'>;
  readonly passthrough: Pick<PassthroughHost, 'room'>;
}

const triple = ({ x, y, z }: Vec3): Triple => [x, y, z];

function trackingOf(newest: TrackingFrame | null): Probe['tracking'] {
  return (
    newest && {
      time: newest.time,
      head: triple(newest.head.position),
      leftHand: newest.leftHand && triple(newest.leftHand.position),
      rightHand: newest.rightHand && triple(newest.rightHand.position),
    }
  );
}

function avatarOf({ current, name }: ProbeParts['avatar']): Probe['avatar'] {
  const joints = Object.entries(current?.jointPositions() ?? {});
  const tips = (side: Side) => {
    const found = Object.entries(current?.fingertips(side) ?? {});
    return Object.fromEntries(found.map(([finger, at]) => [finger, triple(at)]));
  };
  return {
    name,
    joints: Object.fromEntries(joints.map(([joint, at]) => [joint, triple(at)])),
    fingertips: { left: tips('left'), right: tips('right') },
  };
}

function drawingOf({ renderer, vignette, drawn, savings }: ProbeParts['stage']): Probe['drawing'] {
  return {
    ...renderer.info.memory,
    programs: renderer.info.programs?.length ?? 0,
    darkness: vignette.darkness,
    mirror: { ...drawn.mirror },
    scene: { ...drawn.scene },
    savings: { ...savings },
  };
}

const passthroughOf = ({ room }: ProbeParts['passthrough']): Probe['passthrough'] =>
  room && { showsRoom: room.showsRoom, mirror: { ...room.mirror.place }, anchored: room.mirror.anchored };

/** What the page is doing now. */
export function readProbe(parts: ProbeParts): Probe {
  const { loading, kept, settings, notices, timing, frame, source, body, headset, recorder, study, stage } = parts;
  const { current } = parts.activities;
  return {
    ready: loading.ready,
    activity: headset.worn ? 'vr' : loading.ready ? 'desktop' : 'loading',
    estimator: body.estimator,
    provider: body.provider ?? 'none',
    frame: { ...timing.summary(), count: frame.count },
    avatar: avatarOf(parts.avatar),
    tracking: trackingOf(source.newest),
    calibration: { ...body.calibration, source: settings.calibrationSource },
    session: { state: headset.visibility, emulated: headset.emulator !== null },
    passthrough: passthroughOf(parts.passthrough),
    view: stage.view.view,
    recorder: { mode: recorder.mode, frames: recorder.frameCount, seconds: recorder.seconds },
    notices: notices.current(),
    loading: { ...loading.marks },
    kept: kept.state,
    drawing: drawingOf(stage),
    players: current?.players?.() ?? [],
    game: (current?.probe?.() ?? null) as GameProbe | null,
    study: study.run?.probe() ?? null,
  };
}

declare global {
  interface Window {
    readonly threepoint?: { readonly probe: () => Probe };
  }
}

/** Makes `window.threepoint.probe()`; each call returns a copy that shares nothing with the page. */
export function exposeProbe(read: () => Probe): void {
  Object.defineProperty(window, 'threepoint', {
    value: Object.freeze({ probe: () => structuredClone(read()) }),
    enumerable: true,
  });
}
