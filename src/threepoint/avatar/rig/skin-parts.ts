import { BufferAttribute, type Object3D, type SkinnedMesh, Vector3 } from 'three';
import { recordOf } from '../../core/records';
import type { Steps } from '../between-frames';

/** The parts of a skin, in the order of their triangles: a prefix of the parts can be drawn alone. */
export const skinParts = ['hands', 'head', 'trunk', 'legs'] as const;
export type SkinPart = (typeof skinParts)[number];
/** The index count of a mesh up to and including each part. */
export type PartEnds = Readonly<Record<SkinPart, number>>;

/** The number of triangles that one step sorts. */
const trianglesAStep = 1024;

/**
 * Sorts a skinned mesh's triangles by part and returns the index count up to each part. The skin around the hips is
 * divided at the height `hipLine` [m] of the rest pose, so that the border of trunk and legs is a line.
 */
export function* sortByPart(
  mesh: SkinnedMesh,
  partOfBone: (bone: Object3D) => SkinPart | 'hips',
  hipLine: number,
): Steps<PartEnds> {
  const { geometry, skeleton } = mesh;
  const joints = geometry.getAttribute('skinIndex');
  const weights = geometry.getAttribute('skinWeight');
  const { count } = geometry.getAttribute('position');
  const corners = geometry.index?.array ?? Uint32Array.from({ length: count }, (_, index) => index);
  const hips = skinParts.length;
  const parts = skeleton.bones.map((bone) => {
    const part = partOfBone(bone);
    return part === 'hips' ? hips : skinParts.indexOf(part);
  });
  const place = new Vector3();
  const heights = new Float64Array(count).fill(Number.NaN);
  const height = (vertex: number): number => {
    if (Number.isNaN(heights[vertex]))
      heights[vertex] = mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld).y;
    return heights[vertex]!;
  };
  const sums = new Float64Array(hips + 1);
  const vertexPart = (vertex: number): number => {
    sums.fill(0);
    for (let slot = 0; slot < 4; slot++) {
      const part = parts[joints.getComponent(vertex, slot)] ?? 2;
      sums[part] = sums[part]! + weights.getComponent(vertex, slot);
    }
    let best = 0;
    for (let part = 1; part < sums.length; part++) if (sums[part]! > sums[best]!) best = part;
    return best;
  };
  const trunk = skinParts.indexOf('trunk');
  const legs = skinParts.indexOf('legs');
  const partOfVertex = new Int8Array(count).fill(-1);
  const partOf = (vertex: number): number => {
    if (partOfVertex[vertex] === -1) partOfVertex[vertex] = vertexPart(vertex);
    return partOfVertex[vertex]!;
  };
  const partOfTriangle = new Uint8Array(corners.length / 3);
  for (let triangle = 0; triangle < partOfTriangle.length; triangle++) {
    if (triangle % trianglesAStep === 0) yield;
    const [first, second, third] = [corners[3 * triangle]!, corners[3 * triangle + 1]!, corners[3 * triangle + 2]!];
    const [a, b, c] = [partOf(first), partOf(second), partOf(third)];
    // The part of two of the three vertices; for three different parts the middle one, so that borders are on the
    // trunk's side.
    let part = a === b || a === c ? a : b === c ? b : 2;
    if (part === hips || part === legs) {
      part = (height(first) + height(second) + height(third)) / 3 < hipLine ? legs : trunk;
    }
    partOfTriangle[triangle] = part;
  }
  const sorted = count > 65535 ? new Uint32Array(corners.length) : new Uint16Array(corners.length);
  let end = 0;
  const ends = recordOf(skinParts, (_, part) => {
    for (let triangle = 0; triangle < partOfTriangle.length; triangle++) {
      if (partOfTriangle[triangle] !== part) continue;
      for (let corner = 3 * triangle; corner < 3 * triangle + 3; corner++) sorted[end++] = corners[corner]!;
    }
    return end;
  });
  geometry.setIndex(new BufferAttribute(sorted, 1));
  return ends;
}
