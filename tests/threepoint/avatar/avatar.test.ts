import { Matrix4, type Object3D, Quaternion, SkinnedMesh, Vector3 } from 'three';
import { beforeAll, describe, expect, test } from 'vitest';
import { type Avatar, createAvatar } from '../../../src/threepoint/avatar/avatar';
import { type LoadedAvatar, parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { type Calibration, defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../src/threepoint/core/body/forward-kinematics';
import { jointNames } from '../../../src/threepoint/core/body/joints';
import { skeletonFromCalibration } from '../../../src/threepoint/core/body/skeleton';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { angleBetween, fromAxisAngle, multiply, rotate } from '../../../src/threepoint/core/math/quat';
import { backward, distance, dot, length, subtract, up, type Vec3 } from '../../../src/threepoint/core/math/vec3';
import { actorFrame } from '../../../src/threepoint/core/tracking/actor-motion';
import type { TrackingFrame } from '../../../src/threepoint/core/tracking/tracking-frame';
import { poseOf } from '../core/estimation/drawn';
import { changed, mannequin, old } from './glb';

/** Long arms and short legs: proportions that no one has. It stands on the floor all the same. */
const monster = changed((json) => {
  let shortened = 0;
  for (const node of json.nodes) {
    if (/LowerArm$|Hand$/.test(node.name)) node.translation = node.translation?.map((v) => v * 1.6) ?? [];
    if (/LowerLeg$|Foot$/.test(node.name)) {
      shortened += node.name.startsWith('left') ? -0.4 * (node.translation?.[1] ?? 0) : 0;
      node.translation = node.translation?.map((v) => v * 0.6) ?? [];
    }
  }
  const hips = json.nodes.find(({ name }) => name === 'hips')?.translation;
  if (hips) hips[1] = (hips[1] ?? 0) - shortened;
});

/** Without the bones that VRM leaves optional. */
const plain = changed((json) => {
  const bones = json.extensions.VRMC_vrm?.humanoid.humanBones;
  for (const name of ['upperChest', 'chest', 'neck', 'leftShoulder', 'rightShoulder']) delete bones?.[name];
});

const avatars: readonly (readonly [string, () => ArrayBuffer])[] = [
  ['our mannequin', mannequin],
  ['a monster with long arms', () => monster],
  ['a rig without optional bones', () => plain],
  ['a VRM 0.x', () => old],
];

const bodies: readonly Calibration[] = [
  defaultCalibration,
  { eyeHeight: 1.05, armSpan: 0.95 },
  { eyeHeight: 2.05, armSpan: 2.0 },
];

/** The bone itself, as three would skin with it. */
function worldOf(
  loaded: LoadedAvatar,
  avatar: Avatar,
  name: string,
): { readonly position: Vec3; readonly rotation: Quaternion } {
  avatar.object.updateMatrixWorld(true);
  const node = loaded.vrm.humanoid.getRawBoneNode(name as never) as Object3D;
  const position = new Vector3();
  node.matrixWorld.decompose(position, new Quaternion(), new Vector3());
  return {
    position,
    rotation: new Quaternion().setFromRotationMatrix(new Matrix4().extractRotation(node.matrixWorld)),
  };
}

/** How many corners of each mesh of skin are drawn now. */
function drawnSkin(avatar: Avatar): ReadonlyMap<SkinnedMesh, number> {
  const drawn = new Map<SkinnedMesh, number>();
  avatar.object.traverse((mesh) => {
    if (!(mesh instanceof SkinnedMesh) || !mesh.visible) return;
    drawn.set(mesh, Math.min(mesh.geometry.drawRange.count, mesh.geometry.index!.count));
  });
  return drawn;
}

/** The longest edge [m] of so many corners of each mesh, three a triangle, as posed now. */
function longestEdge(avatar: Avatar, skin: ReadonlyMap<SkinnedMesh, number>): number {
  let longest = 0;
  const [from, to] = [new Vector3(), new Vector3()];
  avatar.object.updateMatrixWorld(true);
  for (const [mesh, corners] of skin) {
    const place = (corner: number, target: Vector3): Vector3 =>
      mesh.getVertexPosition(mesh.geometry.index!.getX(corner), target).applyMatrix4(mesh.matrixWorld);
    for (let corner = 0; corner < corners; corner++) {
      const next = corner % 3 === 2 ? corner - 2 : corner + 1;
      longest = Math.max(longest, place(corner, from).distanceTo(place(next, to)));
    }
  }
  return longest;
}

/** Plays some seconds of the actor and calls `look` after each frame. */
async function play(
  avatar: Avatar,
  body: Calibration,
  look: (frame: TrackingFrame) => void,
  seconds = 37,
  rateHz = 6,
): Promise<void> {
  const ik = createIk(body);
  for (let i = 0; i < seconds * rateHz; i++) {
    const frame = actorFrame(i / rateHz, body);
    avatar.setPose(poseOf(ik, frame), frame.time);
    look(frame);
  }
}

describe.each(avatars)('%s', (_, file) => {
  let loaded: LoadedAvatar;
  let avatar: Avatar;
  beforeAll(async () => {
    loaded = await parseAvatar(file(), 'test.vrm');
    avatar = createAvatar(loaded);
  });

  test.each(bodies)('its wrists lie on the tracked ones within 1 mm for eyes at $eyeHeight m', async (body) => {
    avatar.setCalibration(body);
    let hands = 0;
    await play(avatar, body, ({ leftHand, rightHand }) => {
      for (const [name, hand] of [
        ['leftHand', leftHand],
        ['rightHand', rightHand],
      ] as const) {
        if (!hand) continue;
        hands += 1;
        expect(distance(worldOf(loaded, avatar, name).position, hand.position)).toBeLessThan(1e-3);
      }
    });
    expect(hands).toBeGreaterThan(10);
  });

  test('its joints are those of the pose, and left is left', () => {
    avatar.setCalibration(defaultCalibration);
    const skeleton = skeletonFromCalibration(defaultCalibration);
    const frame = actorFrame(11.5, defaultCalibration);
    const { body } = poseOf(createIk(defaultCalibration), frame);
    if (!body) throw new Error('IK draws a body');
    avatar.setPose(poseOf(createIk(defaultCalibration), frame), 0);
    const joints = forwardKinematics(skeleton, body);
    for (const name of jointNames) {
      if (!loaded.vrm.humanoid.getRawBoneNode(name)) continue;
      // Between pelvis, head and elbows a rig keeps its own trunk.
      const near = /^(hips|head|.*LowerArm|.*Hand)$/.test(name) ? 1e-4 : 0.08;
      expect(distance(worldOf(loaded, avatar, name).position, joints[name].position), name).toBeLessThan(near);
    }
  });

  test.each([
    ['both hands', {}],
    ['one hand', { leftHand: null }],
  ])('drawn as head and %s, no skin reaches from one to another', (_, lost) => {
    avatar.setCalibration(defaultCalibration);
    const frame = { ...actorFrame(11.5, defaultCalibration), ...lost };
    const pose = poseOf(createIk(defaultCalibration), frame);
    avatar.setPose({ ...pose, body: null }, 0);
    const drawn = drawnSkin(avatar);
    const longest = longestEdge(avatar, drawn);
    avatar.setPose(pose, 0.1);
    expect(longest).toBeGreaterThan(0.005);
    expect(longest, 'against the same skin on a whole body').toBeLessThan(1.3 * longestEdge(avatar, drawn));
  });

  test('its feet stay on the floor and nothing is NaN', async () => {
    avatar.setCalibration(defaultCalibration);
    await play(avatar, defaultCalibration, () => {
      const joints = Object.entries(avatar.jointPositions());
      expect(joints.length).toBeGreaterThan(9);
      for (const [name, { x, y, z }] of joints) {
        expect(Number.isFinite(x + y + z), name).toBe(true);
        if (name.endsWith('Foot')) expect(y).toBeLessThan(0.35);
      }
    });
  });
});

describe('our mannequin', () => {
  test('turns its hands as the tracked ones are turned', async () => {
    const loaded = await parseAvatar(mannequin(), 'mannequin.vrm');
    const avatar = createAvatar(loaded);
    avatar.setCalibration(defaultCalibration);
    const frame = actorFrame(5.2, defaultCalibration);
    avatar.setPose(poseOf(createIk(defaultCalibration), frame), 0);
    for (const [name, sign] of [
      ['leftHand', 1],
      ['rightHand', -1],
    ] as const) {
      const expected = multiply(
        frame[name]?.orientation ?? fromAxisAngle(up, 0),
        fromAxisAngle(up, (-sign * Math.PI) / 2),
      );
      const { x, y, z, w } = worldOf(loaded, avatar, name).rotation;
      // The bone's own rest faces the other way.
      expect(angleBetween(multiply({ x, y, z, w }, fromAxisAngle(up, Math.PI)), expected)).toBeLessThan(0.02);
    }
  });

  test('fitted twice it is where it was fitted once', async () => {
    const loaded = await parseAvatar(mannequin(), 'mannequin.vrm');
    const avatar = createAvatar(loaded);
    const frame = actorFrame(3, defaultCalibration);
    const bodyAfter = (fits: readonly Calibration[]) => {
      for (const fit of fits) avatar.setCalibration(fit);
      avatar.setPose(poseOf(createIk(defaultCalibration), frame), 0);
      return worldOf(loaded, avatar, 'leftFoot').position;
    };
    const once = { ...bodyAfter([defaultCalibration]) };
    const again = bodyAfter([{ eyeHeight: 2, armSpan: 1.9 }, defaultCalibration, defaultCalibration]);
    expect(distance(once, again)).toBeLessThan(1e-6);
  });

  test('shown as head and hands ends at its wrists, not in shreds of sleeves', async () => {
    const avatar = createAvatar(await parseAvatar(mannequin(), 'mannequin.vrm'));
    avatar.setCalibration(defaultCalibration);
    const frame = actorFrame(1, defaultCalibration);
    avatar.setPose({ ...frame, body: null }, 0);
    avatar.object.updateMatrixWorld(true);
    const at = new Vector3();
    let furthest = 0;
    for (const [mesh, corners] of drawnSkin(avatar)) {
      for (let corner = 0; corner < corners; corner++) {
        mesh.getVertexPosition(mesh.geometry.index!.getX(corner), at).applyMatrix4(mesh.matrixWorld);
        for (const { position, orientation } of [frame.leftHand!, frame.rightHand!]) {
          const from = subtract(at, position);
          if (length(from) < 0.15) furthest = Math.max(furthest, dot(from, rotate(orientation, backward)));
        }
      }
    }
    expect(furthest).toBeGreaterThan(0);
    expect(furthest, 'behind a wrist [m]').toBeLessThan(0.025);
  });

  test('shows its upper body, or head and hands, alone', async () => {
    const loaded = await parseAvatar(mannequin(), 'mannequin.vrm');
    const avatar = createAvatar(loaded);
    const triangles = () => {
      let count = 0;
      loaded.vrm.scene.traverse((node) => {
        if (node instanceof SkinnedMesh && node.visible)
          count += Math.min(node.geometry.drawRange.count, node.geometry.index?.count ?? 0) / 3;
      });
      return count;
    };
    const frame = actorFrame(1, defaultCalibration);
    avatar.setPose(poseOf(createIk(defaultCalibration), frame), 0);
    const whole = triangles();
    avatar.setUpperBodyOnly(true);
    const upper = triangles();
    avatar.setPose({ ...frame, body: null }, 0.1);
    const handsAndHead = triangles();
    expect(handsAndHead).toBeGreaterThan(1000);
    expect(upper).toBeGreaterThan(handsAndHead);
    expect(whole).toBeGreaterThan(upper);
  });
});

describe('files that are no avatar', () => {
  test('get a sentence', async () => {
    await expect(parseAvatar(new TextEncoder().encode('hello').buffer, 'notes.txt')).rejects.toThrow(
      /^notes\.txt: not a VRM or GLB file/,
    );
    const dog = changed((json) => {
      json.extensions = {};
      json.extensionsUsed = [];
      // All joints beside each other: neither names nor structure show a humanoid.
      json.scenes = [{ nodes: json.nodes.map((_, index) => index) }];
      for (const [index, node] of json.nodes.entries()) {
        node.name = `paw ${index}`;
        delete node.children;
      }
    });
    await expect(parseAvatar(dog, 'dog.glb')).rejects.toThrow(
      /^dog\.glb: its bones could not be matched to a humanoid/,
    );
  });
});
