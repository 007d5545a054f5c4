import { type Object3D, Quaternion, Vector3 } from 'three';

const position = new Vector3();
const orientation = new Quaternion();
const scale = new Vector3();
const transform = { position, orientation } as const;

/** Returns the place and the turn of an object in the scene. The next call overwrites the result. */
export function worldTransform(object: Object3D): typeof transform {
  object.updateWorldMatrix(true, false);
  object.matrixWorld.decompose(position, orientation, scale);
  return transform;
}
