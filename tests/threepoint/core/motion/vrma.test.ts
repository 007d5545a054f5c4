import { NodeIO } from '@gltf-transform/core';
import { type VRM, VRMLoaderPlugin } from '@pixiv/three-vrm';
import { createVRMAnimationClip, type VRMAnimation, VRMAnimationLoaderPlugin } from '@pixiv/three-vrm-animation';
import { validateBytes } from 'gltf-validator';
import { Quaternion, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { beforeAll, describe, expect, test } from 'vitest';
import { jointNames } from '../../../../src/threepoint/core/body/joints';
import { distance } from '../../../../src/threepoint/core/math/vec3';
import { createSkeletonPose } from '../../../../src/threepoint/core/motion/imported-motion';
import { poseBones } from '../../../../src/threepoint/core/motion/motion';
import { turnPoint, turnRotation } from '../../../../src/threepoint/core/motion/motion-bones';
import { clipTimes, writeVrma } from '../../../../src/threepoint/core/motion/write-vrma';
import { mannequin } from '../../avatar/glb';
import { actingPerson, bytesOf, contortedPerson, rateHz } from './moved-person';
import { playerOf } from './play-clip';

const people = { contorted: contortedPerson(), acting: actingPerson() };

/** A file as three.js and pixiv's loaders read it. */
async function load(bytes: ArrayBuffer) {
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMLoaderPlugin(parser));
  loader.register((parser) => new VRMAnimationLoaderPlugin(parser));
  return loader.parseAsync(bytes, '');
}

describe.each(Object.entries(people))('the %s person in a VRM Animation', (_, { motion, truth }) => {
  const bytes = bytesOf(writeVrma(motion));
  const pose = createSkeletonPose(motion.bones.length);
  let vrm: VRM;
  let play: (time: number) => void;

  beforeAll(async () => {
    vrm = (await load(mannequin())).userData.vrm as VRM;
    const [animation] = (await load(bytes.buffer)).userData.vrmAnimations as VRMAnimation[];
    play = playerOf(vrm.scene, createVRMAnimationClip(animation!, vrm));
  });

  test('turns every bone of another body as ours, within 0.1°, read by three-vrm-animation', () => {
    const rotation = new Quaternion();
    for (const [frame, joints] of truth.entries()) {
      play(motion.times[frame]!);
      poseBones(motion, frame, pose);
      for (const [i, { name, measured }] of motion.bones.entries()) {
        const node = vrm.humanoid.getNormalizedBoneNode(name as 'hips');
        if (!measured || !node) continue;
        node.getWorldQuaternion(rotation);
        const { x, y, z, w } = rotation;
        const turned = turnRotation({ x, y, z, w }, { x, y, z, w });
        const expected = joints.get(name)?.orientation ?? turnRotation(pose.rotations[i]!, { x, y, z, w });
        expect(turned).toBeSameRotationAs(expected, 0.1);
      }
    }
  });

  test('brings the hips where ours are within 1 mm, after what pixiv makes of another height', () => {
    const at = new Vector3();
    const theirs = vrm.humanoid.normalizedRestPose.hips!.position![1];
    const ours = motion.bones[0]!.offset.y;
    for (const [frame, joints] of truth.entries()) {
      play(motion.times[frame]!);
      const { x, y, z } = vrm.humanoid
        .getNormalizedBoneNode('hips')!
        .getWorldPosition(at)
        .multiplyScalar(ours / theirs);
      expect(distance(turnPoint({ x, y, z }), joints.get('hips')!.position)).toBeLessThan(1e-3);
    }
  });

  test('is found without fault by the validator', async () => {
    const { issues } = await validateBytes(bytes, { format: 'glb', writeTimestamp: false });
    // Below faults (0) and warnings (1) it notes that finger tips hold nothing, and that it does not know VRM's
    // extension.
    expect(issues.messages.filter(({ severity }) => severity < 2)).toEqual([]);
  });
});

describe('a VRM Animation', () => {
  const { motion } = people.acting;

  test('moves the hips alone, has legs at rest, and says that they are not measured', async () => {
    const json = (await new NodeIO().binaryToJSON(bytesOf(writeVrma(motion)))).json as unknown as {
      nodes: { name: string }[];
      animations: { channels: { target: { node: number; path: string } }[]; extras: { notMeasured: string[] } }[];
      extensions: { VRMC_vrm_animation: { humanoid: { humanBones: Record<string, { node: number }> } } };
    };
    const channels = json.animations[0]!.channels.map(({ target }) => ({
      ...target,
      name: json.nodes[target.node]!.name,
    }));
    expect(channels.filter(({ path }) => path === 'translation').map(({ name }) => name)).toEqual(['hips']);
    expect(channels.filter(({ path }) => path === 'rotation').length).toBe(jointNames.length + 30);
    const { notMeasured } = json.animations[0]!.extras;
    expect(notMeasured).toEqual(
      ['left', 'right'].flatMap((side) => ['UpperLeg', 'LowerLeg', 'Foot'].map((bone) => side + bone)),
    );
    for (const name of notMeasured) {
      const { node } = json.extensions.VRMC_vrm_animation.humanoid.humanBones[name]!;
      expect(channels.some((channel) => channel.node === node)).toBe(false);
    }
  });

  test('has times that rise in single precision, however near to each other frames are', () => {
    const times = Float64Array.from([0, 1000, 1000.000001, 1000.000002, 1001]);
    const seconds = clipTimes({ ...motion, times });
    for (let i = 1; i < seconds.length; i++) expect(seconds[i]).toBeGreaterThan(seconds[i - 1]!);
    expect(seconds.at(-1)).toBe(1001);
  });

  test('lasts as long as the motion', async () => {
    const [clip] = (await load(bytesOf(writeVrma(motion)).buffer)).animations;
    expect(clip!.duration).toBeCloseTo((motion.times.length - 1) / rateHz, 4);
  });
});
