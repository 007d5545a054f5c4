import { PerspectiveCamera, type Scene } from 'three';
import { defaultCalibration } from 'threepoint/core';
import { parseAvatar } from 'threepoint/files';
import { Mirror } from 'threepoint/internal/three';
import { createInferenceWorker } from 'threepoint/onnx';
import { createRenderer } from '../../src/page/scene/renderer';
import { createStudio } from '../../src/page/studio/studio';
import { createAvatar } from '../../src/threepoint/avatar/avatar';
import type { NetworkName } from '../../src/threepoint/core/estimation/estimators';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { loadRegressor } from '../../src/threepoint/onnx/load-regressor';

/** The studio in the page's canvas, as small as software rendering needs it. */
export function openStudio() {
  const canvas = document.querySelector('canvas');
  if (!canvas) throw new Error('no canvas');
  const renderer = createRenderer(canvas, 'low');
  renderer.setSize(480, 270, false);
  return { renderer, studio: createStudio(renderer, 'low'), camera: new PerspectiveCamera(42, 480 / 270, 0.05, 90) };
}

/** Loads an avatar of the page and adds it to a scene, with the default calibration; `file`: its bytes. */
export async function openAvatar(scene: Scene, name = 'mannequin') {
  const file = await (await fetch(`/avatars/${name}.vrm`)).arrayBuffer();
  const avatar = createAvatar(await parseAvatar(file, `${name}.vrm`));
  avatar.setCalibration(defaultCalibration);
  scene.add(avatar.object);
  return { avatar, file };
}

/** What is drawn in every frame, as on the page. */
export async function openPicture() {
  const { renderer, studio, camera } = openStudio();
  // The page's settings for software rendering.
  const mirror = new Mirror({ distance: 1.5, resolution: 256, samples: 0 });
  studio.scene.add(mirror.object);
  const { avatar, file: mannequin } = await openAvatar(studio.scene);
  camera.position.set(1.9, 1.5, 2.75);
  camera.lookAt(0, 1, -0.4);
  return { renderer, studio, mirror, avatar, camera, mannequin };
}

export const loadNetwork = (name: NetworkName): Promise<PoseRegressor> =>
  loadRegressor(`/models/${name}.json`, { createWorker: createInferenceWorker });

/**
 * Draw calls reach no device from now on: in software drawing would be most of a frame, and the page's thread would
 * wait for it.
 */
export function withoutDevice(gl: WebGLRenderingContext | WebGL2RenderingContext): void {
  for (const name of ['clear', 'drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced'])
    Object.assign(gl, { [name]: () => undefined });
}
