import { nextRandom } from 'threepoint/math';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import {
  type DeviceTracking,
  lasting,
  lossLengthFrom,
  resampleEstimates,
  seedOf,
  simulatedNoise,
  type Tracker,
  type TrackingNoise,
  trackers,
  usualTracking,
} from './disturbances';
import { createDriver, drive, type MeasuredMethod } from './drive';
import { addLosses, emptyLossTally, type LongestStep, type LossReport, reportLosses } from './losses';
import { addClip, addMeasures, emptyMeasures, type MeasuredFrame, type Measures, report, rounded } from './measures';
import { peopleOf } from './recordings';
import { methodRow } from './report-text';
import { measureTremble, standing } from './response';
import {
  type Axis,
  atRate,
  axes,
  lost,
  mounted,
  noisy,
  type Piece,
  type Stage,
  scaled,
  undisturbed,
} from './situations';

export const lossSeconds = [0.1, 0.5, 2] as const;
export const offsetsCm = [-3, -1, 1, 3] as const;
export const heightPercents = [-5, -2, 2, 5] as const;
export const spanPercents = [-5, 5] as const;
export const ratesHz = [72, 90, 120] as const;

/** What the trackers' noise does; trembling is root mean square from frame to frame while a person stands still. */
export interface NoiseReport {
  readonly mpjpeCm: number;
  readonly jerkRatio: number;
  readonly elbowTrembleMm: number;
  readonly hipsTrembleMm: number;
}

export interface MethodRobustness {
  readonly mpjpeCm: number;
  readonly jerkRatio: number;
  readonly losses: readonly LossReport[];
  /** Losses as long as those of the device's hand tracking. */
  readonly handTracking: LossReport;
  /** The simulated noise, which every other figure is of, then the device's. */
  readonly noises: readonly NoiseReport[];
  readonly offsets: readonly {
    readonly tracker: Tracker;
    readonly axis: Axis;
    readonly offsetCm: number;
    readonly mpjpeCm: number;
  }[];
  readonly heights: readonly { readonly percent: number; readonly mpjpeCm: number }[];
  readonly spans: readonly { readonly percent: number; readonly mpjpeCm: number }[];
  readonly rates: readonly { readonly hz: number; readonly mpjpeCm: number; readonly jerkRatio: number }[];
}

export interface RobustnessReport<Method extends MeasuredMethod = MeasuredMethod> {
  readonly people: readonly string[];
  readonly clips: number;
  readonly frames: number;
  /** The name of the device's noise, whose losses are those “as tracked”. */
  readonly tracking: string;
  readonly estimators: Readonly<Record<Method, MethodRobustness>>;
}

/**
 * Clips in a seeded order as long as they fit into `limit` frames, one at least: the same choice for the same corpus.
 */
export function chooseClips<Clip extends { readonly name: string; readonly frames: number }>(
  clips: readonly Clip[],
  limit: number,
): Clip[] {
  const drawn = clips.map((clip) => ({ clip, key: nextRandom({ seed: seedOf(clip.name) }).value }));
  drawn.sort((a, b) => a.key - b.key || (a.clip.name < b.clip.name ? -1 : 1));
  const chosen: Clip[] = [];
  let frames = 0;
  for (const { clip } of drawn) {
    if (chosen.length > 0 && frames + clip.frames > limit) continue;
    chosen.push(clip);
    frames += clip.frames;
  }
  return chosen;
}

/** Returns the stages of the report in its order; the losses are of each length, then of the device's hand tracking. */
const stagesOf = ({ noise, losses }: DeviceTracking) => ({
  noise: noisy(noise),
  offsets: trackers.flatMap((tracker) =>
    axes.flatMap((axis) =>
      offsetsCm.map((offsetCm) => ({ tracker, axis, offsetCm, stage: mounted(tracker, axis, offsetCm / 100) })),
    ),
  ),
  heights: heightPercents.map((percent) => ({ percent, stage: scaled('eyeHeight', percent) })),
  spans: spanPercents.map((percent) => ({ percent, stage: scaled('armSpan', percent) })),
  rates: ratesHz.map((hz) => ({ hz, stage: atRate(hz) })),
  losses: [
    ...lossSeconds.map((seconds) => lost(seconds, lasting(seconds))),
    lost('hand tracking', lossLengthFrom(losses)),
  ],
});

interface RobustnessOptions<Method, Listed> {
  readonly methods: readonly Method[];
  readonly clips: readonly Listed[];
  /** Reads a clip; called once for each. */
  load(clip: Listed): Piece;
  readonly regressors: ReadonlyMap<MeasuredMethod, PoseRegressor>;
  readonly rateHz: number;
  /** The device whose noise and losses are measured with; default: `usualTracking`. */
  readonly tracking?: DeviceTracking;
  /** Receives the share of the work that is done. */
  onProgress?(share: number): void;
}

