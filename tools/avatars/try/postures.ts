import type { TrackingFrame } from 'threepoint/core';
import {
  backward,
  cross,
  down,
  forward,
  fromAxes,
  fromAxisAngle,
  identity,
  normalise,
  type Quat,
  reject,
  right,
  scale,
  type TrackedPose,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';

const left = scale(right, -1);

/** A wrist whose fingers point this way and whose palm faces that way, as far as the fingers leave it. */
function wrist(fingers: Vec3, palm: Vec3): Quat {
  const z = scale(normalise(fingers), -1);
  const y = scale(normalise(reject(palm, z)), -1);
  return fromAxes(cross(y, z), y, z);
}

const point = (position: Vec3, orientation: Quat) => ({ position, orientation, tracking: 'tracked' as const });

interface Hand {
  readonly at: Vec3;
  readonly fingers: Vec3;
  readonly palm: Vec3;
}

const posture = (head: Vec3, leftHand: Hand, rightHand: Hand, facing: Quat = identity): TrackingFrame => ({
  time: 0,
  head: point(head, facing),
  leftHand: point(leftHand.at, wrist(leftHand.fingers, leftHand.palm)),
  rightHand: point(rightHand.at, wrist(rightHand.fingers, rightHand.palm)),
});

const eyes = vec3(0, 1.59, 0);
const mirrored = ({ x, y, z }: Vec3): Vec3 => vec3(-x, y, z);
/** Both hands alike, from the left one. */
const both = (hand: Hand): [Hand, Hand] => [
  hand,
  { at: mirrored(hand.at), fingers: mirrored(hand.fingers), palm: mirrored(hand.palm) },
];
/** By how much the body is turned to the left in a twist [rad]. */
const twisted = Math.PI / 3;

/** An ankle that a tracker pins, sole level, toes ahead. */
const ankle = (x: number, y: number, z: number): TrackedPose => point(vec3(x, y, z), identity);

const onKnees = both({ at: vec3(-0.13, 0.62, -0.36), fingers: forward, palm: down });

const hanging: Hand = { at: vec3(-0.24, 0.83, 0.02), fingers: down, palm: right };

interface Posture {
  readonly name: string;
  readonly frame: TrackingFrame;
}

/** What a person of 1.70 m does on the pictures of a sheet: floor frame [m], facing −Z. */
export const postures: readonly Posture[] = [
  {
    name: 'T-pose',
    frame: posture(eyes, ...both({ at: vec3(-0.74, 1.42, 0.08), fingers: left, palm: down })),
  },
  {
    name: 'reach up',
    frame: posture(eyes, ...both({ at: vec3(-0.24, 1.98, -0.03), fingers: up, palm: forward })),
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
    frame: posture(vec3(0, 1.02, -0.16), ...both({ at: vec3(-0.28, 0.68, -0.42), fingers: forward, palm: down })),
  },
  {
    name: 'wave',
    frame: posture(eyes, hanging, { at: vec3(0.47, 1.72, -0.14), fingers: up, palm: forward }),
  },
  {
    name: 'arms crossed',
    frame: posture(
      eyes,
      { at: vec3(0.1, 1.16, -0.27), fingers: vec3(1, 0.25, 0), palm: backward },
      { at: vec3(-0.1, 1.21, -0.32), fingers: vec3(-1, 0.2, 0), palm: backward },
    ),
  },
  {
    name: 'hands on hips',
    frame: posture(eyes, ...both({ at: vec3(-0.27, 1, -0.02), fingers: vec3(0.6, -0.3, -0.7), palm: right })),
  },
  {
    name: 'behind the head',
    frame: posture(eyes, ...both({ at: vec3(-0.11, 1.62, 0.12), fingers: vec3(1, 0.3, 0), palm: forward })),
  },
  {
    name: 'behind the back',
    frame: posture(
      eyes,
      { at: vec3(-0.06, 1.04, 0.17), fingers: right, palm: backward },
      { at: vec3(0.06, 1, 0.2), fingers: left, palm: backward },
    ),
  },
  {
    name: 'guard',
    frame: posture(
      eyes,
      { at: vec3(-0.12, 1.4, -0.38), fingers: vec3(0.2, 0.9, -0.3), palm: right },
      { at: vec3(0.14, 1.36, -0.28), fingers: vec3(-0.2, 0.9, -0.3), palm: left },
    ),
  },
  {
    name: 'bend',
    frame: posture(
      vec3(0, 1.14, -0.5),
      ...both({ at: vec3(-0.2, 0.6, -0.5), fingers: down, palm: right }),
      fromAxisAngle(right, -1),
    ),
  },
  {
    name: 'twist',
    frame: posture(
      eyes,
      { at: vec3(-0.49, 1.25, -0.05), fingers: vec3(-0.87, 0, -0.5), palm: vec3(0.5, 0, -0.87) },
      { at: vec3(-0.29, 1.25, -0.4), fingers: vec3(-0.87, 0, -0.5), palm: vec3(-0.5, 0, 0.87) },
      fromAxisAngle(up, twisted),
    ),
  },
];

/** What that person does with trackers at the joints of hips and feet. */
export const trackedPostures: readonly Posture[] = [
  {
    name: 'sitting',
    frame: {
      ...posture(vec3(0, 1.15, -0.14), ...onKnees),
      trackers: {
        hips: point(vec3(0, 0.55, 0), identity),
        leftFoot: ankle(-0.1, 0.085, -0.44),
        rightFoot: ankle(0.1, 0.085, -0.44),
      },
    },
  },
  {
    name: 'deep squat',
    frame: {
      ...posture(
        vec3(0, 0.87, -0.3),
        ...both({ at: vec3(-0.16, 0.62, -0.52), fingers: vec3(0.3, 0.1, -1), palm: right }),
      ),
      trackers: {
        hips: point(vec3(0, 0.36, 0.12), fromAxisAngle(right, -0.4)),
        leftFoot: ankle(-0.13, 0.085, -0.1),
        rightFoot: ankle(0.13, 0.085, -0.1),
      },
    },
  },
  {
    name: 'knee raised',
    frame: {
      ...posture(eyes, ...both(hanging)),
      trackers: {
        hips: point(vec3(0, 0.98, 0.1), identity),
        leftFoot: ankle(-0.1, 0.51, -0.34),
        rightFoot: ankle(0.1, 0.085, 0.1),
      },
    },
  },
];
