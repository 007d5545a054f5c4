import type { Calibration } from '../../core/body/calibration';
import type { EstimatorName } from '../../core/estimation/pose-estimator';
import type { ArcheryProbe } from '../archery/archery-play';
import type { PlayerProbe } from '../ball/ball-activity';
import type { BallProbe } from '../ball/ball-frame';
import type { StudyProbe } from '../study/study-run';
import type { FrameSummary } from './frame-timing';

type Triple = readonly [number, number, number];

/** What the page is doing, as plain data: for tests and tools, to be read and not to be written. */
export interface Probe {
  /** A body stands on the floor. */
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
  readonly avatar: { readonly name: string; readonly joints: Readonly<Record<string, Triple>> };
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
  readonly view: string;
  readonly recorder: { readonly mode: string; readonly frames: number; readonly seconds: number };
  readonly notices: readonly { readonly level: string; readonly text: string }[];
  /** Milliseconds from opening the page to each mark of loading. */
  readonly loading: Readonly<Record<string, number>>;
  /** What the graphics device holds for us, and how dark the edges of the picture are (0 to 1). */
  readonly drawing: {
    readonly geometries: number;
    readonly textures: number;
    readonly programs: number;
    readonly darkness: number;
  };
  /** The others as they are drawn here. */
  readonly players: readonly PlayerProbe[];
  /** The round being played; null in the studio. */
  readonly game: ArcheryProbe | BallProbe | null;
  /** Where a study stands; null: there is none. */
  readonly study: StudyProbe | null;
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