/**
 * How each method bears what devices and people do: hands that vanish, trackers mounted elsewhere, a wrong height or
 * span, other rates.
 */
export async function measureRobustness<
  Method extends MeasuredMethod,
  Listed extends { readonly person: string; readonly frames: number },
>(options: RobustnessOptions<Method, Listed>): Promise<RobustnessReport<Method>> {
  const { methods, clips, regressors, rateHz, tracking = usualTracking } = options;
  const all = stagesOf(tracking);
  const stages = [
    undisturbed,
    all.noise,
    ...[...all.offsets, ...all.heights, ...all.spans, ...all.rates].map(({ stage }) => stage),
  ];
  const measures = methods.map(() => new Map(stages.map((stage) => [stage, emptyMeasures()])));
  const tallies = methods.map(() => all.losses.map(emptyLossTally));
  const total = clips.reduce((sum, clip) => sum + clip.frames, 0);
  let done = 0;
  for (const listedClip of clips) {
    const clip = options.load(listedClip);
    for (const [number, name] of methods.entries()) {
      const regressor = regressors.get(name) ?? null;
      let seen: readonly MeasuredFrame[] = [];
      for (const stage of stages) {
        const staged = stage(clip, rateHz, 0);
        const driven = await drive(name, staged.calibration, regressor, staged.frames);
        if (stage === undisturbed) seen = driven;
        addErrorsAndJerk(measures[number]!.get(stage)!, driven, staged.rateHz, rateHz);
      }
      for (const [which, stage] of all.losses.entries()) {
        const { calibration, frames, losses } = stage(clip, rateHz, 0);
        if (losses.length === 0) continue;
        const lossy = await drive(name, calibration, regressor, frames);
        addLosses(tallies[number]![which]!, { lossy, seen }, losses, rateHz);
      }
    }
    done += listedClip.frames;
    options.onProgress?.(done / total);
  }
  const lossesOf = (number: number) => all.losses.map((_, which) => reportLosses(tallies[number]![which]!));
  const trembles = await Promise.all(
    methods.map((name) => measureTrembles(name, regressors.get(name) ?? null, tracking.noise)),
  );
  const rows = methods.map((name, number): [Method, MethodRobustness] => {
    const figures = (stage: Stage) => {
      const { mpjpeCm, jerkRatio } = report(measures[number]!.get(stage)!);
      return { mpjpeCm: mpjpeCm.mean, jerkRatio };
    };
    const withError = <Row extends { readonly stage: Stage }>({ stage, ...row }: Row) => ({
      ...row,
      mpjpeCm: figures(stage).mpjpeCm,
    });
    return [
      name,
      {
        ...figures(undisturbed),
        losses: lossesOf(number).slice(0, lossSeconds.length),
        handTracking: lossesOf(number).at(-1)!,
        noises: [undisturbed, all.noise].map((stage, which) => ({
          ...figures(stage),
          ...trembles[number]![which]!,
        })),
        offsets: all.offsets.map(withError),
        heights: all.heights.map(withError),
        spans: all.spans.map(withError),
        rates: all.rates.map(({ hz, stage }) => ({ hz, ...figures(stage) })),
      },
    ];
  });
  return {
    people: peopleOf(clips),
    clips: clips.length,
    frames: total,
    tracking: tracking.name,
    estimators: Object.fromEntries(rows) as Record<Method, MethodRobustness>,
  };
}

/** How elbow and hips tremble under the simulated noise, then under the device's. */
async function measureTrembles(
  name: MeasuredMethod,
  regressor: PoseRegressor | null,
  deviceNoise: TrackingNoise,
): Promise<Pick<NoiseReport, 'elbowTrembleMm' | 'hipsTrembleMm'>[]> {
  const reports = [];
  for (const noise of [simulatedNoise, deviceNoise]) {
    const driver = createDriver(name, standing, regressor);
    const { rightLowerArm, hips } = await measureTremble(driver, ['rightLowerArm', 'hips'], noise);
    reports.push({ elbowTrembleMm: rounded(rightLowerArm!, 3), hipsTrembleMm: rounded(hips!, 3) });
  }
  return reports;
}

