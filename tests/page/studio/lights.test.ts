import { type BufferAttribute, Mesh, Scene, type WebGLRenderer } from 'three';
import { vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { Lights } from '../../../src/page/studio/lights';

test('the shadow on the floor goes with the body when head and hands alone are drawn', () => {
  const scene = new Scene();
  // At low quality no light draws anything by itself.
  const lights = new Lights(scene, {} as WebGLRenderer, 'low');
  const shadow = scene.children.find((child) => child instanceof Mesh);
  if (!shadow) throw new Error('the scene has no shadow on its floor');
  const colors = shadow.geometry.getAttribute('color') as BufferAttribute;
  const darkest = () => Math.max(...Array.from({ length: colors.count }, (_, vertex) => colors.getW(vertex)));
  lights.follow({ hips: vec3(0, 1, 0), leftFoot: vec3(0, 0.09, 0) }, 0);
  expect(darkest()).toBeGreaterThan(0.5);
  lights.follow({}, 0);
  expect(darkest()).toBe(0);
});
