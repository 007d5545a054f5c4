import { Client } from '@colyseus/sdk';
import { Color, GridHelper, HemisphereLight, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { VRButton } from 'three/addons/webxr/VRButton.js';
import { BodyTracker, loadMannequin } from 'threepoint/three';
import { PoseSender } from 'threepoint-rooms';
import { RemoteBodies } from 'threepoint-rooms/three';

const renderer = new WebGLRenderer({ antialias: true });
renderer.setSize(innerWidth, innerHeight);
renderer.xr.enabled = true;
document.body.append(renderer.domElement, VRButton.createButton(renderer));

const scene = new Scene().add(new HemisphereLight(0xffffff, 0x666666, 3), new GridHelper(10, 10));
scene.background = new Color(0xccddee);
const camera = new PerspectiveCamera(60, innerWidth / innerHeight, 0.05, 50);
camera.position.set(0, 1.6, 2);

const name = new URLSearchParams(location.search).get('name') ?? 'Guest';
const body = new BodyTracker(renderer, { avatar: await loadMannequin() });
const others = new RemoteBodies();
scene.add(body.object, others.object);

const room = await new Client(location.origin).joinOrCreate('bodies');
room.onMessage('body', ([sender, bytes]) => others.receive(performance.now(), sender, bytes));
room.onMessage('left', (sender) => others.remove(sender));
const sender = new PoseSender((bytes) => room.sendBytes('body', bytes), { name });

renderer.setAnimationLoop((timeMs, frame) => {
  body.update(timeMs, frame);
  sender.update(timeMs, body);
  others.update(timeMs);
  renderer.render(scene, camera);
});
window.selfAvatar = body;
window.others = others.object;
