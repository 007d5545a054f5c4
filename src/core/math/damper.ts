import { type Quat, slerp } from './quat';
import { lerp, type Vec3 } from './vec3';

/**
 * The share of the way to its goal that an exponential damper goes in `deltaSeconds`: half of it in every half-life, at any frame
 * rate. A half-life of 0 arrives at once; no time, no way.
 */
export function dampedShare(halfLifeSeconds: number, deltaSeconds: number): number {
  if (deltaSeconds <= 0) return 0;
  return halfLifeSeconds <= 0 ? 1 : 1 - 2 ** (-deltaSeconds / halfLifeSeconds);
}

export const damp = (current: number, goal: number, halfLifeSeconds: number, deltaSeconds: number): number =>
  current + (goal - current) * dampedShare(halfLifeSeconds, deltaSeconds);

export const dampVec3 = (current: Vec3, goal: Vec3, halfLifeSeconds: number, deltaSeconds: number): Vec3 =>
  lerp(current, goal, dampedShare(halfLifeSeconds, deltaSeconds));

export const dampQuat = (current: Quat, goal: Quat, halfLifeSeconds: number, deltaSeconds: number): Quat =>
  slerp(current, goal, dampedShare(halfLifeSeconds, deltaSeconds));

/** 0 at and below `start`, 1 at and above `end`, smooth between (zero slope at both ends). */
export function smoothstep(start: number, end: number, value: number): number {
  const t = Math.max(0, Math.min(1, (value - start) / (end - start)));
  return t * t * (3 - 2 * t);
}

/** As `smoothstep`, nearly even: from rest up to speed in a fifth of the way's time, back to rest in the last; at most 1.25 times the mean speed. */
export function evenStep(start: number, end: number, value: number): number {
  const ramp = 0.2;
  const t = Math.max(0, Math.min(1, (value - start) / (end - start)));
  if (t > 1 - ramp) return 1 - (1 - t) ** 2 / (2 * ramp * (1 - ramp));
  return t < ramp ? (t * t) / (2 * ramp * (1 - ramp)) : (t - ramp / 2) / (1 - ramp);
}

export const clamp = (value: number, low: number, high: number): number => Math.max(low, Math.min(high, value));
