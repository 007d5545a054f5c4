import { type VRM, VRMLoaderPlugin } from '@pixiv/three-vrm';
import { createVRMAnimationClip, type VRMAnimation, VRMAnimationLoaderPlugin } from '@pixiv/three-vrm-animation';
import { validateBytes } from 'gltf-validator';
import { type Object3D, Quaternion, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { describe, expect, test } from 'vitest';
import { createAvatarMotionWriter } from '../../../src/threepoint/avatar/avatar-motion-writer';
import { turnPoint } from '../../../src/threepoint/core/motion/motion-bones';
import { writeVrma } from '../../../src/threepoint/core/motion/write-vrma';
import { actingPerson, bytesOf, contortedPerson } from '../core/motion/moved-person';
import { playerOf } from '../core/motion/play-clip';
import { builtRig } from './built-rig';
import { mannequin, old } from './glb';

const people = { contorted: contortedPerson(20), acting: actingPerson(2) };

async function load(bytes: ArrayBuffer, asVrm: boolean) {
  const loader = new GLTFLoader();
  if (asVrm) {
    loader.register((parser) => new VRMLoaderPlugin(parser));
    loader.register((parser) => new VRMAnimationLoaderPlugin(parser));
  }
  return loader.parseAsync(bytes, '');
}

const nodesOf = (scene: Object3D): ReadonlyMap<string, Object3D> => {
  const nodes = new Map<string, Object3D>();
  scene.traverse((node) => nodes.set(node.userData.name ?? node.name, node));
  return nodes;
};

describe.each([
  ['our mannequin', mannequin],
  ['a VRM 0.x', () => old],
])('%s with a clip', (_, avatar) => {
  test.each(Object.entries(people))(
    'moves in three.js as pixiv’s player moves it, the %s person, to 1 mm and 0.1°',
    async (_, { motion }) => {
      const bytes = bytesOf((await createAvatarMotionWriter(avatar(), 'me.vrm')).write(motion));
      const ours = await load(bytes.buffer, false);
      const playOurs = playerOf(ours.scene, ours.animations[0]!);
      const vrm = (await load(avatar(), true)).userData.vrm as VRM;
      const [animation] = (await load(bytesOf(writeVrma(motion)).buffer, true)).userData
        .vrmAnimations as VRMAnimation[];
      const playTheirs = playerOf(vrm.scene, createVRMAnimationClip(animation!, vrm));
      const nodes = nodesOf(ours.scene);
      let compared = 0;
      for (const time of motion.times) {
        playOurs(time);
        playTheirs(time);
        vrm.humanoid.update();
        vrm.scene.updateMatrixWorld(true);
        for (const { name, measured } of motion.bones) {
          const theirs = measured && vrm.humanoid.getRawBoneNode(name as 'hips');
          if (!theirs) continue;
          const node = nodes.get(name)!;
          const apart = node.getWorldPosition(new Vector3()).distanceTo(theirs.getWorldPosition(new Vector3()));
          expect(apart, `${name} at ${time} s`).toBeLessThan(1e-3);
          const angle = node.getWorldQuaternion(new Quaternion()).angleTo(theirs.getWorldQuaternion(new Quaternion()));
          expect((angle * 180) / Math.PI, `${name} at ${time} s`).toBeLessThan(0.1);
          compared += 1;
        }
      }
      expect(compared).toBeGreaterThan(30 * motion.times.length);
    },
  );
});

describe('an avatar with a clip', () => {
  const { motion, truth } = people.acting;

  test('points arms that hung down, in centimetres, where the person’s are', async () => {
    const file = builtRig({ nameOf: (bone) => bone, armsDown: 50, unit: 100 });
    const bytes = bytesOf(
      (await createAvatarMotionWriter(file, 'person.glb', { bones: namesOf(motion) })).write(motion),
    );
    const { scene, animations } = await load(bytes.buffer, false);
    const play = playerOf(scene, animations[0]!);
    const nodes = nodesOf(scene);
    const at = (name: string) => nodes.get(name)!.getWorldPosition(new Vector3());
    const along = (from: Vector3, to: Vector3) => to.clone().sub(from).normalize();
    for (const [frame, joints] of truth.entries()) {
      play(motion.times[frame]!);
      for (const side of ['left', 'right']) {
        const [elbow, wrist] = [`${side}LowerArm`, `${side}Hand`];
        const of = (name: string) => new Vector3().copy(turnPoint(joints.get(name)!.position));
        const angle = along(at(elbow), at(wrist)).angleTo(along(of(elbow), of(wrist)));
        expect((angle * 180) / Math.PI).toBeLessThan(0.1);
      }
    }
  });

  test('keeps what is in its file and adds no fault for the validator', async () => {
    const bytes = bytesOf((await createAvatarMotionWriter(mannequin(), 'me.vrm')).write(motion));
    const faults = async (file: Uint8Array) => {
      const { issues, info } = await validateBytes(file, { format: 'glb', writeTimestamp: false });
      return { info, codes: new Set(issues.messages.filter(({ severity }) => severity < 2).map(({ code }) => code)) };
    };
    const { info, codes } = await faults(bytes);
    expect(codes).toEqual((await faults(new Uint8Array(mannequin()))).codes);
    expect(info.extensionsUsed).toEqual(['VRMC_vrm']);
    const vrm = (await load(bytes.buffer, true)).userData.vrm as VRM;
    expect(vrm.humanoid.getRawBoneNode('leftIndexDistal')).not.toBeNull();
  });

  test('is refused in a sentence where the file is no avatar', async () => {
    await expect(createAvatarMotionWriter(new ArrayBuffer(40), 'me.vrm')).rejects.toThrow(
      /^me.vrm: not a VRM or GLB file/,
    );
    await expect(createAvatarMotionWriter(mannequin().slice(0, 90_000), 'me.vrm')).rejects.toThrow(/^me.vrm: /);
  });
});

function namesOf({ bones }: typeof people.acting.motion): Record<string, string> {
  const without = ['RingProximal', 'RingIntermediate', 'RingDistal', 'MiddleIntermediate', 'MiddleDistal'];
  return Object.fromEntries(
    bones.filter(({ name }) => !without.some((end) => name.endsWith(end))).map(({ name }) => [name, name]),
  );
}
