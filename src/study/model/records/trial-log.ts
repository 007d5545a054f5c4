import type { Calibration } from 'threepoint/core/body/calibration';
import { checked, handTiltsSchema, integerBetween, numberBetween, text } from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import { type TrialClock, trialClockSchema } from './trial-clock';

/** The version of trial outcomes, which increases with every change of meaning. */
export const trialVersion = 1;
/** The most scoring events that are kept per trial; a trial with more keeps the first ones and their number. */
export const mostTrialEvents = 200;
export const mostTrialStages = 16;

const count = integerBetween(0, 10_000_000);
const milliseconds = numberBetween(0, 600_000);
const duration = numberBetween(0, 36_000);

const stageSchema = v.object({
  count,
  minMs: milliseconds,
  maxMs: milliseconds,
  meanMs: milliseconds,
  p50Ms: milliseconds,
  p95Ms: milliseconds,
});

const lossSchema = v.object({ losses: count, seconds: duration });

const outcomeSchema = v.object({
  version: v.literal(trialVersion, `expected ${trialVersion}, the version that this program reads`),
  /** The time from the start to the end. */
  seconds: duration,
  /** Why it ended; stopped: early. */
  ended: v.picklist(
    ['arrows', 'targets', 'balls', 'time', 'stopped'],
    'expected arrows, targets, balls, time or stopped',
  ),
  /** Points; for a group, those of the group. */
  score: numberBetween(0, 100_000),
  /** The highest possible score. */
  maximum: numberBetween(1, 100_000),
  /** Arrows or balls of this participant, and how many of them scored. */
  shots: count,
  hits: count,
  /** Hits and misses with their points. */
  events: v.pipe(
    v.array(
      v.object({
        /** The time on the game's clock, which also pauses while the head is lost. */
        time: duration,
        /**
         * The second of the trial at the frame that showed it; `clock` converts it to the recording. Absent in older
         * records.
         */
        onset: v.exactOptional(duration),
        type: v.picklist(['hit', 'miss', 'catch']),
        points: numberBetween(0, 100_000),
      }),
    ),
    v.maxLength(mostTrialEvents, `expected at most ${mostTrialEvents} events`),
  ),
  /** The number of events, including those that are not kept. */
  eventCount: count,
  frames: v.object({
    count,
    /** The number of frames that were shown late. */
    missed: count,
    /** The work per frame by stage; "frame" is the total. */
    stages: v.pipe(
      v.record(
        v.pipe(v.string(), v.regex(/^[a-z][a-z-]{0,31}$/, 'expected a name of small letters and hyphens')),
        stageSchema,
      ),
      v.check((stages) => Object.keys(stages).length <= mostTrialStages, `expected at most ${mostTrialStages} stages`),
    ),
  }),
  device: v.object({
    name: text(160),
    /** null: the device does not report it. */
    refreshRateHz: v.nullable(numberBetween(1, 1000)),
    input: v.picklist(['controllers', 'hands', 'mixed', 'emulated', 'simulated']),
  }),
  /** The measures of the body; null: not measured. */
  calibration: v.nullable(
    v.object({
      eyeHeight: numberBetween(0.3, 2.5),
      armSpan: numberBetween(0.3, 2.5),
      forearm: v.optional(numberBetween(0.1, 0.6)),
      gazePitch: v.optional(numberBetween(-0.5, 0.5)),
      handTilts: v.optional(handTiltsSchema),
    }),
  ),
  tracking: v.object({ head: lossSchema, leftHand: lossSchema, rightHand: lossSchema }),
  /** The aids that were on: aim assistance, seated play, one hand. */
  assists: v.pipe(v.array(text(60)), v.maxLength(16, 'expected at most sixteen assists')),
  /** The number of recorded tracking frames; 0 without consent. */
  motionFrames: count,
  /** Absent in older records, or unknown. */
  clock: v.exactOptional(trialClockSchema),
});

/** The outcome of a trial, measured on the participant's device. */
export type TrialOutcome = v.InferOutput<typeof outcomeSchema>;
export type StageSummary = v.InferOutput<typeof stageSchema>;
export type TrialEvent = TrialOutcome['events'][number];

/** Throws a ValidationError that names the field. */
export const checkedOutcome = (value: unknown): TrialOutcome => checked(outcomeSchema, value);

const binMs = 0.05;
const bins = 4000;

/**
 * Statistics of durations [ms] in bounded memory: percentiles are exact to 0.05 ms, and above 200 ms they are the
 * maximum.
 */
export interface DurationStatistics {
  add(ms: number): void;
  /** null without values. */
  summary(): StageSummary | null;
}

