import { BufferAttribute, type Object3D, type SkinnedMesh, Vector3 } from 'three';
import type { Steps } from '../between-frames';

/** The parts of a skin, in the order of their triangles: a prefix of the parts can be drawn alone. */
export const skinParts = ['hands', 'head', 'trunk', 'legs'] as const;
export type SkinPart = (typeof skinParts)[number];

/** The number of indices that one step sorts. */
const cornersAStep = 3 * 1024;

/**
 * Sorts a skinned mesh's triangles by part and returns the index count up to each part. The skin around the hips is
 * divided at the height `hipLine` [m] of the rest pose, so that the border of trunk and legs is a line.
 */
export function* sortByPart(
  mesh: SkinnedMesh,
  partOfBone: (bone: Object3D) => SkinPart | 'hips',
  hipLine: number,
): Steps<Record<SkinPart, number>> {
  const { geometry, skeleton } = mesh;
  const joints = geometry.getAttribute('skinIndex');
  const weights = geometry.getAttribute('skinWeight');
  const source = geometry.index ?? sequence(geometry.getAttribute('position').count);
  const hips = skinParts.length;
  const parts = skeleton.bones.map((bone) => {
    const part = partOfBone(bone);
    return part === 'hips' ? hips : skinParts.indexOf(part);
  });
  const place = new Vector3();
  const height = (vertex: number): number => mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld).y;
  const vertexPart = (vertex: number): number => {
    const sums = [0, 0, 0, 0, 0];
    for (let slot = 0; slot < 4; slot++) {
      const part = parts[joints.getComponent(vertex, slot)] ?? 2;
      sums[part] = (sums[part] ?? 0) + weights.getComponent(vertex, slot);
    }
    return sums.indexOf(Math.max(...sums));
  };
  const trunk = skinParts.indexOf('trunk');
  const legs = skinParts.indexOf('legs');
  const known = new Map<number, number>();
  const partOf = (vertex: number): number => {
    let part = known.get(vertex);
    if (part === undefined) {
      part = vertexPart(vertex);
      known.set(vertex, part);
    }
    return part;
  };
  const sorted: number[][] = skinParts.map(() => []);
  for (let i = 0; i < source.count; i += 3) {
    if (i % cornersAStep === 0) yield;
    const triangle = [source.getX(i), source.getX(i + 1), source.getX(i + 2)];
    const [a = 2, b = 2, c = 2] = triangle.map(partOf);
    // The part of two of the three vertices; for three different parts the middle one, so that borders are on the
    // trunk's side.
    let part = a === b || a === c ? a : b === c ? b : 2;
    if (part === hips || part === legs) {
      part = triangle.reduce((sum, vertex) => sum + height(vertex), 0) / 3 < hipLine ? legs : trunk;
    }
    sorted[part]?.push(...triangle);
  }
  const indices = sorted.flat();
  const wide = geometry.getAttribute('position').count > 65535;
  geometry.setIndex(new BufferAttribute(wide ? new Uint32Array(indices) : new Uint16Array(indices), 1));
  let end = 0;
  return Object.fromEntries(
    skinParts.map((part, index) => {
      end += sorted[index]?.length ?? 0;
      return [part, end];
    }),
  ) as Record<SkinPart, number>;
}

function sequence(count: number): { readonly count: number; getX(index: number): number } {
  return { count, getX: (index) => index };
}
