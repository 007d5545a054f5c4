import { isIndex, type Json } from '../json';
import { angleBetween, conjugate, identity, multiply, type Quat, rotate } from '../math/quat';
import { add, distance, scale, subtract, type Vec3 } from '../math/vec3';
import { accessorOf, decompose, GltfClip, objects } from './gltf-clip';
import { createSkeletonPose, type ImportedMotion, type SkeletonPose } from './imported-motion';

/** A joint in the space in which its skin was bound. */
interface Bound {
  readonly position: Vec3;
  readonly rotation: Quat;
}

/** Returns where skins were bound to their joints, by node. Throws a sentence where a joint is no node. */
function bindPoses(description: Json, binary: Uint8Array): ReadonlyMap<number, Bound> {
  const bound = new Map<number, Bound>();
  const nodeCount = objects(description.nodes).length;
  for (const [skin, { joints, inverseBindMatrices }] of objects(description.skins).entries()) {
    if (!Array.isArray(joints) || inverseBindMatrices === undefined) continue;
    const inverses = accessorOf(description, binary, inverseBindMatrices);
    for (const [i, joint] of joints.entries()) {
      if (!isIndex(joint) || joint >= nodeCount)
        throw new Error(`skins[${skin}].joints[${i}] is a node that is not there`);
      if (bound.has(joint) || inverses.length < 16 * (i + 1)) continue;
      const { translation, rotation, scale: size } = decompose([...inverses.subarray(16 * i, 16 * i + 16)]);
      const back = conjugate(rotation);
      bound.set(joint, { position: scale(rotate(back, translation), -1 / size.x), rotation: back });
    }
  }
  return bound;
}

/**
 * Returns how much longer bones are as shown than as bound: the median, since some exporters bind the ends of chains a
 * hundredfold off.
 */
function sizeOf(clip: GltfClip, bound: ReadonlyMap<number, Bound>, shown: SkeletonPose): number {
  const ratios = [...bound].flatMap(([node, { position }]) => {
    const { parent } = clip.nodes[node]!;
    const above = bound.get(parent);
    const length = above ? distance(position, above.position) : 0;
    return length > 0 ? [distance(shown.positions[node]!, shown.positions[parent]!) / length] : [];
  });
  return ratios.sort((a, b) => a - b)[ratios.length >> 1] ?? 1;
}

/**
 * Returns all nodes as their skins were bound to them. What the file shows without its clip may be a picture of an
 * animation; the bind pose is a T or an A.
 */
function restOf(clip: GltfClip, bound: ReadonlyMap<number, Bound>): SkeletonPose {
  const all = clip.nodes.map((_, node) => node);
  const shown = clip.rest(all);
  const first = clip.order.find((node) => bound.has(node));
  if (first === undefined) return shown;
  // Skins are bound in the space of the scene, or in that of the node above their bones.
  const above = clip.nodes[first]!.parent;
  const off = (turn: Quat): number =>
    [...bound].reduce(
      (sum, [node, { rotation }]) => sum + angleBetween(multiply(turn, rotation), shown.rotations[node]!),
      0,
    );
  const [turn] = [identity, shown.rotations[above] ?? identity].sort((a, b) => off(a) - off(b)) as [Quat];
  const size = sizeOf(clip, bound, shown);
  const rest = createSkeletonPose(all.length);
  for (const node of clip.order) {
    const { parent } = clip.nodes[node]!;
    const own = bound.get(node);
    const [position, rotation] = [rest.positions[node]!, rest.rotations[node]!];
    if (own) {
      scale(rotate(turn, own.position, position), size, position);
      multiply(turn, own.rotation, rotation);
      continue;
    }
    // A node that no skin was bound to keeps its place against the one above.
    const [from, by] = parent < 0 ? [null, identity] : [shown.positions[parent]!, shown.rotations[parent]!];
    const moved = multiply(parent < 0 ? identity : rest.rotations[parent]!, conjugate(by));
    multiply(moved, shown.rotations[node]!, rotation);
    subtract(shown.positions[node]!, from ?? { x: 0, y: 0, z: 0 }, position);
    rotate(moved, position, position);
    if (parent >= 0) add(rest.positions[parent]!, position, position);
  }
  return rest;
}

const durationOf = (description: Json, animation: Json): number =>
  objects(animation.samplers).reduce((longest, { input }) => {
    const { max } = (isIndex(input) ? objects(description.accessors)[input] : undefined) ?? {};
    return Array.isArray(max) && Number.isFinite(max[0]) ? Math.max(longest, max[0] as number) : longest;
  }, 0);

/**
 * Reads the longest clip of a GLB file that moves the bones of a body. Throws a sentence that names the field where
 * there is none.
 */
export function readGlbMotion(description: Json, binary: Uint8Array): ImportedMotion {
  const animations = objects(description.animations);
  const durations = animations.map((animation) => durationOf(description, animation));
  const longest = Math.max(0, durations.indexOf(Math.max(...durations)));
  const clip = new GltfClip(description, binary, longest);
  const bound = bindPoses(description, binary);
  const given = objects(description.nodes);
  const isBone = (node: number): boolean =>
    bound.has(node) || (given[node]!.mesh === undefined && given[node]!.camera === undefined);
  const nodes = clip.order.filter(isBone);
  const names = nodes.map((node) => String(given[node]!.name ?? `node ${node}`));
  const rest = restOf(clip, bound);
  const chosen = {
    positions: nodes.map((node) => rest.positions[node]!),
    rotations: nodes.map((node) => rest.rotations[node]!),
  };
  const motion = clip.motion({ names, nodes }, chosen, 0);
  if (animations.length < 2) return motion;
  const { name } = animations[longest]!;
  const taken = typeof name === 'string' && name !== '' ? `“${name.slice(0, 60)}”` : `number ${longest + 1}`;
  return { ...motion, notes: [`it has ${animations.length} clips; the longest, ${taken}, is shown`] };
}
