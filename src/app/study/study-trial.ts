import type { Calibration } from '../../core/body/calibration';
import type { EstimatorName } from '../../core/estimation/pose-estimator';
import type { StudyStep } from '../../core/study/plan';
import { createTrialLog, type FrameListener, type TrialOutcome } from '../../core/study/trial-log';
import { writeRecording } from '../../core/tracking/recording';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import type { TaskRunner } from './task-runner';

/** The steps that are played. */
export type PlayedStep = Extract<StudyStep, { kind: 'trial' | 'tutorial' }>;

export const isPlayed = (step: StudyStep): step is PlayedStep => step.kind === 'trial' || step.kind === 'tutorial';

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
  /** Others without whom it cannot begin; null: nobody. */
  readonly waitingFor: string | null;
  /** The game's clock stands because somebody else of the group pauses. */
  readonly standing: boolean;
  /** Stops game and clock, or lets them go on; nothing is counted in between. */
  pause(on: boolean): void;
  /** Every frame drawn; `frame` null: the head was not seen. Answers once, when the end has been seen for a moment; until then null. */
  follow(time: number, frame: TrackingFrame | null): FinishedTrial | null;
  /** Puts the game away: the trial counts for nothing. */
  abort(): void;
}

/** The end of a round is seen before the sheet comes [s]. */
const afterglow = 2.5;
/** Tracked frames kept per trial: some 14 MB, below what the server takes at once. */
const mostMotionFrames = 40_000;
/** Eyes this far below where calibration found them are those of somebody who sat down [m]. */
const seatedDrop = 0.25;

/** Gives the start signal. `motion`: whether tracked frames are kept; `seed` lays the trial out. */
export function playTrial(
  step: PlayedStep,
  runner: TaskRunner,
  host: TrialHost,
  { key, motion, seed }: { readonly key: string; readonly motion: boolean; readonly seed: number },
): PlayedTrial {
  const log = createTrialLog(host.device(), host.calibration());
  const frames: TrackingFrame[] | null = motion ? [] : null;
  let startTime: number | null = null;
  let lastTime = 0;
  let endedAt: number | null = null;
  let fellBack = false;
  let paused = false;
  /** For how long it stood in all [s], and since when it stands now. */
  let stood = 0;
  let stoppedAt: number | null = null;

  for (const name of runner.assists()) log.assist(name);
  host.listenToFrames((spent, late) => {
    if (!paused && !runner.standing && endedAt === null && runner.waitingFor === null) log.frame(spent, late);
  });
  runner.start({ seed, seconds: step.seconds });

  function putAway(): void {
    host.listenToFrames(null);
    runner.abort();
  }

  function finish(end: NonNullable<TaskRunner['end']>): FinishedTrial {
    putAway();
    const recorded = frames && frames.length > 0 ? frames : null;
    const outcome = log.finish({ ...end, motionFrames: recorded?.length ?? 0 });
    const { calibration } = outcome;
    const recording =
      recorded &&
      writeRecording({
        device: outcome.device.name,
        rateHz: outcome.device.refreshRateHz ?? 60,
        calibration,
        frames: recorded,
      });
    return { outcome, recording };
  }

  return {
    key,
    get waitingFor() {
      return runner.waitingFor;
    },
    get standing() {
      return runner.standing;
    },
    pause(on) {
      if (on === paused) return;
      paused = on;
      runner.pause(on);
    },
    follow(pageTime, frame) {
      if (runner.waitingFor !== null) return null;
      if (paused || runner.standing) {
        stoppedAt ??= pageTime;
        return null;
      }
      if (stoppedAt !== null) stood += pageTime - stoppedAt;
      stoppedAt = null;
      const time = pageTime - stood;
      if (startTime === null) {
        startTime = time;
        const { eyeHeight } = host.calibration();
        if ((frame?.head.position.y ?? eyeHeight) < eyeHeight - seatedDrop) log.assist('seated');
      }
      for (const event of runner.take()) {
        if (event.type === 'shot') log.shot();
        else log.event(event);
      }
      if (endedAt !== null) return runner.end && time - endedAt > afterglow ? finish(runner.end) : null;
      log.tracked(time - startTime, {
        head: frame !== null,
        leftHand: frame?.leftHand != null,
        rightHand: frame?.rightHand != null,
      });
      if (host.estimator() !== step.estimator && !fellBack) {
        fellBack = true;
        log.assist(`estimator fell back to ${host.estimator()}`);
      }
      if (frame && frames && frames.length < mostMotionFrames && time > lastTime) frames.push(frame);
      lastTime = time;
      if (runner.end) endedAt = time;
      return null;
    },
    abort: putAway,
  };
}
