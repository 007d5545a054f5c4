import {
  type Calibration,
  checked,
  handTiltsSchema,
  integerBetween,
  numberBetween,
  participantId,
  text,
} from 'threepoint/core';
import { type GameEnd, gameNames, games } from 'threepoint-games/all';
import * as v from 'valibot';
import { type TrialClock, trialClockSchema } from './trial-clock';

/** The version of trial outcomes, which increases with every change of meaning. */
export const trialVersion = 1;
/** The most scoring events that are kept per trial; a trial with more keeps the first ones and their number. */
export const maxTrialEvents = 200;
export const maxTrialStages = 16;

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

/** The measures of a body; those that are absent were not measured. */
export const calibrationEntries = {
  eyeHeight: numberBetween(0.3, 2.5),
  armSpan: numberBetween(0.3, 2.5),
  gazePitch: v.optional(numberBetween(-0.5, 0.5)),
  handTilts: v.optional(handTiltsSchema),
};

/** Why a trial ends: for a reason of its game, at its time, because a participant of the group was away, or early. */
export const trialEnds: readonly (GameEnd | 'time' | 'absence' | 'stopped')[] = [
  ...gameNames.flatMap((name): readonly GameEnd[] => games[name].ends),
  'time',
  'absence',
  'stopped',
];

/** The most absences that are kept per trial. */
export const maxAbsences = 200;

/** A time for which the match of a group waited for participants who were away. */
export const absenceSchema = v.object({
  participants: v.pipe(v.array(participantId), v.minLength(1, 'expected at least one participant'), v.maxLength(6)),
  /** The second of the match at which its clock was stopped. */
  time: duration,
  /** For how long it stood. */
  seconds: duration,
  givenUp: v.boolean('expected true or false'),
});
export type TrialAbsence = v.InferOutput<typeof absenceSchema>;

export const outcomeSchema = v.object({
  version: v.literal(trialVersion, `expected ${trialVersion}, the version that this program reads`),
  /** The time from the start to the end. */
  seconds: duration,
  /** Why it ended; stopped: early. */
  ended: v.picklist(trialEnds, `expected ${trialEnds.slice(0, -1).join(', ')} or stopped`),
  /** Points; for a group, those of the group. */
  score: numberBetween(0, 100_000),
  maximum: numberBetween(1, 100_000),
  /** Shots, throws or other attempts of this participant, and how many of them scored. */
  shots: count,
  hits: count,
  /** Hits and misses with their points. */
  events: v.pipe(
    v.array(
      v.object({
        /** The time on the game's clock, which also pauses while the head is lost. */
        time: duration,
        /**
         * The second of the trial at the frame that showed it; `clock` converts it to the recording. Absent: the trial
         * is simulated.
         */
        onset: v.exactOptional(duration),
        type: v.picklist(['hit', 'miss', 'catch']),
        points: numberBetween(0, 100_000),
      }),
    ),
    v.maxLength(maxTrialEvents, `expected at most ${maxTrialEvents} events`),
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
      v.check((stages) => Object.keys(stages).length <= maxTrialStages, `expected at most ${maxTrialStages} stages`),
    ),
  }),
  device: v.object({
    name: text(160),
    /** null: the device does not report it. */
    refreshRateHz: v.nullable(numberBetween(1, 1000)),
    input: v.picklist(['controllers', 'hands', 'mixed', 'emulated', 'simulated']),
  }),
  /** The measures of the body; null: not measured. */
  calibration: v.nullable(v.object({ ...calibrationEntries, forearm: v.optional(numberBetween(0.1, 0.6)) })),
  tracking: v.object({ head: lossSchema, leftHand: lossSchema, rightHand: lossSchema }),
  /** The aids that were on: aim assistance, seated play, one hand. */
  assists: v.pipe(v.array(text(60)), v.maxLength(16, 'expected at most sixteen assists')),
  /** The number of recorded tracking frames; 0 without consent. */
  motionFrames: count,
  /** Absent: unknown. */
  clock: v.exactOptional(trialClockSchema),
  /** The absences of the group during the match, the same for all its participants; absent: none. */
  absences: v.exactOptional(
    v.pipe(v.array(absenceSchema), v.maxLength(maxAbsences, `expected at most ${maxAbsences} absences`)),
  ),
  /**
   * The second of the match at which this participant's record of it begins, because the page was loaded again in the
   * match; absent: at its start.
   */
  from: v.exactOptional(duration),
});

/** The outcome of a trial, measured on the participant's device. */
export type TrialOutcome = v.InferOutput<typeof outcomeSchema>;
export type StageSummary = v.InferOutput<typeof stageSchema>;
export type TrialEvent = TrialOutcome['events'][number];

/** Returns why a trial is not whole, as tables state it; empty: it is. Incomplete trials are not counted. */
export function incompleteReason({ ended, from }: Pick<TrialOutcome, 'ended' | 'from'>): string {
  if (ended === 'absence') return 'incomplete: given up, a participant was away';
  return from === undefined ? '' : `incomplete: recorded from second ${from.toFixed(1)} on`;
}

/** Returns a valid outcome; throws a ValidationError that names the field. */
export const checkedOutcome = (value: unknown): TrialOutcome => checked(outcomeSchema, value);

