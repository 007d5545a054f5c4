import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { makeUpperBodyPose } from '../../../../src/threepoint/core/body/avatar-pose';
import { defaultCalibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import type { JointName } from '../../../../src/threepoint/core/body/joints';
import { writeLocalRotations } from '../../../../src/threepoint/core/body/local-rotations';
import { averageSkeleton, skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { armBones } from '../../../../src/threepoint/core/estimation/arms/fit-arms';
import { createEstimator } from '../../../../src/threepoint/core/estimation/estimators';
import { mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import {
  makePaperOrientations,
  paperOrientations,
} from '../../../../src/threepoint/core/estimation/methods/paper-orientations';
import type { PoseRegressor } from '../../../../src/threepoint/core/estimation/networks/pose-regressor';
import { torsoBones } from '../../../../src/threepoint/core/estimation/trunk/torso-bones';
import { rotate } from '../../../../src/threepoint/core/math/quat';
import { sides } from '../../../../src/threepoint/core/math/side';
import { cross, distance, dot, normalise, right, subtract } from '../../../../src/threepoint/core/math/vec3';
import { completedFrame, show, showAll } from './drawn';
import { type GoldenFit, quat, readGolden, vec } from './golden';
import { movingPerson } from './moving-person';
import { openShippedModel } from './shipped-models';

describe.each(readGolden<GoldenFit[]>('fitted-joints.json'))(
  'the orientations of the paper, eyes at $calibration.eyeHeight m',
  ({ calibration, frames }) => {
    const skeleton = averageSkeleton(calibration);
    const drawn = frames.map(({ positions, rotations, estimated }) => {
      const pose = (index: number) => ({ position: vec(positions[index]!), orientation: quat(rotations[index]!) });
      const seen = completedFrame({ head: pose(0), leftHand: pose(1), rightHand: pose(2) }, calibration);
      const joints = mapJoints((_, index) => vec(estimated[index]!));
      const bones = { torso: torsoBones(skeleton), arm: armBones(skeleton) };
      const body = paperOrientations(joints, seen, bones.torso, bones.arm, makePaperOrientations());
      const pictured = makeUpperBodyPose();
      Object.assign(pictured.hipsPosition, body.hips);
      writeLocalRotations(body.trunk, seen.head.orientation, body.clavicles, body.arms, pictured.localRotations);
      return { seen, joints, body, bones: forwardKinematics(skeleton, pictured) };
    });

    test('place joints as their twin in Python does', () => {
      drawn.forEach(({ bones }, index) => {
        for (const [joint, place] of Object.entries(frames[index]!.published)) {
          expect(distance(bones[joint as JointName].position, vec(place)), `${joint}, frame ${index}`).toBeLessThan(
            1e-6,
          );
        }
      });
    });

    test('have the line of the estimated shoulders as the x axis of both shoulders', () => {
      for (const { joints, body } of drawn) {
        const line = normalise(subtract(joints.rightUpperArm, joints.leftUpperArm));
        for (const side of sides) expect(dot(rotate(body.clavicles[side], right), line)).toBeCloseTo(1, 6);
      }
    });

    test('bend elbows in the plane of the estimated elbow, up to hands within reach', () => {
      let reached = 0;
      for (const { seen, joints, bones } of drawn) {
        for (const side of sides) {
          const [shoulder, elbow, wrist] = (['UpperArm', 'LowerArm', 'Hand'] as const).map(
            (part) => bones[`${side}${part}`].position,
          ) as [typeof joints.chest, typeof joints.chest, typeof joints.chest];
          const tracked = seen[`${side}Hand`].position;
          if (distance(wrist, tracked) < 1e-6) reached += 1;
          else expect(distance(shoulder, tracked)).toBeGreaterThan(distance(shoulder, wrist) - 1e-6);
          const normal = normalise(cross(subtract(joints[`${side}LowerArm`], shoulder), subtract(tracked, shoulder)));
          expect(Math.abs(dot(subtract(elbow, shoulder), normal))).toBeLessThan(1e-6);
        }
      }
      expect(reached).toBeGreaterThan(drawn.length / 2);
    });
  },
);

describe('the method as published', () => {
  let regressor: PoseRegressor;
  beforeAll(async () => {
    regressor = await openShippedModel('paper');
  });
  afterAll(() => regressor.dispose());
  const at = movingPerson(7, defaultCalibration, { x: 1, z: -0.5, yaw: 2 });
  const create = () => createEstimator('paper-published', defaultCalibration, regressor);

  test('draws the hips at the network’s pelvis, unlike the fitted body', async () => {
    const joints = async (estimator: ReturnType<typeof create>) => {
      const { body } = await showAll(estimator, [at(1), at(1)]);
      return forwardKinematics(skeletonFromCalibration(defaultCalibration), body!);
    };
    const published = await joints(create());
    const fitted = await joints(createEstimator('paper', defaultCalibration, regressor));
    expect(distance(published.hips.position, fitted.hips.position)).toBeGreaterThan(0.005);
    expect(distance(published.hips.position, fitted.hips.position)).toBeLessThan(0.5);
  });

  test('draws a whole body before the first answer and for a lost hand', async () => {
    const estimator = create();
    expect(estimator.update(at(1)).pose.body!.hipsPosition.y).toBeGreaterThan(0.5);
    await showAll(estimator, [at(1), at(1.02)]);
    const { body, leftHand } = await show(estimator, { ...at(1.04), leftHand: null });
    expect(leftHand).toBeNull();
    for (const { x, y, z, w } of Object.values(body!.localRotations)) expect(Math.hypot(x, y, z, w)).toBeCloseTo(1, 6);
  });

  test('needs the network of the paper', () => {
    expect(() => createEstimator('paper-published', defaultCalibration)).toThrow(/needs the regressor of “paper”/);
  });
});
