import { PerspectiveCamera } from 'three';
import { Mirror } from 'threepoint/internal/three';
import { identity, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { createVignette } from '../../../src/page/scene/vignette';

test('the edges darken at a turn and clear within half a second, centred on the eyes', () => {
  const vignette = createVignette();
  const eyes = { position: vec3(1, 1.6, 2), orientation: identity };
  vignette.show(0, eyes);
  expect(vignette.object.visible).toBe(false);
  vignette.close(10);
  vignette.show(10, eyes);
  expect(vignette.darkness).toBe(1);
  expect(vignette.object.visible).toBe(true);
  expect(vignette.object.position.x).toBe(1);
  vignette.show(10.2, eyes);
  expect(vignette.darkness).toBeGreaterThan(0.2);
  vignette.show(10.2, null);
  expect(vignette.object.visible).toBe(false);
  vignette.show(10.5, eyes);
  expect(vignette.darkness).toBe(0);
});

test('the dark edges lie before the eyes alone, and no mirror shows them as a ball', () => {
  const { object } = createVignette();
  const glass = new Mirror().object.children.find((child) => 'getReflectionCamera' in child) as unknown as {
    getReflectionCamera(eye: PerspectiveCamera): PerspectiveCamera;
  };
  for (const layer of [1, 2]) {
    // The eye's camera sees layer 0 and its own layer, as in WebXRManager.
    const eye = new PerspectiveCamera();
    eye.layers.enable(layer);
    expect(object.layers.test(eye.layers)).toBe(true);
    const reflecting = glass.getReflectionCamera(eye);
    expect(object.layers.test(reflecting.layers)).toBe(false);
    expect(reflecting.layers.isEnabled(0)).toBe(true);
  }
  expect(object.layers.test(new PerspectiveCamera().layers)).toBe(false);
});
