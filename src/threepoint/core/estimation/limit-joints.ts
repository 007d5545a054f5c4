import { type EstimatedJoint, estimatedJoints } from '../body/joints';
import { rotate } from '../math/quat';
import { add, copyVec3, distance, lerp, type MutableVec3, subtract, type Vec3, vec3 } from '../math/vec3';
import type { CompletedFrame, CompletedHand } from './complete-hands';
import { type JointPositions, type MutableJointPositions, makeJoints, mapJoints } from './joint-positions';
import smoothing from './smoothing.json' with { type: 'json' };

const { catchUpSpeed, doubtfulSpeed } = smoothing;

export interface LimitJointsState {
  /** False before the first frame, which passes unchanged. */
  known: boolean;
  /** The joints from the headset [m], floor axes. */
  readonly relative: MutableJointPositions;
  /** Whether a joint has not reached its estimate yet. */
  readonly catchingUp: Record<EstimatedJoint, boolean>;
  readonly joints: MutableJointPositions;
}

export const makeLimitJointsState = (): LimitJointsState => ({
  known: false,
  relative: makeJoints(),
  catchingUp: mapJoints(() => false),
  joints: makeJoints(),
});

const wanted = vec3(0, 0, 0);
const carried = vec3(0, 0, 0);

/** Returns the confidence that this hand causes no jump; 1 for a lost hand, because its guess moves slowly. */
const steadiness = ({ source, confidence }: CompletedHand): number => (source === 'tracked' ? confidence : 1);

/** Moves `wanted` to at most this far [m] from `carried`; returns whether it was further. */
function approach(carried: Vec3, wanted: MutableVec3, most: number): boolean {
  const far = distance(wanted, carried);
  if (far <= most) return false;
  lerp(carried, wanted, most / far, wanted);
  return true;
}

/**
 * Limits the speed of the joints (stage 4), floor frame. Estimates jump without motion of the person when a lost hand
 * is reacquired elsewhere, and under a head on its side, whose heading is independent of the body's. Then, until the
 * joints have caught up, their speed relative to the head is limited to between `doubtfulSpeed` (no confidence) and
 * `catchUpSpeed` (full confidence) [m/s]. An elbow whose own hand jumps is not limited: the arm transition of stage 5
 * covers it.
 */
export function limitJoints(
  state: LimitJointsState,
  joints: JointPositions,
  { head, heading, bodyTurn, leftHand, rightHand }: CompletedFrame,
  deltaSeconds: number,
): MutableJointPositions {
  const { relative, catchingUp } = state;
  const confidence = Math.min(heading.confidence, steadiness(leftHand), steadiness(rightHand));
  const most = (doubtfulSpeed + (catchUpSpeed - doubtfulSpeed) * confidence) * Math.max(deltaSeconds, 0);
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    const hand = joint === 'leftLowerArm' ? leftHand : joint === 'rightLowerArm' ? rightHand : null;
    subtract(joints[joint], head.position, wanted);
    const doubtful = state.known && !hand?.jumped && (confidence < 1 || catchingUp[joint]);
    catchingUp[joint] = doubtful && approach(rotate(bodyTurn, relative[joint], carried), wanted, most);
    copyVec3(wanted, relative[joint]);
    add(head.position, wanted, state.joints[joint]);
  }
  state.known = true;
  return state.joints;
}

export function resetLimitJoints(state: LimitJointsState): void {
  state.known = false;
}
