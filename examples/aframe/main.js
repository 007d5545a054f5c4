import AFRAME from 'aframe';
import mannequin from 'threepoint/avatars/mannequin.vrm?url';
import { BodyTracker, loadAvatar } from 'threepoint/three';

AFRAME.registerComponent('self-avatar', {
  schema: { src: { default: mannequin } },

  async init() {
    const { sceneEl, object3D } = this.el;
    const avatar = await loadAvatar(this.data.src);
    // The component was removed while it waited.
    if (this.gone) return avatar.dispose();
    this.body = new BodyTracker(sceneEl.renderer, { avatar });
    this.body.addEventListener('fallback', ({ reason }) => console.warn(reason));
    object3D.add(this.body.object);
    window.selfAvatar = this.body;
  },

  tick(timeMs) {
    this.body?.update(timeMs, this.el.sceneEl.frame);
  },

  remove() {
    this.gone = true;
    this.body?.dispose();
  },
});
