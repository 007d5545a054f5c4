import { describe, expect, test } from 'vitest';
import { makeUpperBodyPose } from '../../../../src/threepoint/core/body/avatar-pose';
import { defaultCalibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { flatHand } from '../../../../src/threepoint/core/body/hand-shape';
import { skeletonFromCalibration, wristFromHandBone } from '../../../../src/threepoint/core/body/skeleton';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import { conjugate, fromAxisAngle, multiply, type Quat, rotate } from '../../../../src/threepoint/core/math/quat';
import {
  backward,
  distance,
  dot,
  forward,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../../../../src/threepoint/core/math/vec3';
import { toXRBody } from '../../../../src/threepoint/core/motion/xr-body';
import { actorFrame } from '../../../../src/threepoint/core/tracking/actor-motion';

const hand = (side: string) => [
  ...['palm', 'wrist', 'thumb-metacarpal', 'thumb-phalanx-proximal', 'thumb-phalanx-distal', 'thumb-tip'],
  ...['index', 'middle', 'ring', 'little'].flatMap((finger) =>
    ['metacarpal', 'phalanx-proximal', 'phalanx-intermediate', 'phalanx-distal', 'tip'].map((part) => `${finger}-${part}`),
  ),
].map((joint) => `${side}-hand-${joint}`); // biome-ignore format: a list
const arm = (side: string) =>
  ['shoulder', 'scapula', 'arm-upper', 'arm-lower', 'hand-wrist-twist'].map((joint) => `${side}-${joint}`);
const leg = (side: string) =>
  ['upper-leg', 'lower-leg', 'foot-ankle-twist', 'foot-ankle', 'foot-subtalar', 'foot-transverse', 'foot-ball'].map(
    (joint) => `${side}-${joint}`,
  );
/**
 * The specification's list (WebXR Body Tracking Module, XRBodyJoint), with one spelling for the middle fingers of both
 * hands.
 */
const listed = [
  ...['hips', 'spine-lower', 'spine-middle', 'spine-upper', 'chest', 'neck', 'head'],
  ...['left', 'right'].flatMap(arm),
  ...['left', 'right'].flatMap(hand),
  ...['left', 'right'].flatMap(leg),
];

const skeleton = skeletonFromCalibration(defaultCalibration);
const standing = makeUpperBodyPose();
standing.hipsPosition.y = skeleton.restOffsets.hips.y;

const axis = (orientation: Quat, of: Vec3) => rotate(orientation, of);
const expectAlong = (orientation: Quat, of: Vec3, direction: Vec3, name: string) =>
  expect(dot(axis(orientation, of), direction), name).toBeGreaterThan(0.97);

describe('a body as WebXR has it', () => {
  test('has the 83 joints of the specification in their order', () => {
    expect([...toXRBody(standing, defaultCalibration).keys()]).toEqual(listed);
    expect(listed.length).toBe(83);
  });

  test('in T-pose has −Z along bones, +Y out of the back of trunk, hands, feet', () => {
    const joints = toXRBody(standing, defaultCalibration, { left: flatHand, right: flatHand });
    const of = (name: string) => joints.get(name)!.orientation;
    for (const name of ['hips', 'spine-middle', 'chest', 'head']) {
      expectAlong(of(name), forward, up, name);
      expectAlong(of(name), up, backward, name);
    }
    for (const [side, out] of [
      ['left', vec3(-1, 0, 0)],
      ['right', vec3(1, 0, 0)],
    ] as const) {
      for (const name of ['arm-lower', 'hand-wrist', 'hand-palm', 'hand-index-phalanx-distal', 'hand-ring-tip']) {
        expectAlong(of(`${side}-${name}`), forward, out, name);
        expectAlong(of(`${side}-${name}`), up, up, name);
      }
      expectAlong(of(`${side}-lower-leg`), forward, vec3(0, -1, 0), 'lower-leg');
      expect(dot(axis(of(`${side}-foot-ankle`), forward), forward)).toBeGreaterThan(0.8);
      expect(joints.get(`${side}-hand-middle-tip`)!.position.x * out.x).toBeGreaterThan(0.8);
      expect(joints.get(`${side}-foot-ankle`)!.position.y).toBeCloseTo(0.08, 1);
    }
  });

  test('has joints as in kinematics and wrists as tracked, wherever the wearer stands', () => {
    const turn = fromAxisAngle(up, -2.1);
    const estimator = createIk(defaultCalibration);
    for (let i = 0; i < 200; i++) {
      const acted = actorFrame(i / 60, defaultCalibration);
      const place = <Tracked extends NonNullable<typeof acted.leftHand>>(pose: Tracked | null): Tracked | null =>
        pose && { ...pose, position: rotate(turn, pose.position), orientation: multiply(turn, pose.orientation) };
      const frame = {
        ...acted,
        head: place(acted.head)!,
        leftHand: place(acted.leftHand),
        rightHand: place(acted.rightHand),
      };
      const { body } = estimator.update(frame).pose;
      const joints = toXRBody(body!, defaultCalibration);
      const truth = forwardKinematics(skeleton, body!);
      for (const [name, bone] of [
        ['hips', 'hips'],
        ['chest', 'upperChest'],
        ['head', 'head'],
        ['left-arm-upper', 'leftUpperArm'],
        ['right-arm-lower', 'rightLowerArm'],
        ['left-hand-wrist', 'leftHand'],
      ] as const) {
        expect(distance(joints.get(name)!.position, truth[bone].position), name).toBeLessThan(1e-4);
      }
      for (const side of ['left', 'right'] as const) {
        const wrist = multiply(truth[`${side}Hand`].orientation, conjugate(wristFromHandBone[side]));
        expect(joints.get(`${side}-hand-wrist`)!.orientation).toBeSameRotationAs(wrist, 0.1);
        const bone = subtract(truth[`${side}Hand`].position, truth[`${side}LowerArm`].position);
        const along = axis(joints.get(`${side}-arm-lower`)!.orientation, forward);
        expect(dot(along, bone) / distance(bone, vec3(0, 0, 0))).toBeGreaterThan(0.9999);
      }
    }
  });
});
