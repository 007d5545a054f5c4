import { readFileSync } from 'node:fs';
import { SkinnedMesh, Vector3 } from 'three';
import { type MutableHandShape, makeHandShape } from 'threepoint/core';
import { makePose, type Pose, type Side } from 'threepoint/math';
import { type Avatar, createAvatar } from '../../../src/threepoint/avatar/avatar';
import { ObjectHolds } from '../../../src/threepoint/avatar/hands/hold-object';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';

/** A person of 1.70 m. */
export const wearer = { eyeHeight: 1.59, armSpan: 1.39 };
const sides = ['left', 'right'] as const;
/** An edge of a triangle is looked at in so many steps: bodies with few triangles have fingers of few corners. */
const steps = 4;

type Wrists = Readonly<Record<Side, Pose<'floor'>>>;
/** Closes a hand round something. */
type Grasp = (holding: ObjectHolds, side: Side, wrist: Pose<'floor'>, target: MutableHandShape) => void;

/** Returns the file of a built-in body. */
export function builtInFile(body: string): ArrayBuffer {
  const file = readFileSync(new URL(`../../../public/avatars/${body}.vrm`, import.meta.url));
  return file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength) as ArrayBuffer;
}

/** Loads a built-in body for that person. */
export async function builtInBody(body: string): Promise<Avatar> {
  const avatar = createAvatar(await parseAvatar(builtInFile(body), `${body}.vrm`));
  avatar.setCalibration(wearer);
  return avatar;
}

/** Places of the drawn skin [m] by the bone that they move with most. */
export type DrawnSkin = ReadonlyMap<string, readonly Vector3[]>;

/** What a body shows now of the skin that moves with bones of these names. */
export function drawnSkin({ object }: Avatar, bones: RegExp): DrawnSkin {
  object.updateMatrixWorld(true);
  const found = new Map<string, Vector3[]>();
  object.traverse((mesh) => {
    if (mesh instanceof SkinnedMesh) collect(mesh, bones, found);
  });
  return found;
}

const ofHand = /Hand$|Thumb|Index|Middle|Ring|Little/;

/** The skin of both hands where they hold something. */
export function drawnHands(avatar: Avatar, wrists: Wrists, grasp: Grasp): DrawnSkin {
  const holding = new ObjectHolds();
  for (const side of sides) {
    const shape = makeHandShape();
    holding.fitTo(side, avatar.handGeometry(side), wearer.eyeHeight);
    grasp(holding, side, wrists[side], shape);
    avatar.setFingers(side, shape);
  }
  const tracked = (pose: Pose<'floor'>) => ({ ...pose, tracking: 'tracked' as const });
  const [leftHand, rightHand] = [tracked(wrists.left), tracked(wrists.right)];
  avatar.setPose({ head: tracked(makePose<'floor'>()), leftHand, rightHand, body: null }, 0);
  return drawnSkin(avatar, ofHand);
}

function collect(mesh: SkinnedMesh, wanted: RegExp, found: Map<string, Vector3[]>): void {
  const { skinIndex, skinWeight } = mesh.geometry.attributes;
  const index = mesh.geometry.index!;
  const boneOf = (corner: number): string => {
    let most = 0;
    for (let slot = 1; slot < 4; slot++)
      if (skinWeight!.getComponent(corner, slot) > skinWeight!.getComponent(corner, most)) most = slot;
    return mesh.skeleton.bones[skinIndex!.getComponent(corner, most)]!.name;
  };
  for (let first = 0; first < index.count; first += 3) {
    const corners = [0, 1, 2].map((at) => index.getX(first + at));
    const bones = corners.map(boneOf);
    if (!bones.every((bone) => wanted.test(bone))) continue;
    const places = corners.map((corner) =>
      mesh.getVertexPosition(corner, new Vector3()).applyMatrix4(mesh.matrixWorld),
    );
    for (let i = 0; i <= steps; i++) {
      for (let j = 0; i + j <= steps; j++) {
        const shares = [i, j, steps - i - j].map((share) => share / steps);
        const bone = bones[shares.indexOf(Math.max(...shares))]!;
        const at = new Vector3();
        for (const [corner, share] of shares.entries()) at.addScaledVector(places[corner]!, share);
        found.set(bone, [...(found.get(bone) ?? []), at]);
      }
    }
  }
}
