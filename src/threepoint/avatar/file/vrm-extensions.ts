import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import * as v from 'valibot';

/** The parts of a VRM's JSON that three-vrm reads without a check. */
interface Description {
  readonly nodes?: readonly unknown[];
  readonly extensions?: {
    readonly VRMC_vrm?: { readonly expressions?: Readonly<Record<string, unknown>> };
    VRMC_springBone?: unknown;
    readonly VRM?: {
      readonly blendShapeMaster?: { readonly blendShapeGroups?: unknown };
      secondaryAnimation?: unknown;
    };
  };
}

const index = v.pipe(v.number(), v.integer(), v.minValue(0));
const weight = v.optional(v.number());
const numbers = (count: number) => v.pipe(v.array(v.number()), v.minLength(count));
const colorBind = v.object({ material: index, type: v.string(), targetValue: numbers(4) });
const textureBind = v.object({ material: index, scale: v.optional(numbers(2)), offset: v.optional(numbers(2)) });

const objectsIn = (value: unknown): Record<string, unknown>[] =>
  typeof value === 'object' && value !== null
    ? Object.values(value).filter((inner) => typeof inner === 'object' && inner !== null)
    : [];

/** Removes the items of an expression's lists that do not match their schema. */
function keepValid(expressions: unknown, schemas: Readonly<Record<string, v.GenericSchema>>): void {
  for (const expression of objectsIn(expressions)) {
    for (const [list, schema] of Object.entries(schemas)) {
      const binds = expression[list];
      expression[list] = Array.isArray(binds) ? binds.filter((bind) => v.is(schema, bind)) : [];
    }
  }
}

/**
 * Removes invalid binds from the expressions of a VRM 0.x or 1.0. three-vrm reads binds in promises that it does not
 * await: an invalid one would cause an unhandled rejection.
 */
export const removeInvalidExpressionBinds = (parser: GLTFParser): GLTFLoaderPlugin => ({
  name: 'threepoint_expressions',
  beforeRoot() {
    const { nodes = [], extensions } = parser.json as Description;
    const node = v.pipe(index, v.maxValue(nodes.length - 1));
    const { preset, custom } = extensions?.VRMC_vrm?.expressions ?? {};
    const lists = {
      morphTargetBinds: v.object({ node, index, weight }),
      materialColorBinds: colorBind,
      textureTransformBinds: textureBind,
    };
    keepValid(preset, lists);
    keepValid(custom, lists);
    keepValid(extensions?.VRM?.blendShapeMaster?.blendShapeGroups, { binds: v.object({ mesh: index, index, weight }) });
    return null;
  },
});

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
