import {
  Box3,
  BoxGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type Object3D,
} from 'three';
import { describe, expect, test } from 'vitest';
import { mergeMeshes } from '../../../src/page/scene/merge-meshes';
import { painted } from '../../../src/page/scene/painted-geometry';

const lambert = () => new MeshLambertMaterial({ vertexColors: true });
const box = (x: number, material = lambert()) => {
  const mesh = new Mesh(painted(new BoxGeometry(1, 1, 1), '#808080'), material);
  mesh.position.x = x;
  return mesh;
};
const meshesBelow = (object: Object3D): Mesh[] => {
  const found: Mesh[] = [];
  object.traverse((node) => {
    if (node instanceof Mesh) found.push(node);
  });
  return found;
};

describe('scenery that looks alike', () => {
  test('is one mesh where it was, however deep it lay and wherever the whole stands', () => {
    const scenery = new Group();
    scenery.position.set(3, 0, -2);
    scenery.rotation.y = 1;
    const deep = new Group();
    deep.position.y = 5;
    deep.scale.setScalar(2);
    deep.add(box(10));
    scenery.add(box(-4), deep);
    const before = new Box3().setFromObject(scenery, true);
    mergeMeshes(scenery);
    const [whole, ...others] = meshesBelow(scenery);
    expect(others).toEqual([]);
    expect(whole?.geometry.getAttribute('position').count).toBe(2 * 36);
    const after = new Box3().setFromObject(scenery, true);
    expect(after.min.distanceTo(before.min)).toBeLessThan(1e-6);
    expect(after.max.distanceTo(before.max)).toBeLessThan(1e-6);
  });

  test('keeps apart meshes with shadows, two sides, a picture or own material, and hidden ones', () => {
    const scenery = new Group();
    const casting = box(1);
    casting.castShadow = true;
    const hidden = box(2);
    hidden.visible = false;
    const others = [
      casting,
      hidden,
      box(3, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide })),
      new Mesh(new BoxGeometry(), new MeshBasicMaterial()),
      new Mesh(new BoxGeometry(), new MeshLambertMaterial()),
    ];
    scenery.add(box(0), ...others);
    mergeMeshes(scenery);
    expect(meshesBelow(scenery)).toHaveLength(6);
    for (const mesh of others) expect(mesh.parent).toBe(scenery);
  });
});
