import { dampVec3 } from '../math/damper';
import { add, addScaled, subtract, type Vec3, zero } from '../math/vec3';
import { type JointPositions, mapJoints } from './joint-positions';

/** Half-life [s] of the joints about the head: a tenth of a degree of noise in the headset moves hips by a millimetre. */
const bodyHalfLife = 0.02;
/** Half-life [s] of the head's position below which noise is not followed; constant velocities are, without lag. */
const headHalfLife = 0.035;

/** Takes the trackers' noise out of joints that nobody tracks; one per avatar, for head and hands are never touched. */
export interface SteadyJoints {
  /** Joints and head position [m], floor frame; deltaSeconds since the last call. */
  follow(joints: JointPositions, head: Vec3, deltaSeconds: number): JointPositions;
  reset(): void;
}

/**
 * The joints relative to the head are damped; the head they hang from passes a critically damped g-h filter (Brookner,
 * Tracking and Kalman Filtering Made Easy, 1998), which keeps pace with somebody who walks. The first call passes unchanged.
 */
export function createSteadyJoints(): SteadyJoints {
  let relative: JointPositions | null = null;
  let position: Vec3 = zero;
  let velocity: Vec3 = zero;

  function followHead(head: Vec3, deltaSeconds: number): void {
    if (deltaSeconds <= 0) return;
    const memory = 2 ** (-deltaSeconds / headHalfLife);
    const predicted = addScaled(position, velocity, deltaSeconds);
    const surprise = subtract(head, predicted);
    position = addScaled(predicted, surprise, 1 - memory * memory);
    velocity = addScaled(velocity, surprise, (1 - memory) ** 2 / deltaSeconds);
  }

  return {
    follow(joints, head, deltaSeconds) {
      const goal = mapJoints((joint) => subtract(joints[joint], head));
      const before = relative;
      if (before === null) {
        relative = goal;
        position = head;
        velocity = zero;
      } else {
        relative = mapJoints((joint) => dampVec3(before[joint], goal[joint], bodyHalfLife, deltaSeconds));
        followHead(head, deltaSeconds);
      }
      const now = relative;
      return mapJoints((joint) => add(now[joint], position));
    },
    reset() {
      relative = null;
    },
  };
}
