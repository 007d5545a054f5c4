import { type Calibration, type EstimatorName, type TrackingFrame, writeRecordingWithin } from 'threepoint/core';
import { isPlayed, type PlayedStep, type Schedule, type StudyStep } from '../../model/plan/schedule';
import { maxMotionBytes } from '../../model/progress/study-api';
import { TrialStopwatch } from '../../model/records/trial-clock';
import { type FrameListener, maxAbsences, TrialLog, type TrialOutcome } from '../../model/records/trial-log';
import type { TaskEnd, TaskRunner } from './task-runner';

/** Returns the last trial or tutorial before a step, or undefined. */
export const lastPlayedBefore = ({ steps }: Pick<Schedule, 'steps'>, { id }: StudyStep): PlayedStep | undefined =>
  steps
    .slice(
      0,
      steps.findIndex((step) => step.id === id),
    )
    .findLast(isPlayed);

/** The interface of the page that a trial needs. */
export interface TrialHost {
  calibration(): Calibration;
  device(): TrialOutcome['device'];
  estimator(): EstimatorName;
  listenToFrames(listener: FrameListener | null): void;
}

/** The result of a trial that was played to its end. */
export interface FinishedTrial {
  readonly outcome: TrialOutcome;
  /** The tracking frames; null: none were kept. */
  readonly recording: string | null;
}

/** The time for which the end of a round is on display before the sheet [s]. */
const endShownSeconds = 2.5;
/** Participants consent to keeping the motion of head and wrists only. */
const headAndWrists = ({ fingers: _, deviceBody: __, ...frame }: TrackingFrame): TrackingFrame => frame;

/** The most tracking frames that are kept per trial while it is played. Uploads are limited by their size. */
const maxMotionFrames = 40_000;
/** The drop of the eyes below their calibrated height that indicates a seated participant [m]. */
const seatedDrop = 0.25;

export interface MatchClock {
  readonly runs: boolean;
  readonly second: number;
}

export interface TrialOptions {
  readonly key: string;
  /** Whether tracking frames are kept. */
  readonly motion: boolean;
  /** The seed of the layout of the trial. */
  readonly seed: number;
  /** Returns the time in seconds since 1970. */
  readonly now: () => number;
}

/** A trial under way and its log. */
export class PlayedTrial {
  /** The step, run and attempt of the trial. When the session changes to another one, the trial is void. */
  readonly key: string;
  readonly runner: TaskRunner;
  readonly #step: PlayedStep;
  readonly #host: TrialHost;
  /** The device and the calibration at the start. */
  readonly #device: TrialOutcome['device'];
  readonly #calibration: Calibration;
  readonly #log: TrialLog;
  /** null: none are kept. */
  readonly #frames: TrackingFrame[] | null;
  readonly #seconds: TrialStopwatch;
  #begun = false;
  /** The second of the trial at which it ended; null: it goes on. */
  #endedAt: number | null = null;
  #lastTime = -1;
  #fellBack = false;
  #paused = false;

  constructor(step: PlayedStep, runner: TaskRunner, host: TrialHost, { key, motion, seed, now }: TrialOptions) {
    this.key = key;
    this.#step = step;
    this.runner = runner;
    this.#host = host;
    this.#device = host.device();
    this.#calibration = host.calibration();
    this.#log = new TrialLog(this.#device, this.#calibration);
    this.#frames = motion ? [] : null;
    this.#seconds = new TrialStopwatch(now);
    for (const name of runner.assists()) this.#log.assist(name);
    host.listenToFrames((spent, late) => {
      if (!this.#isPaused && this.#endedAt === null && runner.waitingFor === null) this.#log.frame(spent, late);
    });
    runner.start({ seed, seconds: step.seconds });
  }

  /** Whether the match of the group runs, and its second; null: a game for one. */
  get matchClock(): MatchClock | null {
    const { waitingFor, pausedByOther, second } = this.runner;
    return second === undefined ? null : { runs: waitingFor === null && !pausedByOther, second: second ?? 0 };
  }

  /** Pauses or resumes game and clock; nothing is counted in a pause. */
  pause(on: boolean): void {
    if (on === this.#paused) return;
    this.#paused = on;
    this.runner.pause(on);
  }

  /**
   * Takes a drawn frame into account; `frame` null: the head was not seen. Returns the result once, when the end was on
   * display for a moment, otherwise null.
   */
  follow(pageTime: number, frame: TrackingFrame | null): FinishedTrial | null {
    if (this.runner.waitingFor !== null) return null;
    if (this.#isPaused) {
      this.#seconds.pause(pageTime);
      return null;
    }
    const time = this.#seconds.run(pageTime);
    if (!this.#begun) this.#begin(frame);
    for (const event of this.runner.take()) {
      if (event.type === 'shot') this.#log.shot();
      else this.#log.event({ ...event, onset: time });
    }
    const { end } = this.runner;
    if (this.#endedAt !== null) return end && time - this.#endedAt > endShownSeconds ? this.#finish(end) : null;
    this.#recordFrame(time, frame);
    if (end) this.#endedAt = time;
    return null;
  }

  /** Ends a game whose end is on display, without the rest of the moment; returns null if the game goes on. */
  conclude(): FinishedTrial | null {
    const { end } = this.runner;
    return end && this.#endedAt !== null ? this.#finish(end) : null;
  }

  /** Ends the game without a result. */
  abort(): void {
    this.#host.listenToFrames(null);
    this.runner.abort();
  }

  get #isPaused(): boolean {
    return this.#paused || this.runner.pausedByOther;
  }

  /** Takes the first frame of the trial into account. */
  #begin(frame: TrackingFrame | null): void {
    this.#begun = true;
    const { eyeHeight } = this.#host.calibration();
    if ((frame?.head.position.y ?? eyeHeight) < eyeHeight - seatedDrop) this.#log.assist('seated');
  }

  /** Records what was tracked and drawn at this second of the trial. */
  #recordFrame(time: number, frame: TrackingFrame | null): void {
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
    if (frame && frames && frames.length < maxMotionFrames && time > this.#lastTime) frames.push(headAndWrists(frame));
    this.#lastTime = time;
  }

  #finish({ absences = [], ...end }: TaskEnd): FinishedTrial {
    this.abort();
    const recorded = this.#record();
    const motionFrames = recorded?.frames ?? 0;
    const outcome = this.#log.finish({
      ...end,
      ...(absences.length > 0 && { absences: absences.slice(0, maxAbsences) }),
      motionFrames,
      clock: this.#seconds.clock,
    });
    return { outcome, recording: recorded?.text ?? null };
  }

  /** Returns the tracking frames that fit one upload, or null. */
  #record() {
    const frames = this.#frames ?? [];
    if (frames.length === 0) return null;
    const { name: device, refreshRateHz } = this.#device;
    return writeRecordingWithin(
      { device, rateHz: refreshRateHz ?? 60, calibration: this.#calibration, frames },
      maxMotionBytes,
    );
  }
}
