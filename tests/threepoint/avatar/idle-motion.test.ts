import { readFileSync } from 'node:fs';
import { actorFrame, defaultCalibration } from 'threepoint/core';
import { distance, right, rotate, type Vec3 } from 'threepoint/math';
import { beforeAll, describe, expect, test } from 'vitest';
import { type Avatar, createAvatar } from '../../../src/threepoint/avatar/avatar';
import { IdleMotion } from '../../../src/threepoint/avatar/idle-motion';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { copyAvatarPose } from '../../../src/threepoint/core/body/avatar-pose';
import { forwardKinematics } from '../../../src/threepoint/core/body/forward-kinematics';
import { averageSkeleton } from '../../../src/threepoint/core/body/skeleton';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { poseOf } from '../core/estimation/drawn';

const rateHz = 72;
const file = readFileSync(new URL('../../../public/avatars/woman.vrm', import.meta.url));
/** One pose: a person who stands still. */
const pose = poseOf(createIk(defaultCalibration), { ...actorFrame(0, defaultCalibration), time: 0 });
const still = ['head', 'leftHand', 'rightHand', 'leftLowerArm', 'rightLowerArm', 'leftFoot', 'rightFoot'] as const;
const moving = ['hips', 'chest', 'leftUpperArm', 'rightUpperArm'] as const;
type Tracks = Record<(typeof still | typeof moving)[number], Vec3[]>;

async function wear(): Promise<Avatar> {
  const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
  const avatar = createAvatar(await parseAvatar(bytes, 'woman.vrm'));
  avatar.setCalibration(defaultCalibration);
  return avatar;
}

/** Holds the pose from `start` on for so long [s]; returns the drawn joints of all frames. */
function hold(avatar: Avatar, start: number, seconds: number): Tracks {
  const names = [...still, ...moving];
  const tracks = Object.fromEntries(names.map((name) => [name, [] as Vec3[]])) as Tracks;
  for (let frame = 0; frame < seconds * rateHz; frame++) {
    avatar.setPose(pose, start + frame / rateHz);
    const joints = avatar.jointPositions();
    for (const name of names) tracks[name].push({ ...joints[name]! });
  }
  return tracks;
}

/** How far a joint moves from its first place at most [m]. */
const reach = ([first, ...rest]: readonly Vec3[]): number => Math.max(...rest.map((at) => distance(at, first!)));
/** The largest step of a joint between two frames [m]. */
const largestStep = (track: readonly Vec3[]): number =>
  Math.max(...track.slice(1).map((at, i) => distance(at, track[i]!)));

describe('a body at rest', () => {
  let avatar: Avatar;
  beforeAll(async () => {
    avatar = await wear();
  });

  test('is still unless a page asks for idle motion', () => {
    const tracks = hold(avatar, 0, 5);
    for (const name of moving) expect(reach(tracks[name]), name).toBeLessThan(1e-6);
  });

  test('breathes and shifts its weight by millimetres, with head, hands and feet in place', { tags: ['full'] }, () => {
    avatar.setIdleMotion(true);
    const unchanged = copyAvatarPose(pose);
    const tracks = hold(avatar, 5, 40);
    for (const name of still) expect(reach(tracks[name]), name).toBeLessThan(3e-4);
    for (const name of moving) {
      expect(reach(tracks[name]), name).toBeGreaterThan(2e-3);
      expect(reach(tracks[name]), name).toBeLessThan(2e-2);
      // A tenth of a millimetre a frame at 72 Hz is 7 mm/s.
      expect(largestStep(tracks[name]), name).toBeLessThan(4e-4);
    }
    expect(pose).toEqual(unchanged);
  });

  test('raises both shoulders about fifteen times a minute', { tags: ['full'] }, () => {
    const { leftUpperArm } = hold(avatar, 45, 40);
    const height = leftUpperArm.map(({ y }) => y);
    const middle = (Math.min(...height) + Math.max(...height)) / 2;
    const breaths = height.filter((y, i) => i > 0 && y >= middle && height[i - 1]! < middle).length;
    expect(breaths).toBeGreaterThanOrEqual(9);
    expect(breaths).toBeLessThanOrEqual(11);
  });

  test('comes to rest without a jump when idle motion is turned off', () => {
    avatar.setIdleMotion(false);
    const tracks = hold(avatar, 85, 5);
    for (const name of moving) {
      expect(largestStep(tracks[name]), name).toBeLessThan(8e-4);
      expect(reach(tracks[name].slice(-rateHz)), name).toBeLessThan(1e-4);
    }
  });

  test('moves at other times than a body with another seed', () => {
    const heights = [1, 2, 1].map((seed) => {
      const idle = new IdleMotion(seed);
      idle.isOn = true;
      return Array.from({ length: 8 * rateHz }, () => {
        const joints = forwardKinematics(averageSkeleton(defaultCalibration), pose.body!);
        idle.apply(joints, 1 / rateHz);
        return rotate(joints.rightShoulder.orientation, right).y;
      });
    });
    expect(heights[0]).toEqual(heights[2]);
    expect(Math.max(...heights[0]!.map((height, i) => Math.abs(height - heights[1]![i]!)))).toBeGreaterThan(5e-3);
  });
});
