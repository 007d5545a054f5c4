import { Canvas } from '@react-three/fiber';
import { createXRStore, XR, XROrigin } from '@react-three/xr';
import { StrictMode, useRef } from 'react';
import { createRoot } from 'react-dom/client';
import mannequin from 'threepoint/avatars/mannequin.vrm?url';
import { RemoteAvatar, SelfAvatar } from 'threepoint/react';

const store = createXRStore({ emulate: false, controller: false });
const publish = (name) => (shown) => void Object.assign(window, { [name]: shown });
const [publishSelf, publishRemote] = [publish('selfAvatar'), publish('remoteAvatar')];

/** The user, and a body in front of them as another page would draw it from the poses that it receives. */
function Bodies() {
  const received = useRef(null);
  const send = (pose) => Object.assign(received, { current: pose });
  return (
    <>
      <XROrigin>
        <SelfAvatar avatar={mannequin} ref={publishSelf} onPose={send} onSessionEnd={() => send(null)} />
      </XROrigin>
      <group position={[0, 0, -2]} rotation={[0, Math.PI, 0]}>
        <RemoteAvatar avatar={mannequin} ref={publishRemote} pose={received} />
      </group>
    </>
  );
}

createRoot(document.getElementById('root')).render(
  <StrictMode>
    <button id="VRButton" type="button" onClick={() => store.enterVR()}>
      Enter VR
    </button>
    <Canvas>
      <XR store={store}>
        <hemisphereLight intensity={3} />
        <Bodies />
      </XR>
    </Canvas>
  </StrictMode>,
);
