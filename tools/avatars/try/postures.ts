import { fromAxes, identity, type Quat } from 'threepoint/core/math/quat';
import { cross, down, forward, normalise, right, scale, up, type Vec3, vec3 } from 'threepoint/core/math/vec3';
import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';

const left = scale(right, -1);
const inwards = { left: right, right: left };

/** A wrist whose fingers point this way and whose palm faces that way. */
function wrist(fingers: Vec3, palm: Vec3): Quat {
  const z = scale(normalise(fingers), -1);
  const y = scale(normalise(palm), -1);
  return fromAxes(cross(y, z), y, z);
}

const point = (position: Vec3, orientation: Quat) => ({ position, orientation, tracking: 'tracked' as const });

interface Hand {
  readonly at: Vec3;
  readonly fingers: Vec3;
  readonly palm: Vec3;
}

const posture = (head: Vec3, leftHand: Hand, rightHand: Hand): TrackingFrame => ({
  time: 0,
  head: point(head, identity),
  leftHand: point(leftHand.at, wrist(leftHand.fingers, leftHand.palm)),
  rightHand: point(rightHand.at, wrist(rightHand.fingers, rightHand.palm)),
});

const eyes = vec3(0, 1.59, 0);
const hanging: Hand = { at: vec3(-0.24, 0.83, 0.02), fingers: down, palm: inwards.left };

/** What a person of 1.70 m does on the pictures of a sheet: floor frame [m], facing −Z. */
export const postures: readonly { readonly name: string; readonly frame: TrackingFrame }[] = [
  {
    name: 'T-pose',
    frame: posture(
      eyes,
      { at: vec3(-0.74, 1.42, 0.08), fingers: left, palm: down },
      { at: vec3(0.74, 1.42, 0.08), fingers: right, palm: down },
    ),
  },
  {
    name: 'reach up',
    frame: posture(
      eyes,
      { at: vec3(-0.24, 1.98, -0.03), fingers: up, palm: forward },
      { at: vec3(0.24, 1.98, -0.03), fingers: up, palm: forward },
    ),
  },
  {
    name: 'bow drawn',
    frame: posture(
      eyes,
      { at: vec3(-0.1, 1.46, -0.66), fingers: forward, palm: right },
      { at: vec3(0.11, 1.47, -0.08), fingers: forward, palm: left },
    ),
  },
  {
    name: 'crouch',
    frame: posture(
      vec3(0, 1.02, -0.16),
      { at: vec3(-0.28, 0.68, -0.42), fingers: forward, palm: down },
      { at: vec3(0.28, 0.68, -0.42), fingers: forward, palm: down },
    ),
  },
  {
    name: 'wave',
    frame: posture(eyes, hanging, { at: vec3(0.47, 1.72, -0.14), fingers: up, palm: forward }),
  },
];
