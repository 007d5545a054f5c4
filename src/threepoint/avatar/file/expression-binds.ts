import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import * as v from 'valibot';

const index = v.pipe(v.number(), v.integer(), v.minValue(0));
const weight = v.optional(v.number());
const numbers = (count: number) => v.pipe(v.array(v.number()), v.minLength(count));
const colorBind = v.object({ material: index, type: v.string(), targetValue: numbers(4) });
const textureBind = v.object({ material: index, scale: v.optional(numbers(2)), offset: v.optional(numbers(2)) });

interface Description {
  readonly nodes?: readonly unknown[];
  readonly extensions?: {
    readonly VRMC_vrm?: { readonly expressions?: Readonly<Record<string, unknown>> };
    readonly VRM?: { readonly blendShapeMaster?: { readonly blendShapeGroups?: unknown } };
  };
}

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
