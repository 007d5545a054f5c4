import type { TrackingFrame } from 'threepoint/core';
import { type CalibrationGuide, type CalibrationStep, createCalibrationGuide } from 'threepoint-ui';
import { setupProblems } from '../model/plan/remote-setup';
import type { ParticipantSession } from './session/participant-session';
import type { StudyHost } from './trial/study-host';

/**
 * Returns what prevents a participant who takes part alone from beginning on this device; `eyeHeight` [m], null: not
 * measured yet.
 */
function remoteProblems(
  { plan: { remote }, phrases }: Pick<ParticipantSession, 'plan' | 'phrases'>,
  host: Pick<StudyHost, 'inSession' | 'deviceProblem' | 'room'>,
  eyeHeight: number | null,
): readonly string[] {
  if (!remote) return [];
  const deviceProblem = host.inSession() ? null : host.deviceProblem();
  return setupProblems(remote, { deviceProblem: deviceProblem, room: host.room(), eyeHeight }, phrases);
}

/**
 * Measures the body of a participant in the headset, and checks device, room and height of one who takes part alone.
 */
export class BodyMeasurement {
  readonly #session: ParticipantSession;
  readonly #host: StudyHost;
  readonly #guide: CalibrationGuide;
  #step: CalibrationStep | null = null;
  /** The faults that the last measurement found. */
  #measuredProblems: readonly string[] = [];
  /** The height of the eyes in the newest frame [m]; null: no frame came yet. */
  #eyeHeight: number | null = null;

  constructor(session: ParticipantSession, host: StudyHost, onChange: () => void) {
    this.#session = session;
    this.#host = host;
    this.#guide = createCalibrationGuide({
      onStep: (step) => {
        this.#step = step;
        onChange();
      },
      onMeasured: (calibration) => {
        // The calibration of a seated person is that of a standing one, so the newest eye height is checked instead.
        const problems = remoteProblems(session, host, this.#eyeHeight);
        this.#guide.cancel();
        this.#measuredProblems = problems;
        if (problems.length > 0) return;
        host.setCalibration(calibration);
        session.apply({ type: 'calibrated', calibration });
      },
      // A failure is shown until the participant measures again.
      closesItself: () => false,
    });
  }

  get step(): CalibrationStep | null {
    return this.#step;
  }

  /** What is wrong with device, room or height, in the participant's language; empty: nothing. */
  get problems(): readonly string[] {
    return this.#measuredProblems.length > 0 ? this.#measuredProblems : remoteProblems(this.#session, this.#host, null);
  }

  start(): void {
    this.#measuredProblems = [];
    this.#guide.start();
  }

  observe(frame: TrackingFrame): void {
    this.#eyeHeight = frame.head.position.y;
    this.#guide.observe(frame);
  }

  /** Cancels a measurement, whose result stays on the screen. */
  cancel(): void {
    this.#guide.cancel();
  }

  /** Cancels a measurement and clears its result. */
  reset(): void {
    this.#measuredProblems = [];
    this.#guide.cancel();
    this.#step = null;
  }
}