export function createDurationStatistics(): DurationStatistics {
  const histogram = new Uint32Array(bins);
  let count = 0;
  let sum = 0;
  let min = Number.POSITIVE_INFINITY;
  let max = 0;
  const quantile = (q: number) => {
    const rank = Math.ceil(q * count);
    let seen = 0;
    for (let bin = 0; bin < bins; bin++) {
      seen += histogram[bin] as number;
      if (seen >= rank) return Math.min(max, Math.max(min, (bin + 0.5) * binMs));
    }
    return max;
  };
  return {
    add(ms) {
      if (!Number.isFinite(ms) || ms < 0) return;
      count += 1;
      sum += ms;
      min = Math.min(min, ms);
      max = Math.max(max, ms);
      const bin = Math.floor(ms / binMs);
      if (bin < bins) histogram[bin] = (histogram[bin] as number) + 1;
    },
    summary() {
      if (count === 0) return null;
      return { count, minMs: min, maxMs: max, meanMs: sum / count, p50Ms: quantile(0.5), p95Ms: quantile(0.95) };
    },
  };
}

type Tracked = 'head' | 'leftHand' | 'rightHand';

/**
 * Called with the time spent in each frame by stage [ms], with the total as "frame", and whether the device showed it
 * late.
 */
export type FrameListener = (spentMs: Readonly<Record<string, number>>, late: boolean) => void;

/** Collects a trial. Frames only write numbers; `finish` computes the rest. */
export interface TrialLog {
  /** Counts a frame: milliseconds per stage, and whether it was shown late. */
  readonly frame: FrameListener;
  /** Counts what was tracked at this second of the trial; times increase. */
  tracked(time: number, seen: Readonly<Record<Tracked, boolean>>): void;
  shot(): void;
  event(event: TrialEvent): void;
  assist(name: string): void;
  finish(end: {
    readonly seconds: number;
    readonly ended: TrialOutcome['ended'];
    readonly score: number;
    readonly maximum: number;
    readonly motionFrames: number;
    /** null: unknown. */
    readonly clock?: TrialClock | null;
  }): TrialOutcome;
}

export function createTrialLog(device: TrialOutcome['device'], calibration: Calibration | null): TrialLog {
  const stages = new Map<string, DurationStatistics>();
  const losses: Record<Tracked, { losses: number; seconds: number; lost: boolean }> = {
    head: { losses: 0, seconds: 0, lost: false },
    leftHand: { losses: 0, seconds: 0, lost: false },
    rightHand: { losses: 0, seconds: 0, lost: false },
  };
  const events: TrialEvent[] = [];
  const assists = new Set<string>();
  let eventCount = 0;
  let shots = 0;
  let hits = 0;
  let frames = 0;
  let missed = 0;
  let lastTime: number | null = null;
  return {
    frame(parts, late) {
      frames += 1;
      if (late) missed += 1;
      for (const [name, ms] of Object.entries(parts)) {
        let statistics = stages.get(name);
        if (!statistics) {
          if (stages.size >= mostTrialStages)
            throw new Error(`a trial logs at most ${mostTrialStages} stages, "${name}" is one more`);
          statistics = createDurationStatistics();
          stages.set(name, statistics);
        }
        statistics.add(ms);
      }
    },
    tracked(time, seen) {
      const passed = lastTime === null ? 0 : Math.max(0, time - lastTime);
      lastTime = time;
      for (const part of ['head', 'leftHand', 'rightHand'] as const) {
        const loss = losses[part];
        if (loss.lost) loss.seconds += passed;
        if (!seen[part] && !loss.lost) loss.losses += 1;
        loss.lost = !seen[part];
      }
    },
    shot() {
      shots += 1;
    },
    event(event) {
      eventCount += 1;
      if (event.type === 'hit') hits += 1;
      if (events.length < mostTrialEvents) events.push(event);
    },
    assist(name) {
      assists.add(name);
    },
    finish({ seconds, ended, score, maximum, motionFrames, clock }) {
      const loss = (part: Tracked) => ({ losses: losses[part].losses, seconds: losses[part].seconds });
      const summaries: Record<string, StageSummary> = {};
      for (const [name, statistics] of stages) {
        const summary = statistics.summary();
        if (summary) summaries[name] = summary;
      }
      return checkedOutcome({
        version: trialVersion,
        seconds,
        ended,
        score,
        maximum,
        shots,
        hits,
        events,
        eventCount,
        frames: { count: frames, missed, stages: summaries },
        device,
        calibration,
        tracking: { head: loss('head'), leftHand: loss('leftHand'), rightHand: loss('rightHand') },
        assists: [...assists],
        motionFrames,
        ...(clock && { clock }),
      });
    },
  };
}
