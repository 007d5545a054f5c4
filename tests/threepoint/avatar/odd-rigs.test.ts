import { type Bone, Box3, Matrix4, type Mesh, type Object3D, type SkinnedMesh, Vector3 } from 'three';
import { type AvatarPose, actorFrame, type BoneName, defaultCalibration } from 'threepoint/core';
import { distance, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { checkAvatar } from '../../../src/threepoint/avatar/file/check-avatar';
import { parseAvatar, parseChecked } from '../../../src/threepoint/avatar/load-avatar';
import { thirdPersonOnlyLayer } from '../../../src/threepoint/avatar/rig/body-meshes';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { postures } from '../../../tools/avatars/try/postures';
import { poseOf } from '../core/estimation/drawn';
import { builtRig, type RigOptions, rigJoints } from './built-rig';
import { changed, type GltfJson } from './glb';
import { mixamo } from './rig-namings';
import { smallOldVrm } from './small-vrms';
import { expectBody, opened, skinAt, type Worn, wear } from './worn-body';

const nameOf = mixamo('mixamorig:');
const middle = (corners: readonly Vector3[]): Vector3 =>
  corners.reduce((sum, corner) => sum.add(corner), new Vector3()).divideScalar(corners.length);

/** Two metres ahead and one to the side of the origin, with hands before the body; returns what was estimated. */
function walkAway(worn: Worn): AvatarPose {
  const ik = createIk(defaultCalibration);
  const frame = actorFrame(1, defaultCalibration);
  const moved = <Pose extends { readonly position: Vec3 } | null>(pose: Pose): Pose =>
    pose && { ...pose, position: vec3(pose.position.x + 1, pose.position.y, pose.position.z - 2) };
  const away = {
    ...frame,
    head: moved(frame.head),
    leftHand: moved(frame.leftHand),
    rightHand: moved(frame.rightHand),
  };
  let pose: AvatarPose | null = null;
  for (let step = 0; step < 30; step++) {
    pose = poseOf(ik, { ...away, time: step / 30 });
    worn.avatar.setPose(pose, step / 30);
  }
  worn.avatar.object.updateMatrixWorld(true);
  return pose!;
}

const nodeCalled = ({ avatar }: Worn, name: string): Object3D => {
  let found: Object3D | null = null;
  avatar.object.traverse((node) => {
    if (node.name === name || node.userData.name === name) found = node;
  });
  if (!found) throw new Error(`no node is called ${name}`);
  return found;
};
const centreOf = (node: Object3D): Vector3 => new Box3().setFromObject(node).getCenter(new Vector3());

describe('a body whose bones hang otherwise', () => {
  test('with its hips under its spine it is worn like any other, wherever its wearer goes', async () => {
    const worn = await opened({ nameOf, parents: { spine: null, hips: 'spine' } });
    walkAway(worn);
    const { hips } = worn.avatar.jointPositions();
    expect(distance(middle(skinAt(worn, 'hips')), hips!)).toBeLessThan(1e-3);
    expectBody(worn);
  });

  test('with limbs and head beside the hips it is too, by a map of its bones', async () => {
    const parents = { leftUpperLeg: null, rightUpperLeg: null, leftUpperArm: null, rightUpperArm: null, head: null };
    const bones = Object.fromEntries(rigJoints({}).map(({ bone }) => [bone, nameOf(bone)]));
    const worn = wear(await parseAvatar(builtRig({ nameOf, parents }), 'person.glb', { bones }));
    walkAway(worn);
    for (const joint of ['leftUpperLeg', 'rightFoot', 'head', 'leftHand'] as const) {
      expect(distance(middle(skinAt(worn, joint)), worn.avatar.jointPositions()[joint]!), joint).toBeLessThan(1e-3);
    }
    expectBody(worn);
  });
});

describe('a part outside the mapped bones follows the nearest of them', () => {
  const nearChest = (worn: Worn, place: Vector3) =>
    expect(place.distanceTo(middle(skinAt(worn, 'chest'))), 'near the chest').toBeLessThan(0.2);

  test('a mesh beside the skeleton', async () => {
    const worn = await opened({ nameOf, beside: { Backpack: [0, 1.15, -0.12] } });
    walkAway(worn);
    nearChest(worn, centreOf(nodeCalled(worn, 'Backpack')));
  });

  test.each([1, 100])('a joint of the skin beside the bones, in a file of %d units a metre', async (unit) => {
    const options: RigOptions = { nameOf, unit, more: [{ called: 'Belly', parent: null, at: [0, 1.12, 0.1] }] };
    const worn = await opened(options);
    walkAway(worn);
    nearChest(worn, middle(skinOf(worn, options, 'Belly')));
    expectBody(worn);
  });

  test('a joint of the skin from which the hips hang', async () => {
    const options: RigOptions = {
      ...{ nameOf, parents: { hips: 'Root' } },
      more: [{ called: 'Root', parent: null, at: [0, 1.12, 0.1] }],
    };
    const worn = await opened(options);
    walkAway(worn);
    nearChest(worn, middle(skinOf(worn, options, 'Root')));
    expectBody(worn);
  });

  test('a mesh near the head is hidden from its wearer’s eyes', async () => {
    const worn = await opened({ nameOf, beside: { Glasses: [0, 1.46, 0.08], Belt: [0, 0.98, 0.1] } });
    worn.avatar.setFirstPerson(true);
    const isSeen = (name: string) => nodeCalled(worn, name).layers.isEnabled(0);
    expect([isSeen('Glasses'), isSeen('Belt')]).toEqual([false, true]);
  });
});

/** The corners of the box of skin about a joint that bodies have no name for. */
function skinOf(worn: Worn, options: RigOptions, called: string): Vector3[] {
  const index = rigJoints(options).findIndex(({ bone }) => bone === called);
  let corners: Vector3[] = [];
  worn.avatar.object.traverse((node) => {
    if (!('isSkinnedMesh' in node) || node.name.includes('erase')) return;
    const mesh = node as SkinnedMesh;
    corners = Array.from({ length: 8 }, (_, corner) =>
      mesh.getVertexPosition(index * 8 + corner, new Vector3()).applyMatrix4(mesh.matrixWorld),
    );
  });
  return corners;
}

describe('a body of rigid parts', () => {
  test('shows its hands and its head where they are while nothing else is shown', async () => {
    const worn = await opened({ nameOf, rigid: true });
    const pose = walkAway(worn);
    const visible = () => {
      const names: string[] = [];
      worn.avatar.object.traverse((node) => {
        if ('isMesh' in node && (node as Mesh).visible) names.push(String(node.userData.name));
      });
      return names;
    };
    const all = visible();
    expect(all).toContain(nameOf('leftLowerArm'));
    const { body: _, ...hands } = pose;
    worn.avatar.setPose(hands as AvatarPose, 2);
    worn.avatar.object.updateMatrixWorld(true);
    expect(visible()).toEqual(all.filter((name) => /Hand|Head/.test(name)));
    const hand = nodeCalled(worn, nameOf('leftHand')).getWorldPosition(new Vector3());
    expect(distance(hand, hands.leftHand!.position)).toBeLessThan(1e-3);
    worn.avatar.setPose(pose, 3);
    worn.avatar.setUpperBodyOnly(true);
    expect(visible()).toEqual(all.filter((name) => !/Leg|Foot|Toe/.test(name)));
  });
});

describe('a file with what no one reads is taken', () => {
  const taken = async (change: (json: GltfJson) => void) => {
    const file = changed(change, builtRig({ nameOf }));
    const checked = await checkAvatar(file, { name: 'person.glb', supportedCompressions: [] });
    expectBody(wear(await parseChecked(checked)));
  };

  test('an empty list of children', async () => {
    await taken((json) => {
      json.nodes.find(({ children }) => !children)!.children = [];
    });
  });

  test('an animation that moves one node twice', async () => {
    await taken((json) => {
      const node = 1;
      const sampler = { input: 3, output: 0 };
      const channel = { sampler: 0, target: { node, path: 'translation' } };
      json.animations = [{ samplers: [sampler], channels: [channel, channel] }];
    });
  });

  test('an address in notes for other programs', async () => {
    await taken((json) => {
      Object.assign(json.nodes[1]!, { extras: { source: { uri: 'https://example.org/person.blend' } } });
    });
  });
});

test('a VRM 0.x without annotations for first person hides its head from its wearer', async () => {
  const bare = changed((json) => delete (json.extensions.VRM as { firstPerson?: object }).firstPerson, smallOldVrm);
  const { avatar } = wear(await parseAvatar(bare, 'person.vrm'));
  avatar.setFirstPerson(true);
  const layers: number[] = [];
  avatar.object.traverse((node) => {
    if ('isMesh' in node) layers.push(node.layers.mask);
  });
  expect(layers.toSorted()).toEqual([1, 1 << thirdPersonOnlyLayer].toSorted());
});

const fingers = ['left', 'right'].flatMap((side) =>
  ['ThumbMetacarpal', 'ThumbProximal', 'ThumbDistal']
    .concat(['IndexProximal', 'IndexIntermediate', 'IndexDistal', 'MiddleProximal'])
    .concat(['LittleProximal', 'LittleIntermediate', 'LittleDistal'])
    .map((bone) => `${side}${bone}`),
);
const clavicles = ['leftShoulder', 'rightShoulder'];
/** A joint on each side of the body: x is to the left. */
const onBoth = (called: string, parent: string, [x, y, z]: readonly [number, number, number]) =>
  (['left', 'right'] as const).map((side) => ({
    called: `${called}${called.endsWith('.') ? '' : '_'}${side[0]}`,
    parent: (parent.startsWith('$') ? parent.replace('$', side) : parent) as BoneName,
    at: [side === 'left' ? x : -x, y, z] as const,
  }));
const chain = (called: string, parent: BoneName, at: readonly (readonly [number, number, number])[]) =>
  at.map((place, i) => ({
    called: `${called}_${i}`,
    parent: (i === 0 ? parent : `${called}_${i - 1}`) as BoneName,
    at: place,
  }));

/** Three heads high: short legs and arms. */
const chibi: RigOptions['place'] = (_, at) => {
  at.set(0.6 * at.x, at.y < 0.92 ? 0.4 * at.y : 0.368 + 0.75 * (at.y - 0.92), 0.6 * at.z);
};

/** The names of KayKit's characters, whose hand is a bone beyond the wrist. */
const kayKit: RigOptions['nameOf'] = (bone) => {
  const [, side = '', part = bone] = /^(left|right)(.*)$/.exec(bone) ?? [];
  const name = part === 'Hand' ? 'wrist' : part.toLowerCase();
  return side ? `${name}.${side[0]}` : name;
};

const oddBones: readonly (readonly [string, Partial<RigOptions>])[] = [
  ['without a neck', { without: ['neck'] }],
  ['without clavicles', { without: clavicles }],
  ['without a chest', { without: ['chest', 'upperChest'] }],
  ['with one bone between hips and head', { without: ['chest', 'upperChest', 'neck', ...clavicles] }],
  ['with hands without fingers', { without: fingers }],
  [
    'with a wrist before each hand',
    {
      more: onBoth('Wrist', '$LowerArm', [0.55, 1.3, -0.02]),
      parents: { leftHand: 'Wrist_l', rightHand: 'Wrist_r' },
    },
  ],
  [
    'with twist bones',
    {
      more: [
        ...onBoth('LeftArmTwist', '$UpperArm', [0.25, 1.3, -0.02]),
        ...onBoth('LeftForeArmTwist', '$LowerArm', [0.47, 1.3, -0.02]),
        ...onBoth('UpLegTwist', '$UpperLeg', [0.08, 0.65, 0.01]),
      ],
    },
  ],
  [
    'with upper arms and forearms of two bones in line, under names that mean nothing',
    {
      nameOf: (bone) => `q${[...bone].reduce((sum, letter) => (31 * sum + letter.charCodeAt(0)) % 1e6, 0)}`,
      place: (bone, at) => void (/LowerArm$/.test(bone) && at.setZ(-0.03)),
      parents: { leftLowerArm: 'x1_l', rightLowerArm: 'x1_r', leftHand: 'x2_l', rightHand: 'x2_r' },
      more: [...onBoth('x1', '$UpperArm', [0.245, 1.3, -0.025]), ...onBoth('x2', '$LowerArm', [0.47, 1.3, -0.025])],
    },
  ],
  [
    'with goals and controls in its skin',
    {
      more: [
        { called: 'ROOT', parent: null, at: [0, 0, 0] },
        ...['HandIK', 'ElbowPole'].flatMap((called, i) =>
          onBoth(called, 'ROOT', [0.58 - 0.22 * i, 1.3, -0.02 - 0.3 * i]),
        ),
        ...onBoth('FootIK', 'ROOT', [0.08, 0.08, -0.02]),
      ],
    },
  ],
  [
    'with a head a third of its height',
    { place: chibi, more: [{ called: 'HeadTop', parent: 'head', at: [0, 1.1, 0] }] },
  ],
  [
    'with a skirt and a cape',
    {
      more: [
        ...chain('Skirt', 'hips', [[0, 0.85, 0.14], [0, 0.7, 0.18], [0, 0.55, 0.2]]), // biome-ignore format: a row
        ...chain('Cape', 'upperChest', [[0, 1.28, -0.12], [0, 1, -0.18], [0, 0.7, -0.22], [0, 0.4, -0.25]]), // biome-ignore format: a row
      ],
    },
  ],
  [
    'named as KayKit’s characters, with a wrist and a hand, without neck and clavicles',
    {
      nameOf: kayKit,
      without: ['neck', 'upperChest', ...clavicles, ...fingers],
      more: [...onBoth('hand.', '$Hand', [0.65, 1.3, -0.02]), ...onBoth('handslot.', '$Hand', [0.7, 1.28, -0.02])],
    },
  ],
  [
    'with its armature at the hips',
    { root: new Matrix4().makeTranslation(0, 0.92, 0), place: (_, at) => void at.setY(at.y - 0.92) },
  ],
];

/** Holds each posture and demands that hands and head are where the wearer's are. */
function expectHands(worn: Worn): void {
  for (const { name, frame } of postures) {
    const ik = createIk(defaultCalibration);
    for (let step = 0; step < 30; step++) worn.avatar.setPose(poseOf(ik, { ...frame, time: step / 30 }), step / 30);
    for (const side of ['left', 'right'] as const) {
      const { position } = frame[`${side}Hand`]!;
      expect(distance(middle(skinAt(worn, `${side}Hand`)), position), `${side} hand, ${name}`).toBeLessThan(1e-3);
    }
    const finite = Object.values(worn.avatar.jointPositions()).every(({ x, y, z }) => Number.isFinite(x + y + z));
    expect(finite, name).toBe(true);
  }
}

describe('a rig of few or odd bones has the wearer’s hands in twelve postures:', () => {
  test.each(oddBones)('%s', async (_, options) => {
    expectHands(await opened({ nameOf, ...options }));
  });

  test('with several skins', async () => {
    const file = changed((json) => {
      const body = json.nodes.findIndex(({ name }) => name === 'Body');
      json.skins.push({ ...json.skins[0]! });
      json.nodes[0]!.children!.push(json.nodes.push({ ...json.nodes[body]!, name: 'Clothes', skin: 1 }) - 1);
    }, builtRig({ nameOf }));
    const worn = wear(await parseAvatar(file, 'person.glb'));
    expectHands(worn);
    const skins: number[] = [];
    worn.avatar.object.traverse((node) => {
      if (!('isSkinnedMesh' in node) || node.name.includes('erase')) return;
      const mesh = node as SkinnedMesh;
      const hand = mesh.skeleton.bones.indexOf(worn.loaded.vrm.humanoid.getRawBoneNode('leftHand' as never) as Bone);
      const corner = mesh.getVertexPosition(hand * 8, new Vector3()).applyMatrix4(mesh.matrixWorld);
      skins.push(corner.distanceTo(skinAt(worn, 'leftHand')[0]!));
    });
    expect(skins).toEqual([0, 0]);
  });
});
