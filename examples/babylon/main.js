import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { HemisphericLight } from '@babylonjs/core/Lights/hemisphericLight.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { CreateGround } from '@babylonjs/core/Meshes/Builders/groundBuilder.js';
import { CreateSphere } from '@babylonjs/core/Meshes/Builders/sphereBuilder.js';
import { Scene } from '@babylonjs/core/scene.js';
import { WebXRBodyTracking } from '@babylonjs/core/XR/features/WebXRBodyTracking.js';
import { WebXRDefaultExperience } from '@babylonjs/core/XR/webXRDefaultExperience.js';
import { installBodyTracking } from 'threepoint/polyfill';

// Before Babylon requests a session. `?estimator=ik` shows inverse kinematics, to compare.
installBodyTracking({ estimator: new URLSearchParams(location.search).get('estimator') ?? 'learned' });

const engine = new Engine(document.getElementById('canvas'), true);
const scene = new Scene(engine);
new FreeCamera('camera', new Vector3(0, 1.6, -2), scene);
new HemisphericLight('light', Vector3.Up(), scene);
CreateGround('floor', { width: 10, height: 10 }, scene);

const { baseExperience } = await WebXRDefaultExperience.CreateAsync(scene, {
  disableHandTracking: true,
  disableNearInteraction: true,
  disablePointerSelection: true,
  disableTeleportation: true,
  // Babylon's models of controllers come from its own server.
  inputOptions: { disableOnlineControllerRepository: true, doNotLoadControllerMeshes: true },
});
const tracking = baseExperience.featuresManager.enableFeature(WebXRBodyTracking.Name, 'latest');
tracking.onBodyTrackingStartedObservable.add(({ jointTransforms }) => {
  // The head is where the eyes are. Babylon disposes of a joint's children with the session.
  for (const joint of jointTransforms.filter(({ name }) => name !== 'head')) {
    CreateSphere(joint.name, { diameter: 0.03, segments: 4 }, scene).parent = joint;
  }
});

engine.runRenderLoop(() => scene.render());
window.bodyTracking = tracking;
