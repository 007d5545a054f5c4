import { readFileSync } from 'node:fs';
import type { Quat } from 'threepoint/core/math/quat';
import { distance, type Vec3 } from 'threepoint/core/math/vec3';
import { makeJointPoses } from 'threepoint/core/motion/file-motion';
import { poseBvh, readBvh } from 'threepoint/core/motion/read-bvh';
import { finishWork } from 'threepoint/core/motion/work';
import { expect, test } from 'vitest';

interface GoldenFile {
  readonly text: string;
  readonly names: readonly string[];
  readonly frameRate: number;
  readonly positions: readonly (readonly [number, number, number])[][];
  readonly rotations: readonly (readonly [number, number, number, number])[][];
}

const files: readonly GoldenFile[] = JSON.parse(
  readFileSync(new URL('../../../golden/bvh.json', import.meta.url), 'utf8'),
);

test.each(files)('a BVH is read as Python reads it, every order of channels within 1e-5: file %#', (golden) => {
  const file = finishWork(readBvh(golden.text));
  expect(file.joints.map(({ name }) => name)).toEqual(golden.names);
  expect(1 / file.frameSeconds).toBeCloseTo(golden.frameRate, 6);
  expect(file.frameCount).toBe(golden.positions.length);
  const pose = makeJointPoses(file.joints.length);
  for (const [frame, positions] of golden.positions.entries()) {
    poseBvh(file, frame, pose);
    for (const [joint, [x, y, z]] of positions.entries()) {
      const at: Vec3 = { x, y, z };
      expect(distance(pose.positions[joint]!, at), `joint ${joint}, frame ${frame}`).toBeLessThan(1e-5);
      const [qx, qy, qz, qw] = golden.rotations[frame]![joint]!;
      const rotation: Quat = { x: qx, y: qy, z: qz, w: qw };
      expect(pose.rotations[joint]!).toBeSameRotationAs(rotation, 1e-4);
    }
  }
});
