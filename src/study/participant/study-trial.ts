import type { Calibration } from 'threepoint/core/body/calibration';
import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import { cutRecording } from 'threepoint/core/tracking/recording';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { Schedule, StudyStep } from '../model/plan/schedule';
import { mostMotionBytes } from '../model/progress/study-api';
import { TrialSeconds } from '../model/records/trial-clock';
import { createTrialLog, type FrameListener, type TrialLog, type TrialOutcome } from '../model/records/trial-log';
import type { TaskEnd, TaskRunner } from './task-runner';

/** The steps that are played. */
export type PlayedStep = Extract<StudyStep, { kind: 'trial' | 'tutorial' }>;

export const isPlayed = (step: StudyStep): step is PlayedStep => step.kind === 'trial' || step.kind === 'tutorial';

/** What was played last before a step; undefined: nothing. */
export const lastPlayedBefore = ({ steps }: Pick<Schedule, 'steps'>, { id }: StudyStep): PlayedStep | undefined =>
  steps
    .slice(
      0,
      steps.findIndex((step) => step.id === id),
    )
    .findLast(isPlayed);

/** What a trial needs of the page. */
export interface TrialHost {
  calibration(): Calibration;
  device(): TrialOutcome['device'];
  estimator(): EstimatorName;
  listenToFrames(listener: FrameListener | null): void;
}

/** What is left of a trial that was played to its end. */
export interface FinishedTrial {
  readonly outcome: TrialOutcome;
  /** The tracked frames; null: they were not to be kept, or there were none. */
  readonly recording: string | null;
}

/** A trial that is being played, and the log of it. */
export interface PlayedTrial {
  /** Step, run and attempt: when it changes under the trial, the trial is void. */
  readonly key: string;
  /** Others without whom it cannot begin, empty: not known who; null: it waits for no one. */
  readonly waitingFor: readonly string[] | null;
  /** The game's clock stands because another of the group pauses. */
  readonly standing: boolean;
  /** The game was lost under it: the trial is void. */
  readonly interrupted: boolean;
  /** Stops game and clock, or lets them go on; nothing is counted in between. */
  pause(on: boolean): void;
  /** Every frame drawn; `frame` null: the head was not seen. Answers once, when the end has been seen for a moment; until then null. */
  follow(time: number, frame: TrackingFrame | null): FinishedTrial | null;
  /** Puts away a game whose end has been seen, be it shorter than a moment; null: it goes on. */
  conclude(): FinishedTrial | null;
  /** Puts the game away: the trial counts for nothing. */
  abort(): void;
}

/** The end of a round is seen before the sheet comes [s]. */
const afterglow = 2.5;
/** What participants agree to have kept is the motion of head and wrists. */
const headAndWrists = ({ fingers: _, deviceBody: __, ...frame }: TrackingFrame): TrackingFrame => frame;

/** Tracked frames kept per trial while it is played: what memory may take. What is sent is bounded by its bytes. */
const mostMotionFrames = 40_000;
/** Eyes this far below where calibration found them are those of a person who sat down [m]. */
const seatedDrop = 0.25;

export interface TrialOptions {
  readonly key: string;
  /** Whether tracked frames are kept. */
  readonly motion: boolean;
  /** Lays the trial out. */
  readonly seed: number;
  /** Seconds since 1970. */
  readonly now: () => number;
}

/** Gives the start signal. */
export const playTrial = (step: PlayedStep, runner: TaskRunner, host: TrialHost, options: TrialOptions): PlayedTrial =>
  new LoggedTrial(step, runner, host, options);

class LoggedTrial implements PlayedTrial {
  readonly key: string;
  readonly #step: PlayedStep;
  readonly #runner: TaskRunner;
  readonly #host: TrialHost;
  /** As they are at the start signal. */
  readonly #device: TrialOutcome['device'];
  readonly #calibration: Calibration;
  readonly #log: TrialLog;
  /** null: none are kept. */
  readonly #frames: TrackingFrame[] | null;
  readonly #seconds: TrialSeconds;
  #begun = false;
  /** Second of the trial; null: not yet. */
  #endedAt: number | null = null;
  #lastTime = -1;
  #fellBack = false;
  #paused = false;

