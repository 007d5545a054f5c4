import { type SkinnedMesh, Vector3 } from 'three';
import type { Mutable } from '../../core/records';
import type { Steps } from '../between-frames';
import { type PartEnds, skinParts } from './skin-parts';

/** Reduces triangles: the `MeshoptSimplifier` of meshoptimizer, once it is ready. */
export interface MeshSimplifier {
  simplifyWithAttributes(
    indices: Uint32Array,
    positions: Float32Array,
    positionStride: number,
    attributes: Float32Array,
    attributeStride: number,
    attributeWeights: number[],
    vertexLock: Uint8Array | null,
    targetIndexCount: number,
    targetError: number,
    flags: ('LockBorder' | 'ErrorAbsolute')[],
  ): [indices: Uint32Array, error: number];
}

/**
 * How far the surface may be off with fewer triangles [m]: less than a pixel of a headset at 3.5 m. Borders of colours
 * may be off as far, and the outline of an eye is small.
 */
const largestErrors = { hands: 0.002, head: 0.0007, trunk: 0.002, legs: 0.002 } satisfies PartEnds;
/**
 * The weight of an error of the joints' place, relative to an error of the position. Limbs are straight at rest, and
 * need edges across them where they bend.
 */
const jointWeight = 2;
/** The number of vertices that one step reads. */
const verticesAStep = 512;

/** Returns the place of each vertex [m] and the mean place of the joints that carry it, one array each. */
function* readPlaces(mesh: SkinnedMesh): Steps<readonly [own: Float32Array, ofJoints: Float32Array]> {
  const { geometry, skeleton } = mesh;
  const { count } = geometry.getAttribute('position');
  const joints = geometry.getAttribute('skinIndex');
  const weights = geometry.getAttribute('skinWeight');
  const bones = skeleton.bones.map(({ matrixWorld }) => new Vector3().setFromMatrixPosition(matrixWorld));
  const own = new Float32Array(3 * count);
  const ofJoints = new Float32Array(3 * count);
  const place = new Vector3();
  for (let vertex = 0; vertex < count; vertex++) {
    if (vertex % verticesAStep === 0) yield;
    mesh
      .getVertexPosition(vertex, place)
      .applyMatrix4(mesh.matrixWorld)
      .toArray(own, 3 * vertex);
    place.set(0, 0, 0);
    for (let slot = 0; slot < 4; slot++) {
      const bone = bones[joints.getComponent(vertex, slot)];
      if (bone) place.addScaledVector(bone, weights.getComponent(vertex, slot));
    }
    place.toArray(ofJoints, 3 * vertex);
  }
  return [own, ofJoints];
}

/**
 * Appends fewer triangles of the same vertices to the triangles of a mesh at rest, which end at `ends`, and returns
 * where the appended ones end. The borders of parts stay as they are.
 */
export function* appendDistantTriangles(
  mesh: SkinnedMesh,
  ends: PartEnds,
  simplifier: MeshSimplifier,
): Steps<PartEnds> {
  const [own, ofJoints] = yield* readPlaces(mesh);
  const indices = Array.from(mesh.geometry.index!.array).slice(0, ends.legs);
  const distantEnds = { ...ends } as Mutable<PartEnds>;
  let start = 0;
  for (const part of skinParts) {
    yield;
    const near = Uint32Array.from(indices.slice(start, ends[part]));
    const weights = [jointWeight, jointWeight, jointWeight];
    const [distant] = simplifier.simplifyWithAttributes(
      near, own, 3, ofJoints, 3, weights, null, 0, largestErrors[part], ['LockBorder', 'ErrorAbsolute'],
    ); // biome-ignore format: the parameters of another library
    for (const index of distant) indices.push(index);
    start = ends[part];
    distantEnds[part] = indices.length;
  }
  mesh.geometry.setIndex(indices);
  // The outline of a toon material is a second group over all indices.
  for (const group of mesh.geometry.groups) group.count = indices.length;
  return distantEnds;
}
