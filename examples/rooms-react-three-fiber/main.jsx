import { Canvas, useFrame, useThree } from '@react-three/fiber';
import { useEffect, useState } from 'react';
import { createRoot } from 'react-dom/client';
import { VRButton } from 'three/addons/webxr/VRButton.js';
import { BodyTracker, loadMannequin } from 'threepoint/three';
import { joinRoom } from 'threepoint-rooms/three';

/** Returns the value of a promise, which is null until it is there; releases it when the component goes. */
function useLoaded(load, release, dependency) {
  const [loaded, setLoaded] = useState(null);
  // biome-ignore lint/correctness/useExhaustiveDependencies: both functions depend on the one value alone.
  useEffect(() => {
    const loading = load();
    loading.then(setLoaded);
    return () => loading.then(release);
  }, [dependency]);
  return loaded;
}

function Others({ body, name }) {
  const room = useLoaded(
    () => joinRoom(location.origin, { name, body }),
    (joined) => joined.leave(),
    body,
  );
  useFrame(() => room?.update(performance.now()));
  Object.assign(window, { selfAvatar: body, room, others: room?.others.object });
  return room && <primitive object={room.others.object} />;
}

function People() {
  const renderer = useThree(({ gl }) => gl);
  const load = async () => new BodyTracker(renderer, { avatar: await loadMannequin() });
  const body = useLoaded(load, (tracker) => tracker.dispose(), renderer);
  useFrame((_state, _delta, frame) => body?.update(performance.now(), frame));
  const name = new URLSearchParams(location.search).get('name') ?? 'Guest';
  return body && [<primitive key="self" object={body.object} />, <Others key="others" body={body} name={name} />];
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
    <People />
  </Canvas>,
);
