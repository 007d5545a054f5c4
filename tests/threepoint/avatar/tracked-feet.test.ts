import { describe, expect, test } from 'vitest';
import { createAvatar } from '../../../src/threepoint/avatar/avatar';
import type { LegPosture } from '../../../src/threepoint/avatar/legs/leg-posture';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { trackerAtJoint } from '../../../src/threepoint/core/body/tracker-offsets';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { pinning } from '../../../src/threepoint/core/estimation/pinning';
import { type Pose, transformPose } from '../../../src/threepoint/core/math/pose';
import { fromAxisAngle, multiply, rotate } from '../../../src/threepoint/core/math/quat';
import { distance, right, up, type Vec3, vec3 } from '../../../src/threepoint/core/math/vec3';
import { actorFrame } from '../../../src/threepoint/core/tracking/actor-motion';
import { mannequin } from './glb';
import { createLegs, proportions, standing, walking } from './walking-person';

const rateHz = 72;

/** A left foot that kicks ahead of the person, its toes turned out and up. */
const kick = (time: number, z = 0): Pose<'floor'> => ({
  position: vec3(-0.12, 0.2 + 0.08 * Math.sin(3 * time), z - 0.15 - 0.1 * Math.sin(4 * time)),
  orientation: multiply(fromAxisAngle(up, 0.4), fromAxisAngle(right, 0.3 * Math.sin(5 * time))),
});

function expectWhole({ legs }: LegPosture): void {
  for (const { hip, knee, ankle } of Object.values(legs)) {
    expect(Math.abs(distance(hip, knee) - proportions.upper)).toBeLessThan(1e-6);
    expect(Math.abs(distance(knee, ankle) - proportions.lower)).toBeLessThan(1e-6);
  }
}

describe('a tracked foot', () => {
  test.each([
    ['stands', standing, 0],
    ['walks', walking, -1],
  ] as const)(
    'is exactly where it is tracked while its person %s, and its bones keep their lengths',
    (_, person, pace) => {
      const posture = createLegs();
      const free = createLegs();
      for (let frame = 0; frame < 3 * rateHz; frame++) {
        const time = frame / rateHz;
        const left = kick(time, pace * time);
        posture.update(person(time), frame ? 1 / rateHz : 0, { left, right: null });
        free.update(person(time), frame ? 1 / rateHz : 0);
        expect(distance(posture.legs.left.ankle, left.position)).toBeLessThan(1e-3);
        expect(posture.legs.left.foot).toBeSameRotationAs(left.orientation);
        expect(posture.legs.right).toEqual(free.legs.right);
        expectWhole(posture);
      }
    },
  );

  test('goes back to the gait and comes from it without a jump, within 0.3 s', () => {
    const posture = createLegs();
    const free = createLegs();
    let before: Vec3 | null = null;
    for (let frame = 0; frame < 3 * rateHz; frame++) {
      const time = frame / rateHz;
      const lost = frame >= rateHz && frame < 2 * rateHz;
      posture.update(standing(time), frame ? 1 / rateHz : 0, { left: lost ? null : kick(time), right: null });
      free.update(standing(time), frame ? 1 / rateHz : 0);
      const { knee, ankle } = posture.legs.left;
      if (before) expect(distance(ankle, before)).toBeLessThan(0.05);
      before = { ...ankle };
      expect(Number.isFinite(knee.x)).toBe(true);
      if (lost && frame > 1.31 * rateHz) expect(distance(ankle, free.legs.left.ankle)).toBeLessThan(1e-9);
      expectWhole(posture);
    }
  });

  test('raised until the thigh is above the horizontal does not turn the thigh about itself', () => {
    const posture = createLegs();
    let before: Vec3 | null = null;
    let highest = 0;
    for (let frame = 0; frame <= rateHz; frame++) {
      const raised = frame / rateHz;
      const left = { position: vec3(-0.1, 0.1 + 0.6 * raised, -0.34), orientation: trackerAtJoint.orientation };
      posture.update(standing(raised), frame ? 1 / rateHz : 0, { left, right: null });
      const { hip, knee, thigh, shank } = posture.legs.left;
      const hinge = rotate(thigh, right);
      expect(hinge.x).toBeGreaterThan(0.9);
      expect(distance(hinge, rotate(shank, right))).toBeLessThan(1e-6);
      if (before) expect(distance(hinge, before)).toBeLessThan(0.05);
      before = hinge;
      highest = Math.max(highest, knee.y - hip.y);
    }
    expect(highest, 'the knee above the hip [m]').toBeGreaterThan(0.05);
  });

  test('moves the drawn ankle no further than itself on four ways out of reach and back', () => {
    const posture = createLegs();
    let before: { readonly tracked: Vec3; readonly ankle: Vec3 } | null = null;
    for (let frame = 0; frame <= 6 * rateHz; frame++) {
      const time = frame / rateHz;
      const tracked = vec3(-0.1, 0.15, -0.7 + 0.7 * Math.cos(time));
      const left = { position: tracked, orientation: trackerAtJoint.orientation };
      posture.update(standing(time), frame ? 1 / rateHz : 0, { left, right: null });
      const ankle = { ...posture.legs.left.ankle };
      expectWhole(posture);
      if (before) {
        expect(distance(ankle, before.ankle)).toBeLessThan(4 * distance(tracked, before.tracked) + 2e-3);
      }
      before = { tracked, ankle };
    }
  });

  test('is ignored when no leg reaches it', () => {
    const [posture, free] = [createLegs(), createLegs()];
    const far = { position: vec3(-0.1, 0.1, -1.5), orientation: trackerAtJoint.orientation };
    for (let frame = 0; frame < 10; frame++) {
      posture.update(standing(frame / rateHz), 1 / rateHz, { left: far, right: null });
      free.update(standing(frame / rateHz), 1 / rateHz);
    }
    expect(posture.legs).toEqual(free.legs);
  });

  test('moves the avatar’s own foot', async () => {
    const avatar = createAvatar(await parseAvatar(mannequin(), 'mannequin.vrm', {}));
    const estimator = createIk({ ...defaultCalibration, trackerOffsets: { rightFoot: trackerAtJoint } }, { pinning });
    avatar.setCalibration(defaultCalibration);
    const ahead = { position: vec3(0.12, 0.25, -0.2), orientation: fromAxisAngle(up, -0.3) };
    for (let frame = 0; frame < 5; frame++) {
      const tracked = actorFrame(0, defaultCalibration);
      const place = { position: tracked.head.position, orientation: fromAxisAngle(up, 0) };
      const onFloor = { position: vec3(place.position.x, 0, place.position.z), orientation: place.orientation };
      const rightFoot = { ...transformPose<'floor', 'heading'>(onFloor, ahead), tracking: 'tracked' as const };
      const pose = estimator.update({ ...tracked, time: frame / rateHz, trackers: { rightFoot } }).pose;
      avatar.setPose(pose, frame / rateHz);
      avatar.object.updateMatrixWorld(true);
      expect(distance(avatar.jointPositions().rightFoot!, rightFoot.position)).toBeLessThan(1e-3);
    }
    avatar.dispose();
  });
});
