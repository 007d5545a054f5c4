import type { TrackingFrame } from 'threepoint/core';
import type { Side, Vec3 } from 'threepoint/math';
import type { PlayerProbe } from '../activity/activity';
import type { OfflineCopy } from '../offline/offline-copy';
import type { GameProbe } from './activity-registry';
import type { InputParts } from './input/input-parts';
import type { PageFrame } from './page-frame';
import type { PassthroughHost } from './stage/passthrough-host';
import type { Stage } from './stage/stage';
import type { UserAvatar } from './stage/user-avatar';

/** A point of the floor frame [m]. */
type Triple = readonly [number, number, number];

const triple = ({ x, y, z }: Vec3): Triple => [x, y, z];

/** What was tracked in the newest frame, floor frame [m]; null: not seen. `time`: the frame's own [s]. */
const trackingOf = (newest: TrackingFrame | null) =>
  newest && {
    time: newest.time,
    head: triple(newest.head.position),
    leftHand: newest.leftHand && triple(newest.leftHand.position),
    rightHand: newest.rightHand && triple(newest.rightHand.position),
  };

const triples = <Name extends string>(points: Readonly<Partial<Record<Name, Vec3>>> | undefined) =>
  Object.fromEntries(
    Object.entries<Vec3>((points ?? {}) as Readonly<Record<Name, Vec3>>).map(([name, at]) => [name, triple(at)]),
  ) as Readonly<Partial<Record<Name, Triple>>>;

/** Joints of the avatar's bones as drawn, and the tips of its fingers; floor frame [m]. */
function avatarOf({ current, name }: UserAvatar, { view }: Stage) {
  const tips = (side: Side) => triples(current?.fingertips(side));
  return {
    name,
    joints: triples<string>(current?.jointPositions()) as Readonly<Record<string, Triple>>,
    /** The box of the joints in the desktop's window. */
    box: view.boxOf(Object.values(current?.jointPositions() ?? {})),
    fingertips: { left: tips('left'), right: tips('right') },
  };
}

/** Returns the memory and draw calls of the graphics device, and the darkness of the vignette (0 to 1). */
const drawingOf = ({ renderer, vignette, drawn, savings }: Stage) => ({
  ...renderer.info.memory,
  programs: renderer.info.programs?.length ?? 0,
  darkness: vignette.darkness,
  /** What the newest picture asked of the graphics device. */
  mirror: { ...drawn.mirror },
  scene: { ...drawn.scene },
  /** What the pictures of a session give up so that its frames are in time. */
  savings: { ...savings },
});

/** The user's own room; null: no session shows it. */
const passthroughOf = ({ room }: PassthroughHost) =>
  room && { showsRoom: room.showsRoom, mirror: { ...room.mirror.place }, anchored: room.mirror.anchored };

/** Reads the state of the page as plain data, for tests and tools; read-only. */
export function readProbe(parts: InputParts, frame: PageFrame, passthrough: PassthroughHost, kept: OfflineCopy) {
  const { loading, settings, notices, timing, source, body, headset, recorder, study, stage } = parts;
  const { current } = parts.activities;
  const activity: 'loading' | 'desktop' | 'vr' = headset.worn ? 'vr' : loading.ready ? 'desktop' : 'loading';
  return {
    /** The first body is drawn. */
    ready: loading.ready,
    activity,
    estimator: body.estimator,
    provider: body.provider ?? 'none',
    /** `count`: frames drawn since the page opened. */
    frame: { ...timing.summary(), count: frame.count },
    avatar: avatarOf(parts.avatar, parts.stage),
    tracking: trackingOf(source.newest),
    calibration: { ...body.calibration, source: settings.calibrationSource },
    session: { state: headset.visibility, emulated: headset.emulator !== null },
    passthrough: passthroughOf(passthrough),
    view: stage.view.view,
    recorder: { mode: recorder.mode, frames: recorder.frameCount, seconds: recorder.seconds },
    notices: notices.current(),
    /** Milliseconds from opening the page to each mark of loading. */
    loading: { ...loading.marks },
    /** What this browser keeps of the page for a visit without a network. */
    kept: kept.state,
    drawing: drawingOf(stage),
    /** The others as they are drawn here. */
    players: current?.players?.() ?? ([] as readonly PlayerProbe[]),
    /** The round being played; null in the studio. */
    game: (current?.probe?.() ?? null) as GameProbe | null,
    /** The state of the study; null: there is none. */
    study: study.run?.probe() ?? null,
  };
}

/** The state of the page as plain data, for tests and tools; read-only. */
export type Probe = ReturnType<typeof readProbe>;

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
