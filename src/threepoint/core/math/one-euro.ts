import { smoothingFactor } from './damper';
import { conjugate, copyQuat, type MutableQuat, multiply, type Quat, quat, slerp, toRotationVector } from './quat';
import { addScaled, copyVec3, length, lerp, type MutableVec3, setVec3, subtract, type Vec3, vec3 } from './vec3';

/**
 * A low-pass whose cutoff rises with speed: steady at rest, without lag in motion (Casiez, Roussel and Vogel, “1 €
 * Filter”, CHI 2012).
 */
export interface OneEuroTuning {
  /** Cutoff at rest [Hz]. */
  readonly restCutoff: number;
  /** What one unit a second adds to the cutoff [Hz per unit/s]. */
  readonly cutoffPerSpeed: number;
  /** Cutoff of the low-pass on the velocity [Hz]. */
  readonly velocityCutoff: number;
}

/** Half-life [s] of a first-order low-pass with this cutoff [Hz]. */
export const halfLifeOfCutoff = (cutoff: number): number => Math.LN2 / (2 * Math.PI * cutoff);

/** The filter's state for one point. */
export interface SteadyPoint {
  /** False before the first sample, which passes unchanged. */
  known: boolean;
  /** The newest sample and its filtered value, in the unit and frame of the samples. */
  readonly sample: MutableVec3;
  readonly value: MutableVec3;
  /** Filtered velocity [units/s]. */
  readonly velocity: MutableVec3;
}

export const makeSteadyPoint = (): SteadyPoint => ({
  known: false,
  sample: vec3(0, 0, 0),
  value: vec3(0, 0, 0),
  velocity: vec3(0, 0, 0),
});

/** The filter's state for one orientation. */
export interface SteadyOrientation {
  /** False before the first sample, which passes unchanged. */
  known: boolean;
  /** The newest sample and its filtered value, unit. */
  readonly sample: MutableQuat;
  readonly value: MutableQuat;
  /** Filtered angular velocity [rad/s], frame of the samples. */
  readonly velocity: MutableVec3;
}

export const makeSteadyOrientation = (): SteadyOrientation => ({
  known: false,
  sample: quat(0, 0, 0, 1),
  value: quat(0, 0, 0, 1),
  velocity: vec3(0, 0, 0),
});

const change = vec3(0, 0, 0);
const turn = quat(0, 0, 0, 1);
const inverse = quat(0, 0, 0, 1);

/**
 * Low-passes `velocity` towards `change` a step, and returns the share of the way that the value goes to its sample.
 */
function shareOf(velocity: MutableVec3, tuning: OneEuroTuning, deltaSeconds: number): number {
  setVec3(change, change.x / deltaSeconds, change.y / deltaSeconds, change.z / deltaSeconds);
  lerp(velocity, change, smoothingFactor(halfLifeOfCutoff(tuning.velocityCutoff), deltaSeconds), velocity);
  const cutoff = tuning.restCutoff + tuning.cutoffPerSpeed * length(velocity);
  return smoothingFactor(halfLifeOfCutoff(cutoff), deltaSeconds);
}

/** Takes the next sample; a step of no time keeps the value of a known state. */
export function steadyPoint(
  state: SteadyPoint,
  sample: Vec3,
  tuning: OneEuroTuning,
  deltaSeconds: number,
): MutableVec3 {
  const { value, velocity } = state;
  if (!state.known) {
    copyVec3(sample, value);
    setVec3(velocity, 0, 0, 0);
    state.known = true;
  } else if (deltaSeconds > 0) {
    subtract(sample, state.sample, change);
    const share = shareOf(velocity, tuning, deltaSeconds);
    addScaled(value, subtract(sample, value, change), share, value);
  }
  copyVec3(sample, state.sample);
  return value;
}

/** Takes the next sample, a unit quaternion; a step of no time keeps the value of a known state. */
export function steadyOrientation(
  state: SteadyOrientation,
  sample: Quat,
  tuning: OneEuroTuning,
  deltaSeconds: number,
): MutableQuat {
  const { value, velocity } = state;
  if (!state.known) {
    copyQuat(sample, value);
    setVec3(velocity, 0, 0, 0);
    state.known = true;
  } else if (deltaSeconds > 0) {
    toRotationVector(multiply(sample, conjugate(state.sample, inverse), turn), change);
    slerp(value, sample, shareOf(velocity, tuning, deltaSeconds), value);
  }
  copyQuat(sample, state.sample);
  return value;
}
