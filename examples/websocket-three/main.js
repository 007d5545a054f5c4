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

const socket = new WebSocket(location.href.replace(/^http/, 'ws'));
socket.binaryType = 'arraybuffer';
// The server's number of the sender is in front of the packet; a number alone: that person has left.
socket.addEventListener('message', ({ data }) => {
  const peer = String(new DataView(data).getUint32(0));
  if (data.byteLength > 4) others.receive(performance.now(), peer, data.slice(4));
  else others.remove(peer);
});
const sender = new PoseSender((bytes) => socket.readyState === WebSocket.OPEN && socket.send(bytes), { name });

renderer.setAnimationLoop((timeMs, frame) => {
  body.update(timeMs, frame);
  sender.update(timeMs, body);
  others.update(timeMs);
  renderer.render(scene, camera);
});
window.selfAvatar = body;
window.others = others.object;
