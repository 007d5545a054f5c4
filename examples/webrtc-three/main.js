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

const [mine, theirs] = ['mine', 'theirs'].map((id) => document.getElementById(id));
const channels = new Set();
const send = (bytes) => {
  for (const channel of channels) if (channel.readyState === 'open') channel.send(bytes);
};
const sender = new PoseSender(send, { name });

/** Opens a connection: to the person of this offer, or to the one who will answer this page's. */
async function connect(offer) {
  const id = crypto.randomUUID();
  const peer = new RTCPeerConnection();
  addEventListener('pagehide', () => peer.close());
  const channel = peer.createDataChannel('bodies', { negotiated: true, id: 0, ordered: false, maxRetransmits: 0 });
  channel.binaryType = 'arraybuffer';
  channel.onmessage = ({ data }) => others.receive(performance.now(), id, data);
  channel.onopen = () => {
    channels.add(channel);
    invited = connect();
  };
  channel.onclose = () => {
    channels.delete(channel);
    others.remove(id);
  };
  peer.onicecandidate = ({ candidate }) => {
    if (!candidate) mine.value = JSON.stringify(peer.localDescription);
  };
  if (offer) await peer.setRemoteDescription(offer);
  await peer.setLocalDescription();
  return peer;
}

let invited = connect();
theirs.oninput = async () => {
  const description = JSON.parse(theirs.value);
  if (description.type === 'offer') connect(description);
  else (await invited).setRemoteDescription(description);
};

renderer.setAnimationLoop((timeMs, frame) => {
  body.update(timeMs, frame);
  sender.update(timeMs, body);
  others.update(timeMs);
  renderer.render(scene, camera);
});
window.selfAvatar = body;
window.others = others.object;
