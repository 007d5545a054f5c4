import { Body, forwardKinematics, skeletonFromCalibration } from 'threepoint';
import { TrackingReader } from 'threepoint/webxr';

const gl = document.createElement('canvas').getContext('webgl2', { xrCompatible: true });
document.body.append(gl.canvas);
const body = new Body();
window.selfAvatar = body;

/** Draws each joint as a square. The body stands a metre ahead of its user. */
function drawJoints(joints, { projectionMatrix, transform }, { x, y, width, height }) {
  const toEye = DOMMatrix.fromFloat32Array(transform.inverse.matrix);
  const toPicture = DOMMatrix.fromFloat32Array(projectionMatrix).multiply(toEye);
  for (const { position } of Object.values(joints)) {
    const at = toPicture.transformPoint({ ...position, z: position.z - 1 });
    if (at.w < 0) continue;
    gl.scissor(x + ((at.x / at.w + 1) * width) / 2 - 4, y + ((at.y / at.w + 1) * height) / 2 - 4, 8, 8);
    gl.clearColor(1, 0.6, 0.2, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }
}

document.querySelector('#VRButton').onclick = async () => {
  const session = await navigator.xr.requestSession('immersive-vr', { requiredFeatures: ['local-floor'] });
  const baseLayer = new XRWebGLLayer(session, gl);
  session.updateRenderState({ baseLayer });
  const floor = await session.requestReferenceSpace('local-floor');
  floor.addEventListener('reset', () => body.discontinuity());
  const reader = new TrackingReader(session);
  session.requestAnimationFrame(function draw(timeMs, frame) {
    session.requestAnimationFrame(draw);
    const pose = body.update(reader.read(timeMs, frame, floor));
    gl.bindFramebuffer(gl.FRAMEBUFFER, baseLayer.framebuffer);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    if (!pose?.body) return;
    const joints = forwardKinematics(skeletonFromCalibration(body.calibration), pose.body);
    const eyes = frame.getViewerPose(floor)?.views ?? [];
    for (const eye of eyes) drawJoints(joints, eye, baseLayer.getViewport(eye));
    window.joints = joints;
  });
};
