import { Matrix4, Quaternion, Vector3 } from 'three';
import { createRandom, distance } from 'threepoint/math';
import { expect, test } from 'vitest';
import { createSkeletonPose } from '../../../../src/threepoint/core/motion/imported-motion';
import { poseBvh, readBvh } from '../../../../src/threepoint/core/motion/read-bvh';
import { finishWork } from '../../../../src/threepoint/core/motion/work';

/** Parent, axes of position and of rotation channels: every order, positions on inner joints, joints that are still. */
const joints: readonly (readonly [number, string, string])[] = [
  [-1, 'XYZ', 'ZXY'],
  [0, '', 'YXZ'],
  [1, 'ZYX', 'XYZ'],
  [2, '', ''],
  [0, '', 'ZYX'],
  [4, 'Y', 'XZY'],
  [5, '', 'YZX'],
  [0, '', 'Z'],
];
const frames = 6;

/** A file of random numbers, with its offsets and rows. */
function randomFile(random: () => number) {
  const offsets = joints.map(() => new Vector3(random(), random(), random()).multiplyScalar(4).subScalar(2));
  const channelsOf = ([, places, turns]: (typeof joints)[number]) => [
    ...[...places].map((axis) => `${axis}position`),
    ...[...turns].map((axis) => `${axis}rotation`),
  ];
  const lines = (i: number): string[] => {
    const children = joints.flatMap(([parent], child) => (parent === i ? [child] : []));
    const channels = channelsOf(joints[i]!);
    return [
      `${i === 0 ? 'ROOT' : 'JOINT'} joint ${i}`,
      '{',
      `OFFSET ${offsets[i]!.toArray().join(' ')}`,
      `CHANNELS ${channels.length} ${channels.join(' ')}`,
      ...(children.length > 0 ? children.flatMap(lines) : ['End Site', '{', 'OFFSET 0 1 0', '}']),
      '}',
    ];
  };
  const width = joints.reduce((sum, joint) => sum + channelsOf(joint).length, 0);
  const rows = Array.from({ length: frames }, () => Array.from({ length: width }, () => 360 * random() - 180));
  const text = [
    'HIERARCHY',
    ...lines(0),
    'MOTION',
    `Frames: ${frames}`,
    'Frame Time: 0.01',
    ...rows.map((row) => row.join(' ')),
  ];
  return { text: text.join('\n'), offsets, rows, channels: joints.map(channelsOf) };
}

const axes = { X: new Vector3(1, 0, 0), Y: new Vector3(0, 1, 0), Z: new Vector3(0, 0, 1) };

test.each([1, 2, 3])('channels of every order place joints as matrices do: file %i', (seed) => {
  const { text, offsets, rows, channels } = randomFile(createRandom(seed));
  const file = finishWork(readBvh(text));
  const found = file.joints.map(({ name }) => name);
  const pose = createSkeletonPose(file.joints.length);
  for (const [frame, row] of rows.entries()) {
    poseBvh(file, frame, pose);
    const worlds: Matrix4[] = [];
    let column = 0;
    // Depth first, as the file lists its joints and their numbers.
    for (const i of [0, 1, 2, 3, 4, 5, 6, 7]) {
      const place = offsets[i]!.clone();
      const turn = new Matrix4();
      for (const channel of channels[i]!) {
        const axis = channel[0] as keyof typeof axes;
        const value = row[column++]!;
        if (channel.endsWith('position')) place.setComponent('XYZ'.indexOf(axis), value);
        else turn.multiply(new Matrix4().makeRotationAxis(axes[axis], (value * Math.PI) / 180));
      }
      const world = (worlds[joints[i]![0]] ?? new Matrix4()).clone();
      worlds[i] = world.multiply(turn.setPosition(place));
      const index = found.indexOf(`joint ${i}`);
      expect(
        distance(pose.positions[index]!, new Vector3().setFromMatrixPosition(worlds[i])),
        `joint ${i}`,
      ).toBeLessThan(1e-6);
      expect(pose.rotations[index]!).toBeSameRotationAs(new Quaternion().setFromRotationMatrix(worlds[i]), 1e-6);
    }
  }
});
