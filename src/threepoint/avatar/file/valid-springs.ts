import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import * as v from 'valibot';

const number = v.nullish(v.pipe(v.number(), v.finite()));
const vector = v.nullish(v.pipe(v.array(v.pipe(v.number(), v.finite())), v.minLength(3)));
// Not in the order of a vector's fields: see `Vec3`.
const point = v.nullish(v.object({ z: number, y: number, x: number }));
const indices = v.nullish(v.array(v.number()));
const listOf = (entries: v.ObjectEntries) => v.nullish(v.array(v.object(entries)));

const volume = v.nullish(v.object({ offset: vector, radius: number, tail: vector, normal: vector }));
const shape = v.object({ sphere: volume, capsule: volume, plane: volume });
const extended = v.nullish(v.object({ shape: v.nullish(shape) }));
const springs = v.object({
  colliders: listOf({
    shape,
    extensions: v.nullish(v.object({ VRMC_springBone_extended_collider: extended })),
  }),
  colliderGroups: listOf({ colliders: indices }),
  springs: listOf({
    joints: listOf({
      ...{ node: v.number(), hitRadius: number, stiffness: number, gravityPower: number, dragForce: number },
      gravityDir: vector,
    }),
    colliderGroups: indices,
  }),
});
const oldSprings = v.object({
  colliderGroups: listOf({ colliders: listOf({ offset: point, radius: number }) }),
  boneGroups: listOf({
    ...{ hitRadius: number, stiffiness: number, gravityPower: number, dragForce: number },
    ...{ gravityDir: point, bones: indices, colliderGroups: indices },
  }),
});

interface Description {
  readonly extensions?: {
    VRMC_springBone?: unknown;
    readonly VRM?: { secondaryAnimation?: unknown };
  };
}

/**
 * Removes the springs of a VRM 0.x or 1.0 that have a value which is no finite number. three-vrm would compute with it
 * in every later frame.
 */
export const removeInvalidSprings = (parser: GLTFParser): GLTFLoaderPlugin => ({
  name: 'threepoint_springs',
  beforeRoot() {
    const { extensions } = parser.json as Description;
    if (extensions && !v.is(springs, extensions.VRMC_springBone)) delete extensions.VRMC_springBone;
    const old = extensions?.VRM;
    if (typeof old === 'object' && old !== null && !v.is(oldSprings, old.secondaryAnimation))
      delete old.secondaryAnimation;
    return null;
  },
});
