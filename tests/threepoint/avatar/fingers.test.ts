import { Group, type Object3D, SkinnedMesh, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import { type Avatar, createAvatar } from '../../../src/threepoint/avatar/avatar';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import {
  closedHand,
  type FingerName,
  fingerNames,
  flatHand,
  type HandShape,
  relaxedHand,
} from '../../../src/threepoint/core/body/hand-shape';
import { makePose, type Pose } from '../../../src/threepoint/core/math/pose';
import { fromAxisAngle, rotate } from '../../../src/threepoint/core/math/quat';
import type { Side } from '../../../src/threepoint/core/math/side';
import { addScaled, distance, normalise, type Vec3, vec3 } from '../../../src/threepoint/core/math/vec3';
import { TrackedSession } from '../../../src/threepoint/xr/tracked-session';
import { printFigures } from '../../print-figures';
import { fakeHeadset } from '../xr/fake-headset';
import { jointAt, type RecordedHand, recordedHands, trackedHand } from '../xr/recorded-hands';
import { changed, mannequin } from './glb';

const sides = ['left', 'right'] as const;

/** Somewhere, turned anyhow: fingers are bent against the wrist. */
const wrists: Readonly<Record<Side, Pose<'floor'>>> = {
  left: { position: vec3(-0.2, 1.2, -0.4), orientation: fromAxisAngle(normalise(vec3(0.3, 1, -0.5)), 2.1) },
  right: { position: vec3(0.3, 1.4, -0.1), orientation: fromAxisAngle(normalise(vec3(1, 0.2, 0.4)), -1.3) },
};

/** What the tracker says of both hands when a headset sees them so. */
function seen(hand: RecordedHand): Readonly<Record<Side, HandShape>> {
  const { session, drawing, frame, setInputs } = fakeHeadset();
  setInputs(trackedHand('left', wrists.left, hand), trackedHand('right', wrists.right, hand));
  const { fingers } = new TrackedSession({ session, drawing }).read(frame, 1)!;
  return { left: fingers!.left!, right: fingers!.right! };
}

/** The vertex of the skin furthest along a finger, and where it is drawn. */
function skinEnds(avatar: Avatar): (side: Side, finger: FingerName) => Vec3 {
  const meshes: SkinnedMesh[] = [];
  avatar.object.updateMatrixWorld(true);
  avatar.object.traverse((node) => {
    if (node instanceof SkinnedMesh) meshes.push(node);
  });
  const at = (mesh: SkinnedMesh, vertex: number): Vector3 =>
    mesh.getVertexPosition(vertex, new Vector3()).applyMatrix4(mesh.matrixWorld);
  const ends = new Map<string, { mesh: SkinnedMesh; vertex: number }>();
  for (const side of sides) {
    for (const finger of fingerNames) {
      const bone = `${side}${finger[0]!.toUpperCase()}${finger.slice(1)}Distal`;
      const joint = avatar.object.getObjectByName(bone) as Object3D;
      const from = joint.getWorldPosition(new Vector3());
      const along = from.clone().sub((joint.parent as Object3D).getWorldPosition(new Vector3()));
      let best = { mesh: meshes[0]!, vertex: -1, ahead: Number.NEGATIVE_INFINITY };
      for (const mesh of meshes) {
        const index = mesh.skeleton.bones.findIndex(({ name }) => name === bone);
        const { skinIndex, skinWeight, position } = mesh.geometry.attributes;
        for (let vertex = 0; vertex < position!.count; vertex++) {
          if (skinIndex!.getX(vertex) !== index || skinWeight!.getX(vertex) < 0.9) continue;
          const ahead = at(mesh, vertex).sub(from).dot(along);
          if (ahead > best.ahead) best = { mesh, vertex, ahead };
        }
      }
      ends.set(`${side} ${finger}`, best);
    }
  }
  return (side, finger) => {
    const { mesh, vertex } = ends.get(`${side} ${finger}`)!;
    return at(mesh, vertex);
  };
}

/** The mannequin, whose hands are 18.7 cm long at this eye height, as the recorded ones are. */
async function wearer(bytes = mannequin()) {
  const avatar = createAvatar(await parseAvatar(bytes, 'mannequin.vrm'));
  avatar.setCalibration({ eyeHeight: 1.59, armSpan: 1.39 });
  const body = { head: { ...makePose<'floor'>(), tracking: 'tracked' as const }, body: null };
  const hands = {
    leftHand: { ...wrists.left, tracking: 'tracked' as const },
    rightHand: { ...wrists.right, tracking: 'tracked' as const },
  };
  for (const side of sides) avatar.setFingers(side, flatHand);
  avatar.setPose({ ...body, ...hands }, 0);
  const end = skinEnds(avatar);
  return {
    avatar,
    end,
    show(shapes: Readonly<Record<Side, HandShape | null>>, time: number) {
      for (const side of sides) avatar.setFingers(side, shapes[side]);
      avatar.setPose({ ...body, ...hands }, time);
      avatar.object.updateMatrixWorld(true);
    },
  };
}

const jointPrefix = {
  thumb: 'thumb',
  index: 'index-finger',
  middle: 'middle-finger',
  ring: 'ring-finger',
  little: 'pinky-finger',
};

/** Returns the end of a tracked finger's skin. */
function trackedEnd(hand: RecordedHand, side: Side, finger: FingerName): Vec3 {
  const { position, orientation, radius } = jointAt(hand, `${jointPrefix[finger]}-tip`, side, wrists[side]);
  return addScaled(position, rotate(orientation, vec3(0, 0, -1)), radius);
}

describe('recorded hands on a rig of the wearer’s size', () => {
  test.each(Object.entries(recordedHands))(
    '%s: each fingertip lies within 1.5 cm of the tracked one',
    async (name, hand) => {
      const { end, show } = await wearer();
      show(seen(hand), 0.1);
      const errors = sides.flatMap((side) =>
        fingerNames.map((finger) => 100 * distance(end(side, finger), trackedEnd(hand, side, finger))),
      );
      printFigures(`fingertips of a hand ${name} [cm]`, { worst: Math.max(...errors).toFixed(2) });
      expect(Math.max(...errors)).toBeLessThanOrEqual(1.5);
    },
  );

  test.each([
    ['of a recorded hand', seen(recordedHands.pinched!)],
    ['whose fingers are reported apart', { left: { ...flatHand, pinch: 1 }, right: { ...flatHand, pinch: 1 } }],
  ])('a pinch %s closes: the tips of thumb and index finger are within 1 cm', async (_, shapes) => {
    const { end, show } = await wearer();
    show(shapes, 0.1);
    for (const side of sides) {
      const gap = 100 * distance(end(side, 'thumb'), end(side, 'index'));
      printFigures(`tips of a pinching ${side} hand [cm]`, { worst: gap.toFixed(2) });
      expect(gap).toBeLessThanOrEqual(1);
    }
  });

  test('a pointing hand points: the index finger is straight and the little one in the palm', async () => {
    const { end, show } = await wearer();
    show(seen(recordedHands.pointing!), 0.1);
    for (const side of sides) {
      expect(distance(end(side, 'index'), wrists[side].position)).toBeGreaterThan(0.17);
      expect(distance(end(side, 'little'), wrists[side].position)).toBeLessThan(0.09);
    }
  });
});

test('fingertips are reported where joints are, on the floor that the page moves its wearer on', async () => {
  const { avatar, show } = await wearer();
  show({ left: flatHand, right: closedHand }, 0.1);
  const there = avatar.fingertips('left').index!;
  expect(distance(there, avatar.jointPositions().leftHand!)).toBeLessThan(0.2);
  const floor = new Group();
  floor.position.set(10, 0, -3);
  floor.rotation.y = 2;
  floor.scale.setScalar(1.5);
  floor.add(avatar.object);
  expect(distance(avatar.fingertips('left').index!, there)).toBeLessThan(1e-6);
  floor.updateMatrixWorld(true);
  expect(distance(avatar.fingertips('left').index!, there)).toBeLessThan(1e-6);
});

describe('a rig', () => {
  test('without the bones beyond the knuckles bends there alone, and one without fingers stands', async () => {
    const bytes = changed((json) => {
      const bones = json.extensions.VRMC_vrm!.humanoid.humanBones;
      for (const name of Object.keys(bones)) {
        if (/(Intermediate|Distal)$/.test(name) || /^right(Index|Middle|Ring|Little|Thumb)/.test(name))
          delete bones[name];
      }
    });
    const { end, show } = await wearer(bytes);
    const before = { left: end('left', 'middle'), right: end('right', 'middle') };
    show({ left: closedHand, right: closedHand }, 0.1);
    expect(distance(end('left', 'middle'), before.left)).toBeGreaterThan(0.05);
    expect(distance(end('right', 'middle'), before.right)).toBeLessThan(1e-6);
  });

  test('bends fingers that are bent at rest to the same places', async () => {
    const turned = [0, 0, Math.sin(-0.3), Math.cos(-0.3)];
    const bytes = changed((json) => {
      for (const node of json.nodes) if (/^left(Index|Middle)Intermediate$/.test(node.name)) node.rotation = turned;
    });
    const [straight, bent] = [await wearer(), await wearer(bytes)];
    for (const { show } of [straight, bent]) show({ left: relaxedHand, right: relaxedHand }, 0.1);
    for (const finger of ['index', 'middle'] as const) {
      expect(distance(bent.end('left', finger), straight.end('left', finger))).toBeLessThan(0.004);
    }
  });
});

describe('a hand that is not seen', () => {
  test('keeps its fingers for half a second, then relaxes', async () => {
    const { end, show } = await wearer();
    const closed = { left: closedHand, right: closedHand };
    show(closed, 0.1);
    const held = end('left', 'middle');
    const lost = { left: null, right: closedHand };
    for (let time = 0.2; time < 0.55; time += 0.1) show(lost, time);
    expect(distance(end('left', 'middle'), held)).toBeLessThan(1e-6);
    for (let time = 0.6; time < 3; time += 0.1) show(lost, time);
    expect(distance(end('left', 'middle'), held)).toBeGreaterThan(0.06);
    expect(distance(end('right', 'middle'), wrists.right.position)).toBeLessThan(0.1);
  });
});
