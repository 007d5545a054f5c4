import AFRAME from 'aframe';
import 'networked-aframe/dist/networked-aframe.min.js';
import { BodyTracker, loadMannequin } from 'threepoint/three';
import { PoseSender } from 'threepoint-rooms';
import { RemoteBodies } from 'threepoint-rooms/three';

const { NAF } = window;

AFRAME.registerComponent('bodies', {
  async init() {
    const avatar = await loadMannequin();
    const name = new URLSearchParams(location.search).get('name') ?? 'Guest';
    this.body = new BodyTracker(this.el.sceneEl.renderer, { avatar });
    this.others = new RemoteBodies();
    this.el.object3D.add(this.body.object, this.others.object);
    // The name of the sender is the server's: the adapter passes it on.
    NAF.connection.subscribeToDataChannel('body', (sender, _type, bytes) =>
      this.others.receive(performance.now(), sender, bytes),
    );
    document.body.addEventListener('clientDisconnected', ({ detail }) => this.others.remove(detail.clientId));
    const send = (bytes) => NAF.connection.isConnected() && NAF.connection.broadcastData('body', bytes);
    this.sender = new PoseSender(send, { name });
    window.selfAvatar = this.body;
    window.others = this.others.object;
  },

  tick(timeMs) {
    if (!this.sender) return;
    this.body.update(timeMs, this.el.sceneEl.frame);
    this.sender.update(timeMs, this.body);
    this.others.update(timeMs);
  },
});
