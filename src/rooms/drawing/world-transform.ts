import { Matrix4, type Object3D, Quaternion, Vector3 } from 'three';

const position = new Vector3();
const orientation = new Quaternion();
const scale = new Vector3();
const matrix = new Matrix4();
const transform = { position, orientation } as const;

/** Returns the position and orientation of an object in the scene. The next call overwrites the result. */
export function worldTransform(object: Object3D): typeof transform {
  object.updateWorldMatrix(true, false);
  object.matrixWorld.decompose(position, orientation, scale);
  return transform;
}

/**
 * Returns the position and orientation of an object in the space of another one. The next call overwrites the result.
 */
export function relativeTransform(object: Object3D, space: Object3D): typeof transform {
  object.updateWorldMatrix(true, false);
  space.updateWorldMatrix(true, false);
  matrix.copy(space.matrixWorld).invert().multiply(object.matrixWorld).decompose(position, orientation, scale);
  return transform;
}
