import { MeshoptSimplifier } from 'meshoptimizer/simplifier';
import { PerspectiveCamera, type SkinnedMesh, Triangle, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import type { Avatar } from '../../../src/threepoint/avatar/avatar';
import { skinnedMeshesOf } from '../../../src/threepoint/avatar/scene-meshes';
import { builtInBody } from './drawn-skin';
import { hold } from './worn-body';

/** What draws a mesh: a camera so far ahead of the body [m], or the light that casts shadows. */
type Viewer = number | 'light';

/** Returns the indices of a mesh that are drawn for a viewer; the renderer calls what is called here. */
function drawnIndices(mesh: SkinnedMesh, viewer: Viewer): ArrayLike<number> {
  const camera = new PerspectiveCamera();
  camera.position.set(0, 1, viewer === 'light' ? 1 : -viewer);
  camera.updateMatrixWorld();
  const unused = null as never;
  if (viewer === 'light') mesh.onBeforeShadow(unused, unused, camera, camera, mesh.geometry, unused, unused);
  else mesh.onBeforeRender(unused, unused, camera, mesh.geometry, unused, unused);
  const { start, count } = mesh.geometry.drawRange;
  return mesh.geometry.index!.array.slice(start, start + count);
}

const trianglesOf = ({ object }: Avatar, viewer: Viewer): number =>
  skinnedMeshesOf(object).reduce((sum, mesh) => sum + drawnIndices(mesh, viewer).length / 3, 0);

/** Returns how far the drawn vertices of a mesh are off the surface that a distant camera sees [m], in rising order. */
function distancesOf(mesh: SkinnedMesh): number[] {
  const place = (vertex: number) => mesh.getVertexPosition(vertex, new Vector3()).applyMatrix4(mesh.matrixWorld);
  const far = drawnIndices(mesh, 5);
  const triangles = Array.from(
    { length: far.length / 3 },
    (_, t) => new Triangle(...([0, 1, 2].map((corner) => place(far[3 * t + corner]!)) as [Vector3, Vector3, Vector3])),
  );
  // Every 11th of the vertices, in no order of places.
  const seen = [...new Set(Array.from(drawnIndices(mesh, 1)))].filter((vertex) => vertex % 11 === 0);
  const at = new Vector3();
  const distances = seen.map((vertex) => {
    const own = place(vertex);
    return Math.min(...triangles.map((triangle) => triangle.closestPointToPoint(own, at).distanceTo(own)));
  });
  return distances.sort((a, b) => a - b);
}

async function simplified(name: string): Promise<Avatar> {
  await MeshoptSimplifier.ready;
  const avatar = await builtInBody(name);
  await avatar.simplifyAtDistance(MeshoptSimplifier);
  hold(avatar, 11.5);
  avatar.object.updateMatrixWorld(true);
  return avatar;
}

describe.each(['mannequin', 'woman', 'man', 'stout', 'child'])('the %s', (name) => {
  test('has its triangles near by, and fewer than 8,000 at a distance and in shadows', async () => {
    const whole = await builtInBody(name);
    const all = skinnedMeshesOf(whole.object).reduce((sum, { geometry }) => sum + geometry.index!.count / 3, 0);
    const avatar = await simplified(name);
    expect(trianglesOf(avatar, 1)).toBe(all);
    expect(trianglesOf(avatar, 3.3)).toBe(all);
    expect(trianglesOf(avatar, 3.8)).toBeLessThan(8000);
    expect(trianglesOf(avatar, 'light')).toBe(trianglesOf(avatar, 3.8));
    // Its legs are left out at a distance, too.
    avatar.setUpperBodyOnly(true);
    expect(trianglesOf(avatar, 3.8)).toBeLessThan(trianglesOf(avatar, 1));
    const upper = trianglesOf(avatar, 3.8);
    avatar.setUpperBodyOnly(false);
    expect(trianglesOf(avatar, 3.8)).toBeGreaterThan(upper + 300);
  });

  test('keeps its surface within millimetres at a distance, with arms bent before the chest', async () => {
    const avatar = await simplified(name);
    const distances = skinnedMeshesOf(avatar.object)
      .flatMap(distancesOf)
      .sort((a, b) => a - b);
    expect(distances.length).toBeGreaterThan(400);
    expect(distances[Math.floor(0.99 * distances.length)]).toBeLessThan(0.006);
    expect(distances.at(-1)).toBeLessThan(0.013);
  });
});

test('a mesh with an outline is drawn at a distance by both of its materials', async () => {
  await MeshoptSimplifier.ready;
  const avatar = await builtInBody('woman');
  const [mesh] = skinnedMeshesOf(avatar.object);
  const { geometry } = mesh!;
  // Outlines of VRM's MToon are a second material over the whole mesh.
  for (const material of [0, 1]) geometry.addGroup(0, geometry.index!.count, material);
  await avatar.simplifyAtDistance(MeshoptSimplifier);
  const far = drawnIndices(mesh!, 5).length;
  expect(far).toBeGreaterThan(0);
  const { start, count } = geometry.drawRange;
  for (const group of geometry.groups)
    expect(Math.min(group.start + group.count, start + count) - Math.max(group.start, start)).toBe(far);
});
