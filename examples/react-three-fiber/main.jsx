import { Canvas, useFrame, useThree } from '@react-three/fiber';
import { useEffect, useState } from 'react';
import { createRoot } from 'react-dom/client';
import { VRButton } from 'three/addons/webxr/VRButton.js';
import mannequin from 'threepoint/avatars/mannequin.vrm?url';
import { BodyTracker, loadAvatar } from 'threepoint/three';

function SelfAvatar({ src = mannequin }) {
  const renderer = useThree(({ gl }) => gl);
  const [body, setBody] = useState(null);
  useEffect(() => {
    let gone = false;
    const arrives = loadAvatar(src).then((avatar) => new BodyTracker(renderer, { avatar }));
    arrives.then((tracker) => {
      tracker.addEventListener('fallback', ({ reason }) => console.warn(reason));
      if (!gone) setBody(tracker);
    });
    return () => {
      gone = true;
      arrives.then((tracker) => tracker.dispose());
    };
  }, [renderer, src]);
  useFrame((_state, _delta, frame) => body?.update(performance.now(), frame));
  window.selfAvatar = body;
  return body && <primitive object={body.object} />;
}

const enterVr = ({ gl }) => {
  gl.xr.enabled = true;
  document.body.append(VRButton.createButton(gl));
};

createRoot(document.getElementById('root')).render(
  <Canvas camera={{ position: [0, 1.6, 2] }} onCreated={enterVr}>
    <color attach="background" args={['#ccddee']} />
    <hemisphereLight intensity={3} />
    <gridHelper args={[10, 10]} />
    <SelfAvatar />
  </Canvas>,
);
