import { Canvas } from '@react-three/fiber';
import { StrictMode, useState } from 'react';
import { createRoot } from 'react-dom/client';
import { VRButton } from 'three/addons/webxr/VRButton.js';
import mannequin from 'threepoint/avatars/mannequin.vrm?url';
import { SelfAvatar } from 'threepoint/react';
import { RoomAvatars } from 'threepoint-rooms/react';

const name = new URLSearchParams(location.search).get('name') ?? 'Guest';
const publish = (room) => void Object.assign(window, { room, others: room?.others.object });

function People() {
  const [tracker, setTracker] = useState(null);
  window.selfAvatar = tracker;
  return (
    <>
      <SelfAvatar avatar={mannequin} ref={setTracker} />
      {tracker && <RoomAvatars url={location.origin} name={name} body={tracker} ref={publish} />}
    </>
  );
}

const enterVr = ({ gl }) => {
  gl.xr.enabled = true;
  document.body.append(VRButton.createButton(gl));
};

createRoot(document.getElementById('root')).render(
  <StrictMode>
    <Canvas camera={{ position: [0, 1.6, 2] }} onCreated={enterVr}>
      <color attach="background" args={['#ccddee']} />
      <hemisphereLight intensity={3} />
      <gridHelper args={[10, 10]} />
      <People />
    </Canvas>
  </StrictMode>,
);
