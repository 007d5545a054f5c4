import { describe, expect, test } from 'vitest';
import { readGlbChunks } from '../../../../src/threepoint/avatar/file/glb-chunks';
import { distance } from '../../../../src/threepoint/core/math/vec3';
import { createSkeletonPose } from '../../../../src/threepoint/core/motion/imported-motion';
import { resampleMotion } from '../../../../src/threepoint/core/motion/motion';
import { turnPoint, turnRotation } from '../../../../src/threepoint/core/motion/motion-bones';
import { readVrma } from '../../../../src/threepoint/core/motion/read-vrma';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { writeVrma } from '../../../../src/threepoint/core/motion/write-vrma';
import { actingPerson, bytesOf, firstFrames, rateHz } from './moved-person';

const { motion, truth } = actingPerson();
const { json, binary } = readGlbChunks(bytesOf(writeVrma(motion)))!;

/** Returns the file with a replacement in its description. */
const changed = (from: string | RegExp, to: string): unknown => {
  expect(json).toMatch(from);
  return JSON.parse(json.replace(from, to));
};

test('a VRM Animation is read back within 1 mm and 0.1° where its frames lie', () => {
  const file = readVrma(JSON.parse(json), binary);
  expect(file.rateHz).toBe(60);
  const poses = createSkeletonPose(file.names.length);
  // Every fifth frame of 60 Hz is a sixth of 72 Hz.
  for (let frame = 0; frame < file.frameCount; frame += 5) {
    file.pose(frame, poses);
    const joints = truth[(frame * rateHz) / 60]!;
    for (const [i, name] of file.names.entries()) {
      const joint = joints.get(name);
      if (!joint) continue;
      expect(distance(turnPoint(poses.positions[i]!), joint.position), name).toBeLessThan(1e-3);
      const { x, y, z, w } = poses.rotations[i]!;
      if (joint.orientation)
        expect(turnRotation({ x, y, z, w }, { x, y, z, w })).toBeSameRotationAs(joint.orientation, 0.1);
    }
  }
});

test('between keys a bone is where straight lines and shorter arcs have it', () => {
  const file = readVrma(JSON.parse(json), binary);
  const even = finishWork(resampleMotion(motion, 60));
  const poses = createSkeletonPose(file.names.length);
  for (let frame = 1; frame < 60; frame++) {
    const { x, y, z } = file.pose(frame, poses).positions[file.names.indexOf('hips')]!;
    expect(
      distance({ x, y, z }, { x: even.hips[3 * frame]!, y: even.hips[3 * frame + 1]!, z: even.hips[3 * frame + 2]! }),
    ).toBeLessThan(1e-4);
  }
});

test.each([2, 60, 300, 601, 20_000])(
  'the reader loses none of %d frames at 60 Hz, though glTF rounds their times',
  (frames) => {
    // The actor's first two frames, the second of them moved to the end.
    const duration = (frames - 1) / 60;
    const short = { ...firstFrames(motion, 2), times: Float64Array.of(0, duration) };
    const chunks = readGlbChunks(bytesOf(writeVrma(short)))!;
    expect(readVrma(JSON.parse(chunks.json), chunks.binary).frameCount).toBe(frames);
  },
);

describe('what is no VRM Animation is refused in a sentence', () => {
  test.each([
    ['nothing', () => null, /no VRM Animation/],
    [
      'an avatar',
      () => changed('VRMC_vrm_animation":{', 'VRMC_vrm":{'),
      /there is no VRMC_vrm_animation with humanBones/,
    ],
    ['no clip', () => changed('"animations"', '"animated"'), /there is no animation in it/],
    [
      'a bone that is not there',
      () => changed('"hips":{"node":0', '"hips":{"node":9999'),
      /humanBones.hips is a node that is not there/,
    ],
    [
      'bones in a circle',
      () => changed(/("name":"head",[^}]*?)\}/, '$1,"children":[1]}'),
      /nodes\[1\] has two parents/,
    ],
    ['a bone with two parents', () => changed(/"children":\[1/, '"children":[1,1'), /nodes\[1\] has two parents/],
    [
      'a bone without a place',
      () => changed(/"translation":\[[^\]]*\]/, '"translation":[0,null,0]'),
      /nodes\[0\].translation is not 3 finite numbers/,
    ],
    [
      'numbers beyond the end',
      () => changed(/"byteOffset":0,/, '"byteOffset":99999999,'),
      /reaches beyond the end of the file/,
    ],
    [
      'fewer numbers than times',
      () => changed(/"count":\d+,"type":"VEC3"/, '"count":2,"type":"VEC3"'),
      /has 6 numbers for \d+ times/,
    ],
  ])('%s', (_, description, sentence) => {
    expect(() => readVrma(description(), binary)).toThrow(sentence);
  });

  test('a number that is not finite', () => {
    const spoilt = binary.slice();
    new DataView(spoilt.buffer).setFloat32(4 * motion.times.length, Number.NaN, true);
    expect(() => readVrma(JSON.parse(json), spoilt)).toThrow(/its number 1 is not finite/);
  });
});
