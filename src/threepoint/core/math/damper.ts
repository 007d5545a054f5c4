import easing from './easing.json' with { type: 'json' };
import { lerp, type MutableVec3, type Vec3 } from './vec3';

/**
 * The fraction of the distance to its goal that exponential smoothing covers in `deltaSeconds`: half in every
 * half-life, at any frame rate. A half-life of 0 arrives at once; a step of no time or less covers nothing.
 */
export function smoothingFactor(halfLifeSeconds: number, deltaSeconds: number): number {
  if (deltaSeconds <= 0) return 0;
  return halfLifeSeconds <= 0 ? 1 : 1 - 2 ** (-deltaSeconds / halfLifeSeconds);
}

export const damp = (current: number, goal: number, halfLifeSeconds: number, deltaSeconds: number): number =>
  current + (goal - current) * smoothingFactor(halfLifeSeconds, deltaSeconds);

export const dampVec3 = (
  current: Vec3,
  goal: Vec3,
  halfLifeSeconds: number,
  deltaSeconds: number,
  target?: MutableVec3,
): MutableVec3 => lerp(current, goal, smoothingFactor(halfLifeSeconds, deltaSeconds), target);

/** Returns 0 at and below `start`, 1 at and above `end`, smooth between (zero slope at both ends). */
export function smoothstep(start: number, end: number, value: number): number {
  const t = Math.max(0, Math.min(1, (value - start) / (end - start)));
  return t * t * (3 - 2 * t);
}

/**
 * Returns trapezoidal easing: 0 at and below `start`, 1 at and above `end`. With ramp = `trapezoidalRamp`, the speed
 * rises evenly over the first ramp·duration, is constant, and falls evenly over the last ramp·duration; peak speed
 * 1/(1−ramp) of the mean, where smoothstep has 1.5.
 */
export function trapezoidalEasing(start: number, end: number, value: number): number {
  const ramp = easing.trapezoidalRamp;
  const t = Math.max(0, Math.min(1, (value - start) / (end - start)));
  if (t > 1 - ramp) return 1 - (1 - t) ** 2 / (2 * ramp * (1 - ramp));
  return t < ramp ? (t * t) / (2 * ramp * (1 - ramp)) : (t - ramp / 2) / (1 - ramp);
}

/** The value in [low, high] nearest to `value`; NaN stays NaN; `high` < `low` gives `low`. */
export const clamp = (value: number, low: number, high: number): number => Math.max(low, Math.min(high, value));
