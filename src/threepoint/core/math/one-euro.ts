import { damp, smoothingFactor } from './damper';
import { type Frame, type MutablePose, makePose, type Pose } from './pose';
import { copyQuat, slerp } from './quat';
import { copyVec3, distance, lerp, type MutableVec3, vec3 } from './vec3';

/**
 * The tuning of a low-pass whose cutoff rises with speed: steady at rest, without lag in motion (Casiez, Roussel and
 * Vogel, “1 € Filter”, CHI 2012).
 */
interface OneEuroTuning {
  /** Cutoff at rest, and of the low-pass on the speed [Hz]. */
  readonly restCutoff: number;
  /** The increase of the cutoff with speed [Hz per m/s]. */
  readonly cutoffPerSpeed: number;
}

/** Returns the half-life [s] of a first-order low-pass with this cutoff [Hz]. */
export const halfLifeOfCutoff = (cutoff: number): number => Math.LN2 / (2 * Math.PI * cutoff);

export interface FilteredPose<F extends Frame> {
  /** False before the first sample, which passes unchanged. */
  known: boolean;
  readonly value: MutablePose<F>;
  /** The position of the newest sample [m]. */
  readonly sample: MutableVec3;
  /** Filtered speed [m/s]. */
  speed: number;
}

export const makeFilteredPose = <F extends Frame>(): FilteredPose<F> => ({
  known: false,
  value: makePose(),
  sample: vec3(0, 0, 0),
  speed: 0,
});

/**
 * Filters the next sample; a step of no time keeps the value of a known state. The position's speed opens the filter
 * for the orientation too, because hands and heads that turn also move.
 */
export function filterPose<F extends Frame>(
  state: FilteredPose<F>,
  { position, orientation }: Pose<F>,
  { restCutoff, cutoffPerSpeed }: OneEuroTuning,
  deltaSeconds: number,
): void {
  const { value, sample } = state;
  if (!state.known) {
    copyVec3(position, value.position);
    copyQuat(orientation, value.orientation);
    state.speed = 0;
    state.known = true;
  } else if (deltaSeconds > 0) {
    const speed = distance(position, sample) / deltaSeconds;
    state.speed = damp(state.speed, speed, halfLifeOfCutoff(restCutoff), deltaSeconds);
    const cutoff = restCutoff + cutoffPerSpeed * state.speed;
    const fraction = smoothingFactor(halfLifeOfCutoff(cutoff), deltaSeconds);
    lerp(value.position, position, fraction, value.position);
    slerp(value.orientation, orientation, fraction, value.orientation);
  }
  copyVec3(position, sample);
}
