import { SkinnedMesh, Vector3 } from 'three';
import type { Avatar } from '../../../src/threepoint/avatar/avatar';

/** Crossings of a cut through the skin at rest with its triangles' edges: which vertices, and how far between them. */
export interface Crossing {
  readonly mesh: SkinnedMesh;
  readonly a: number;
  readonly b: number;
  readonly t: number;
}

/** Returns where a vertex is drawn [m]. */
export const placeOf = (mesh: SkinnedMesh, vertex: number, target = new Vector3()): Vector3 =>
  mesh.getVertexPosition(vertex, target).applyMatrix4(mesh.matrixWorld);

/** The skin's lines of constant height above a plane at rest: `height` of a place [m]; null: it is no part of it. */
export function cut(avatar: Avatar, height: (place: Vector3) => number | null): Crossing[] {
  const found: Crossing[] = [];
  avatar.object.traverse((node) => {
    if (!(node instanceof SkinnedMesh)) return;
    const { index } = node.geometry;
    const heights = Array.from({ length: node.geometry.attributes.position!.count }, (_, v) =>
      height(placeOf(node, v)),
    );
    for (let corner = 0; corner < index!.count; corner++) {
      const next = corner % 3 === 2 ? corner - 2 : corner + 1;
      const [a, b] = [index!.getX(corner), index!.getX(next)];
      const [from, to] = [heights[a], heights[b]];
      if (from == null || to == null || from < 0 === to < 0) continue;
      found.push({ mesh: node, a, b, t: from / (from - to) });
    }
  });
  return found;
}

/** Least and mean distance of a cut's line from its middle, as drawn now [m]. */
export function radiiOf(crossings: readonly Crossing[]): { readonly least: number; readonly mean: number } {
  const points = crossings.map(({ mesh, a, b, t }) => placeOf(mesh, a).lerp(placeOf(mesh, b), t));
  const middle = points.reduce((sum, point) => sum.add(point), new Vector3()).divideScalar(points.length);
  const radii = points.map((point) => point.distanceTo(middle));
  return { least: Math.min(...radii), mean: radii.reduce((sum, radius) => sum + radius, 0) / radii.length };
}
