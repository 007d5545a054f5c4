import { wrapAngle } from '../math/angle';
import { clamp, smoothingFactor } from '../math/damper';
import { fromAxisAngle, type MutableQuat, quat } from '../math/quat';
import { up } from '../math/vec3';
import type { Heading } from '../tracking/heading';

/** The angle [rad] by which people turn their head without their body: 40°. Beyond it the body turns too. */
const headTurn = 0.7;
/** Half-life [s] of the part of the angle from body to head beyond that. */
const followHalfLife = 0.04;
/** Half-life [s] of the part within: a person who keeps looking to one side stands that way. */
const settleHalfLife = 0.6;
/** The highest speed of a turning body [rad/s]; a pirouette reaches 12. */
const turnSpeed = 14;
/** The longest integration step [s], so that every frame rate gives the same result. */
const longestStep = 1 / 240;

export interface BodyHeading {
  /** The body's yaw about +Y [rad]; NaN before the first frame. */
  yaw: number;
}

export const makeBodyHeading = (): BodyHeading => ({ yaw: Number.NaN });

/**
 * Estimates the yaw of the body from the head, as a rotation about +Y. It stays while only the head turns, settles
 * slowly, is limited in speed, and is kept while the head's heading is not well defined. The first call returns the
 * head's.
 */
export function followBodyHeading(
  state: BodyHeading,
  head: Heading,
  deltaSeconds: number,
  target: MutableQuat = quat(0, 0, 0, 1),
): MutableQuat {
  if (Number.isNaN(state.yaw)) state.yaw = head.yaw;
  const steps = Math.ceil(Math.max(deltaSeconds, 0) / longestStep);
  const step = deltaSeconds / steps;
  const follow = smoothingFactor(followHalfLife, step);
  const settle = smoothingFactor(settleHalfLife, step);
  let { yaw } = state;
  for (let i = 0; i < steps; i++) {
    const error = wrapAngle(head.yaw - yaw);
    const within = clamp(error, -headTurn, headTurn);
    const turn = (error - within) * follow + within * settle;
    yaw += head.confidence * clamp(turn, -turnSpeed * step, turnSpeed * step);
  }
  state.yaw = yaw;
  return fromAxisAngle(up, yaw, target);
}
