'use client';

import { Canvas } from '@react-three/fiber';
import { createXRStore, XR } from '@react-three/xr';
import { SelfAvatar } from 'threepoint/react';

const store = createXRStore({ emulate: false, controller: false });
const publish = (tracker) => {
  window.selfAvatar = tracker;
};

export function Scene() {
  return (
    <div style={{ height: '100vh' }}>
      <button id="VRButton" type="button" onClick={() => store.enterVR()}>
        Enter VR
      </button>
      <Canvas>
        <XR store={store}>
          <hemisphereLight intensity={3} />
          <SelfAvatar avatar="/me.vrm" ref={publish} />
        </XR>
      </Canvas>
    </div>
  );
}