const binMs = 0.05;
const bins = 4000;

/**
 * Statistics of durations [ms] in bounded memory: percentiles are exact to 0.05 ms, and above 200 ms they are the
 * maximum.
 */
export class DurationStatistics {
  readonly #histogram = new Uint32Array(bins);
  #count = 0;
  #sum = 0;
  #min = Number.POSITIVE_INFINITY;
  #max = 0;

  add(ms: number): void {
    if (!Number.isFinite(ms) || ms < 0) return;
    this.#count += 1;
    this.#sum += ms;
    this.#min = Math.min(this.#min, ms);
    this.#max = Math.max(this.#max, ms);
    const bin = Math.floor(ms / binMs);
    if (bin < bins) this.#histogram[bin] = (this.#histogram[bin] as number) + 1;
  }

  /** Returns null without values. */
  summary(): StageSummary | null {
    const count = this.#count;
    if (count === 0) return null;
    const ends = { minMs: this.#min, maxMs: this.#max, meanMs: this.#sum / count };
    return { count, ...ends, p50Ms: this.#quantile(0.5), p95Ms: this.#quantile(0.95) };
  }

  #quantile(q: number): number {
    const rank = Math.ceil(q * this.#count);
    let seen = 0;
    const bin = this.#histogram.findIndex((inBin) => {
      seen += inBin;
      return seen >= rank;
    });
    return bin < 0 ? this.#max : Math.min(this.#max, Math.max(this.#min, (bin + 0.5) * binMs));
  }
}

type Tracked = 'head' | 'leftHand' | 'rightHand';

/**
 * Called with the time spent in each frame by stage [ms], with the total as "frame", and whether the device showed it
 * late.
 */
export type FrameListener = (spentMs: Readonly<Record<string, number>>, late: boolean) => void;

/** Collects a trial. Frames only write numbers; `finish` computes the rest. */
export class TrialLog {
  readonly #device: TrialOutcome['device'];
  readonly #calibration: Calibration | null;
  readonly #stages = new Map<string, DurationStatistics>();
  readonly #tracking = {
    head: { losses: 0, seconds: 0 },
    leftHand: { losses: 0, seconds: 0 },
    rightHand: { losses: 0, seconds: 0 },
  };
  /** The parts that are lost at the moment. */
  readonly #lost = new Set<Tracked>();
  readonly #events: TrialEvent[] = [];
  readonly #assists = new Set<string>();
  readonly #counts = { eventCount: 0, shots: 0, hits: 0 };
  readonly #frames = { count: 0, missed: 0 };
  #lastTime: number | null = null;

  constructor(device: TrialOutcome['device'], calibration: Calibration | null) {
    this.#device = device;
    this.#calibration = calibration;
  }

  /** Counts a frame: milliseconds per stage, and whether it was shown late. */
  frame(parts: Readonly<Record<string, number>>, late: boolean): void {
    this.#frames.count += 1;
    if (late) this.#frames.missed += 1;
    for (const [name, ms] of Object.entries(parts)) {
      let statistics = this.#stages.get(name);
      if (!statistics) {
        if (this.#stages.size >= maxTrialStages)
          throw new Error(`a trial logs at most ${maxTrialStages} stages, "${name}" is one more`);
        statistics = new DurationStatistics();
        this.#stages.set(name, statistics);
      }
      statistics.add(ms);
    }
  }

  /** Counts what was tracked at this second of the trial; times increase. */
  tracked(time: number, seen: Readonly<Record<Tracked, boolean>>): void {
    const passed = this.#lastTime === null ? 0 : Math.max(0, time - this.#lastTime);
    this.#lastTime = time;
    for (const part of ['head', 'leftHand', 'rightHand'] as const) {
      if (this.#lost.has(part)) this.#tracking[part].seconds += passed;
      if (seen[part]) this.#lost.delete(part);
      else if (!this.#lost.has(part)) {
        this.#lost.add(part);
        this.#tracking[part].losses += 1;
      }
    }
  }

  shot(): void {
    this.#counts.shots += 1;
  }

  event(event: TrialEvent): void {
    this.#counts.eventCount += 1;
    if (event.type === 'hit') this.#counts.hits += 1;
    if (this.#events.length < maxTrialEvents) this.#events.push(event);
  }

  assist(name: string): void {
    this.#assists.add(name);
  }

  /** Returns the outcome; throws a ValidationError if it is not valid. `clock` null: unknown. */
  finish({
    clock,
    ...end
  }: Pick<TrialOutcome, 'seconds' | 'ended' | 'score' | 'maximum' | 'motionFrames' | 'absences' | 'from'> & {
    readonly clock?: TrialClock | null;
  }): TrialOutcome {
    const stages: Record<string, StageSummary> = {};
    for (const [name, statistics] of this.#stages) {
      const summary = statistics.summary();
      if (summary) stages[name] = summary;
    }
    return checkedOutcome({
      version: trialVersion,
      ...end,
      ...this.#counts,
      events: this.#events,
      frames: { ...this.#frames, stages },
      device: this.#device,
      calibration: this.#calibration,
      tracking: this.#tracking,
      assists: [...this.#assists],
      ...(clock && { clock }),
    });
  }
}