  constructor(step: PlayedStep, runner: TaskRunner, host: TrialHost, { key, motion, seed, now }: TrialOptions) {
    this.key = key;
    this.#step = step;
    this.#runner = runner;
    this.#host = host;
    this.#device = host.device();
    this.#calibration = host.calibration();
    this.#log = createTrialLog(this.#device, this.#calibration);
    this.#frames = motion ? [] : null;
    this.#seconds = new TrialSeconds(now);
    for (const name of runner.assists()) this.#log.assist(name);
    host.listenToFrames((spent, late) => {
      if (!this.#stands && this.#endedAt === null && runner.waitingFor === null) this.#log.frame(spent, late);
    });
    runner.start({ seed, seconds: step.seconds });
  }

  get waitingFor(): readonly string[] | null {
    return this.#runner.waitingFor;
  }

  get standing(): boolean {
    return this.#runner.standing;
  }

  get interrupted(): boolean {
    return this.#runner.interrupted;
  }

  pause(on: boolean): void {
    if (on === this.#paused) return;
    this.#paused = on;
    this.#runner.pause(on);
  }

  follow(pageTime: number, frame: TrackingFrame | null): FinishedTrial | null {
    if (this.#runner.waitingFor !== null) return null;
    if (this.#stands) {
      this.#seconds.stand(pageTime);
      return null;
    }
    const time = this.#seconds.run(pageTime);
    if (!this.#begun) this.#begin(frame);
    for (const event of this.#runner.take()) {
      if (event.type === 'shot') this.#log.shot();
      else this.#log.event({ ...event, onset: time });
    }
    const { end } = this.#runner;
    if (this.#endedAt !== null) return end && time - this.#endedAt > afterglow ? this.#finish(end) : null;
    this.#note(time, frame);
    if (end) this.#endedAt = time;
    return null;
  }

  conclude(): FinishedTrial | null {
    const { end } = this.#runner;
    return end && this.#endedAt !== null ? this.#finish(end) : null;
  }

  abort(): void {
    this.#host.listenToFrames(null);
    this.#runner.abort();
  }

  get #stands(): boolean {
    return this.#paused || this.#runner.standing;
  }

  /** The first frame of the trial. */
  #begin(frame: TrackingFrame | null): void {
    this.#begun = true;
    const { eyeHeight } = this.#host.calibration();
    if ((frame?.head.position.y ?? eyeHeight) < eyeHeight - seatedDrop) this.#log.assist('seated');
  }

  /** What is seen and drawn in a frame of the trial, at this second of it. */
  #note(time: number, frame: TrackingFrame | null): void {
    this.#log.tracked(time, {
      head: frame !== null,
      leftHand: frame?.leftHand != null,
      rightHand: frame?.rightHand != null,
    });
    const drawn = this.#host.estimator();
    if (drawn !== this.#step.embodiment.estimator && !this.#fellBack) {
      this.#fellBack = true;
      this.#log.assist(`estimator fell back to ${drawn}`);
    }
    const frames = this.#frames;
    if (frame && frames && frames.length < mostMotionFrames && time > this.#lastTime) frames.push(headAndWrists(frame));
    this.#lastTime = time;
  }

  #finish(end: TaskEnd): FinishedTrial {
    this.abort();
    const recorded = this.#record();
    const motionFrames = recorded?.frames ?? 0;
    const outcome = this.#log.finish({ ...end, motionFrames, clock: this.#seconds.clock });
    return { outcome, recording: recorded?.text ?? null };
  }

  /** What was tracked, as far as the server takes it at once; null: nothing. */
  #record() {
    const frames = this.#frames ?? [];
    if (frames.length === 0) return null;
    const { name: device, refreshRateHz } = this.#device;
    return cutRecording(
      { device, rateHz: refreshRateHz ?? 60, calibration: this.#calibration, frames },
      mostMotionBytes,
    );
  }
}
