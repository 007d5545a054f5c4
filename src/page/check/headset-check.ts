import type { WebGLRenderer } from 'three';
import type { PaperMethod, TrackingDegradation } from 'threepoint/core';
import { endSession } from 'threepoint/internal';
import type { Avatar, BodyTracker } from 'threepoint/three';
import type { TrackedSession } from 'threepoint/webxr';
import type { Emulator } from '../emulator/emulator';
import { createHeadsetCamera, type Quality, reduceEmulatedResolution } from '../scene/renderer';
import { home } from '../shell/activity-registry';
import type { FrameTiming } from '../shell/session/frame-timing';
import { enterSession, OfferedFeatures } from './check-session';
import { type CheckStep, remainingSteps } from './check-steps';
import type { CheckWorlds } from './check-worlds';
import { type HeadsetReport, reportFormat, reportVersion } from './headset-report';
import { Measurements } from './measurements';
import { StepCaption } from './step-caption';
import { StepSequence } from './step-sequence';

/** The assumed frame rates of the emulated headset, and of a headset that reports none [Hz]. */
const emulatedRateHz = 60;
const usualRateHz = 72;

interface HeadsetCheckOptions {
  readonly renderer: WebGLRenderer;
  readonly quality: Quality;
  readonly worlds: CheckWorlds;
  /** Draws the body of the user; `timing` measures its work. */
  readonly tracker: BodyTracker<Avatar, PaperMethod>;
  readonly degradation: TrackingDegradation;
  readonly timing: FrameTiming;
  /** The emulated headset; null: a real one is worn. */
  readonly emulator: Emulator | null;
  /** The factor of all durations. */
  readonly pace: number;
  /** A step begins; `steps` may have grown. */
  onStep(step: CheckStep, steps: readonly CheckStep[]): void;
  onReport(report: HeadsetReport): void;
}

const synthesis = 'speechSynthesis' in window ? window.speechSynthesis : null;

/** Speaks a sentence in place of the one before, where the browser can. Captions show it in any case. */
function speak(sentence: string): void {
  if (!synthesis) return;
  synthesis.cancel();
  const utterance = new SpeechSynthesisUtterance(sentence);
  utterance.lang = 'en';
  synthesis.speak(utterance);
}

/** Runs one check, from entering the session to its report. */
export class HeadsetCheck {
  readonly #options: HeadsetCheckOptions;
  readonly #measurements: Measurements;
  readonly #sequence: StepSequence;
  readonly #caption = new StepCaption();
  readonly #camera = createHeadsetCamera();
  #xr: XRSession | null = null;
  /** The tracking of the session; null before its first frame. */
  #tracking: TrackedSession | null = null;
  #views = 0;
  #startedAt = Number.NaN;
  #time = Number.NaN;
  #spoken = '';

