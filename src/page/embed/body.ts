import { DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { actorFrame, defaultCalibration } from 'threepoint/core';
import { BodyTracker, loadAvatar } from 'threepoint/three';

const canvas = document.querySelector('canvas') as HTMLCanvasElement;
const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
renderer.setSize(900, 1200, false);
const camera = new PerspectiveCamera(32, 3 / 4);
camera.position.set(1, 1.4, -3.2);
camera.lookAt(0, 0.86, 0);

const scene = new Scene();
scene.add(new HemisphereLight('white', 'tan', 2), new DirectionalLight('white', 2));
const avatar = await loadAvatar('avatars/woman.vrm');
const body = new BodyTracker(renderer, { avatar });
scene.add(body.object);

const isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;
renderer.setAnimationLoop((timeMs) => {
  // An actor's head and hands. In a WebXR session: body.update(timeMs, frame).
  body.updateFromFrame(actorFrame(isStill ? 0 : timeMs / 1000, defaultCalibration));
  renderer.render(scene, camera);
});