/** Errors of frames at `atHz`, jerk as at `jerkHz`: rates would not compare otherwise. */
export function addErrorsAndJerk(
  measures: Measures,
  driven: readonly MeasuredFrame[],
  atHz: number,
  jerkHz: number,
): void {
  if (atHz === jerkHz) {
    addClip(measures, driven, jerkHz);
    return;
  }
  const resampled = emptyMeasures();
  addClip(resampled, resampleEstimates(driven, atHz, jerkHz), jerkHz);
  const own = emptyMeasures();
  addClip(own, driven, atHz);
  addMeasures(measures, { ...own, jerk: resampled.jerk, truthJerk: resampled.truthJerk });
}

/** The table that `--robustness` prints. */
export function robustnessText<Method extends MeasuredMethod>(
  { people, clips, frames, tracking, estimators }: RobustnessReport<Method>,
  rateHz: number,
): string {
  const methods = Object.keys(estimators) as Method[];
  const lines = [
    '',
    `Robustness: ${people.join(', ')}; ${clips} clips, ${(frames / rateHz / 60).toFixed(1)} minutes; MPJPE [cm]`,
  ];
  const row = (label: string, cell: (method: MethodRobustness) => string) =>
    lines.push(
      methodRow(
        label,
        methods.map((name) => cell(estimators[name])),
      ),
    );
  const added = (cm: number, clean: number) =>
    `${cm.toFixed(2)} (${cm < clean ? '−' : '+'}${Math.abs(cm - clean).toFixed(2)})`;
  lines.push(methodRow('', methods));
  row('undisturbed', (m) => m.mpjpeCm.toFixed(2));
  const lossRows = (label: string, of: (m: MethodRobustness) => LossReport) => {
    const times = (a: number, b: number) => `${a.toFixed(2)} (${(a / b).toFixed(2)} ×)`;
    row(`hand lost ${label}: all joints`, (m) => times(of(m).during.allCm, of(m).during.allSeenCm));
    row('  its elbow', (m) => times(of(m).during.elbowCm, of(m).during.elbowSeenCm));
    row('  0.5 s after: all joints', (m) => times(of(m).after.allCm, of(m).after.allSeenCm));
    row('  0.5 s after: its elbow', (m) => times(of(m).after.elbowCm, of(m).after.elbowSeenCm));
    const step = ({ stepCm, excessCm }: LongestStep) => `${stepCm.toFixed(1)} / ${excessCm.toFixed(1)}`;
    row('  longest step / excess, loss [cm]', (m) => step(of(m).atLoss));
    row('  the same at return [cm]', (m) => step(of(m).atReturn));
  };
  for (const [index, seconds] of lossSeconds.entries()) {
    lossRows(`${Math.round(seconds * 1000)} ms`, (m) => m.losses[index]!);
  }
  lossRows('as tracked', (m) => m.handTracking);
  for (const [index, label] of ['simulated noise', tracking].entries()) {
    const of = (m: MethodRobustness) => m.noises[index]!;
    row(`${label}: MPJPE / jerk`, (m) => `${of(m).mpjpeCm.toFixed(2)} / ${of(m).jerkRatio.toFixed(2)} ×`);
    row(
      '  tremble: elbow / hips [mm]',
      (m) => `${of(m).elbowTrembleMm.toFixed(2)} / ${of(m).hipsTrembleMm.toFixed(2)}`,
    );
  }
  for (const tracker of trackers) {
    for (const size of [1, 3]) {
      const of = (m: MethodRobustness) =>
        m.offsets.filter((o) => o.tracker === tracker && Math.abs(o.offsetCm) === size).map(({ mpjpeCm }) => mpjpeCm);
      row(`${tracker} ±${size} cm: worst`, (m) => added(Math.max(...of(m)), m.mpjpeCm));
      row('  mean', (m) => added(of(m).reduce((sum, cm) => sum + cm, 0) / of(m).length, m.mpjpeCm));
    }
  }
  const signed = (percent: number) => `${percent < 0 ? '−' : '+'}${Math.abs(percent)} %`;
  heightPercents.forEach((percent, i) => {
    row(`eye height ${signed(percent)}`, (m) => added(m.heights[i]?.mpjpeCm ?? Number.NaN, m.mpjpeCm));
  });
  spanPercents.forEach((percent, i) => {
    row(`arm span ${signed(percent)}`, (m) => added(m.spans[i]?.mpjpeCm ?? Number.NaN, m.mpjpeCm));
  });
  row(`${rateHz} Hz: MPJPE / jerk`, (m) => `${m.mpjpeCm.toFixed(2)} / ${m.jerkRatio.toFixed(2)} ×`);
  ratesHz.forEach((hz, i) => {
    row(`${hz} Hz`, (m) => `${m.rates[i]?.mpjpeCm.toFixed(2)} / ${m.rates[i]?.jerkRatio.toFixed(2)} ×`);
  });
  return lines.join('\n');
}
