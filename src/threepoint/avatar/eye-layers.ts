import type { Object3D } from 'three';

/** The layers of a session's left and right eye, as three.js's WebXRManager sets them. No other camera has them. */
export const eyeLayers = [1, 2] as const;

/** Shows an object to the eyes of a session only, not to mirrors and desktop cameras. */
export function showToEyesOnly(object: Object3D): void {
  object.layers.disableAll();
  for (const eye of eyeLayers) object.layers.enable(eye);
}
