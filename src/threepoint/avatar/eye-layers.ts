import type { Object3D } from 'three';

/**
 * three's WebXRManager gives the left eye of a session the first of these layers and the right eye the second, and no
 * other camera any.
 */
export const eyeLayers = [1, 2] as const;

/** Only the eyes of a session see it: no mirror, no camera of the desktop. */
export function showToEyesAlone(object: Object3D): void {
  object.layers.disableAll();
  for (const eye of eyeLayers) object.layers.enable(eye);
}