  constructor(options: HeadsetCheckOptions) {
    this.#options = options;
    this.#measurements = new Measurements(options.tracker);
    this.#sequence = new StepSequence({
      remaining: () => remainingSteps(this.#measurements.deviceBodySeen),
      pace: options.pace,
      listener: {
        begin: (step) => this.#beginStep(step),
        measure: () => options.timing.reset(),
        end: (step) => this.#endStep(step),
      },
    });
  }

  /** Enters the session and starts the check. Call it in a click. Rejects with a sentence. */
  async start(): Promise<void> {
    const { renderer, quality, emulator } = this.#options;
    await emulator?.loadControls();
    const xr = await enterSession(renderer);
    this.#xr = xr;
    emulator?.endOnEscape(xr);
    const offered = new OfferedFeatures(xr);
    xr.addEventListener('end', () => void this.#finish(xr, offered));
    if (emulator) reduceEmulatedResolution(renderer, quality);
    this.#options.worlds.scene.add(this.#caption.object);
    renderer.setAnimationLoop((timestampMs, frame) => {
      if (!frame) return;
      this.#frame(xr, timestampMs, frame);
      offered.observe();
    });
  }

  /** Ends the check early. */
  stop(): void {
    if (this.#xr) void endSession(this.#xr);
  }

  #frame(xr: XRSession, timestampMs: number, frame: XRFrame): void {
    const { worlds, renderer, tracker, degradation, timing } = this.#options;
    const startMs = performance.now();
    const { body } = tracker;
    const time = body.tick(timestampMs);
    if (Number.isNaN(this.#startedAt)) this.#startedAt = time;
    this.#time = time;
    timing.setRate(this.#rateOf(xr).rateHz);
    timing.begin(time * 1000);
    const read = tracker.read(frame, time);
    const tracked = read && degradation.apply(read);
    timing.mark('tracking');
    const pose = body.solve(tracked);
    timing.mark('kinematics');
    if (tracked) tracker.draw(time);
    timing.mark('skinning');
    if (tracked) worlds.update(time, tracked);
    this.#writeCaption(time);
    this.#caption.show(time, tracked?.head ?? null);
    worlds.draw(this.#camera, time);
    timing.mark('render');
    timing.end();
    this.#views = Math.max(this.#views, renderer.xr.getCamera().cameras.length);
    const { predictedDisplayTime } = frame as { readonly predictedDisplayTime?: number };
    const aheadMs = predictedDisplayTime === undefined ? undefined : predictedDisplayTime - startMs;
    this.#measurements.addLatency(aheadMs, startMs - timestampMs);
    this.#tracking = tracker.tracking;
    if (this.#tracking) {
      const { kinds } = this.#tracking.inputs;
      this.#measurements.add({ time, tracked, pose, kinds }, this.#sequence.measured);
    }
    this.#sequence.advance(time);
    if (this.#sequence.over) this.stop();
  }

  #beginStep(step: CheckStep): void {
    const { measured, sentence } = step;
    if (sentence !== this.#spoken) speak(sentence);
    this.#spoken = sentence;
    if (measured?.kind === 'frames') this.#options.worlds.show(measured.world);
    void this.#options.tracker.setEstimator(measured?.kind === 'frames' ? measured.estimator : 'learned');
    this.#options.onStep(step, this.#sequence.steps);
  }

  #endStep({ measured }: CheckStep): void {
    if (measured?.kind !== 'frames') return;
    this.#measurements.addFrameTimes(measured.world, measured.estimator, this.#options.timing.summary());
  }

  #writeCaption(time: number): void {
    const { current, steps } = this.#sequence;
    if (!current) return;
    const number = steps.indexOf(current) + 1;
    const seconds = Math.ceil(this.#sequence.secondsLeft(time));
    this.#caption.write(current.sentence, `${current.title} · ${seconds} s`, number / steps.length);
  }

  /** The rate at which the device wants frames. The emulated ones follow the window, whatever the emulator reports. */
  #rateOf({ frameRate }: XRSession): Pick<HeadsetReport['session'], 'rateHz' | 'rateReported'> {
    const { emulator } = this.#options;
    const assumed = emulator ? emulatedRateHz : usualRateHz;
    const rateReported = frameRate !== undefined && !emulator;
    return { rateHz: rateReported ? frameRate : assumed, rateReported };
  }

  async #finish(xr: XRSession, offered: OfferedFeatures): Promise<void> {
    const { renderer, emulator, onReport } = this.#options;
    renderer.setAnimationLoop(null);
    synthesis?.cancel();
    this.#caption.dispose();
    this.#options.worlds.show(home);
    onReport({
      format: reportFormat,
      version: reportVersion,
      device: { userAgent: navigator.userAgent, emulated: emulator !== null, profiles: offered.profiles },
      session: {
        seconds: Number.isNaN(this.#startedAt) ? 0 : this.#time - this.#startedAt,
        complete: this.#sequence.over,
        ...this.#rateOf(xr),
        ratesHz: offered.ratesHz,
        views: this.#views,
      },
      features: await offered.features(),
      ...this.#measurements.figures(this.#tracking?.bodyReader?.problem ?? null),
    });
  }
}
