import { clamp, dampedShare, smoothstep } from '../math/damper';
import { fromAxisAngle, type Quat, rotate, twistAngle } from '../math/quat';
import { right, up } from '../math/vec3';
import { headingOf } from './heading';

/** As far [rad] as people turn their head without their body: 40°. Beyond it the body comes along. */
const headTurn = 0.7;
/** Half-life [s] of what the heading is beyond that from the body's. */
const followHalfLife = 0.04;
/** Half-life [s] of what it is within: who keeps looking to one side stands that way. */
const settleHalfLife = 0.6;
/** A body turns at most this fast [rad/s]; a pirouette does 12. */
const turnSpeed = 14;
/** The horizontal part of the head's right axis where its heading begins to mean something, and where it is sure. */
const [vague, sure] = [0.35, 0.7];
/** Followed in steps of at most this [s], so that every frame rate gives the same. */
const longestStep = 1 / 240;

/** Which way somebody's body faces, as far as the head tells; one per avatar. */
export interface BodyHeading {
  /** The body's yaw as a rotation about +Y; deltaSeconds since the last call. The first call: that of the head. */
  follow(head: Quat, deltaSeconds: number): Quat;
  reset(): void;
}

/**
 * The yaw of a body under a turning head: still where only the head turns, slow to settle, limited in speed, and kept where the head
 * is so tilted that its heading is hardly defined.
 */
export function createBodyHeading(): BodyHeading {
  let yaw: number | null = null;
  return {
    follow(head, deltaSeconds) {
      const heading = twistAngle(headingOf(head), up);
      if (yaw === null) yaw = heading;
      const side = rotate(head, right);
      const defined = smoothstep(vague, sure, Math.hypot(side.x, side.z));
      const steps = Math.ceil(Math.max(deltaSeconds, 0) / longestStep);
      const step = deltaSeconds / steps;
      for (let i = 0; i < steps; i++) {
        const error = Math.atan2(Math.sin(heading - yaw), Math.cos(heading - yaw));
        const within = clamp(error, -headTurn, headTurn);
        const way = (error - within) * dampedShare(followHalfLife, step) + within * dampedShare(settleHalfLife, step);
        yaw += defined * clamp(way, -turnSpeed * step, turnSpeed * step);
      }
      return fromAxisAngle(up, yaw);
    },
    reset() {
      yaw = null;
    },
  };
}
