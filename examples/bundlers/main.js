import { Color, GridHelper, HemisphereLight, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { VRButton } from 'three/addons/webxr/VRButton.js';
import { BodyTracker, loadMannequin } from 'threepoint/three';

const renderer = new WebGLRenderer({ antialias: true });
renderer.setSize(innerWidth, innerHeight);
renderer.xr.enabled = true;
document.body.append(renderer.domElement, VRButton.createButton(renderer));

const scene = new Scene().add(new HemisphereLight(0xffffff, 0x666666, 3), new GridHelper(10, 10));
scene.background = new Color(0xccddee);
const camera = new PerspectiveCamera(60, innerWidth / innerHeight, 0.05, 50);
camera.position.set(0, 1.6, 2);

const body = new BodyTracker(renderer, { avatar: await loadMannequin() });
scene.add(body.object);

renderer.setAnimationLoop((timeMs, frame) => {
  body.update(timeMs, frame);
  renderer.render(scene, camera);
});
window.selfAvatar = body;
