import type { Calibration } from '../core/body/calibration';
import type { EstimatorName } from '../core/estimation/pose-estimator';
import type { TrackerMismatch } from '../core/estimation/tracker-watch';
import type { TrackedPoint } from '../core/tracking/tracking-gate';
import type { TypedEvent } from './event-target';

/**
 * The origin of a body's measures: given by the page, the headset's height at the start of a session, a user who
 * stood up taller, a change between the user and a stand-in, or the default.
 */
export type CalibrationSource = 'given' | 'headset' | 'stood-taller' | 'stand-in' | 'default';

/**
 * The events of a Body or BodyTracker with their fields. Each is dispatched from within a method, or when a network has
 * loaded; never from the constructor.
 */
export interface BodyEvents {
  /** The measures in force have changed, from the next frame on. */
  readonly calibrated: { readonly calibration: Calibration; readonly source: CalibrationSource };
  /**
   * The user stands `difference` [m] taller than the given measures, which stay in force. Reported once for each
   * calibration.
   */
  readonly heightmismatch: { readonly difference: number };
  /**
   * The estimator's network failed or could not be loaded, or 'device' is selected and the device reports no body:
   * inverse kinematics draws instead. `preventDefault` suppresses the warning on the console.
   */
  readonly fallback: { readonly estimator: EstimatorName; readonly reason: string };
  /** `estimator`, `provider` or `unavailableEstimators` has changed. */
  readonly estimatorchange: object;
  /** The body was reset and continues elsewhere. Do not interpolate between its last pose and the next. */
  readonly discontinuity: object;
  /**
   * The point is no longer tracked. Without a head the body keeps its pose; the arm of a lost or guessed hand sinks to
   * rest.
   */
  readonly trackinglost: { readonly point: TrackedPoint };
  /** The point is tracked, for the first time or again. */
  readonly trackingfound: { readonly point: TrackedPoint };
  /**
   * The joint of a tracker beyond head and hands has been out of the body's reach for a second. The tracker is worn
   * elsewhere, or the measures are another person's. Reported once until the body reaches it.
   */
  readonly trackermismatch: TrackerMismatch;
  /** A session starts: frames of its user follow. */
  readonly sessionstart: object;
  /** The session is over: `pose` is null. Stop showing the last pose to others. */
  readonly sessionend: object;
}

/** An event of a Body or BodyTracker: `BodyEvent<'calibrated'>` has `calibration` and `source`. */
export type BodyEvent<Name extends keyof BodyEvents> = TypedEvent<BodyEvents, Name>;
