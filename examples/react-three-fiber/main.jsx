import { Canvas } from '@react-three/fiber';
import { createRoot } from 'react-dom/client';
import { VRButton } from 'three/addons/webxr/VRButton.js';
import mannequin from 'threepoint/avatars/mannequin.vrm?url';
import { SelfAvatar } from 'threepoint/react';

const enterVr = ({ gl }) => {
  gl.xr.enabled = true;
  document.body.append(VRButton.createButton(gl));
};
const publish = (tracker) => {
  window.selfAvatar = tracker;
};

createRoot(document.getElementById('root')).render(
  <Canvas camera={{ position: [0, 1.6, 2] }} onCreated={enterVr}>
    <color attach="background" args={['#ccddee']} />
    <hemisphereLight intensity={3} />
    <gridHelper args={[10, 10]} />
    <SelfAvatar avatar={mannequin} ref={publish} onFallback={({ reason }) => console.warn(reason)} />
  </Canvas>,
);
