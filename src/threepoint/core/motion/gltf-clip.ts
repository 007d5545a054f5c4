import { isIndex, isObject, type Json } from '../json';
import {
  conjugate,
  copyQuat,
  fromAxes,
  type MutableQuat,
  multiply,
  normaliseQuat,
  type Quat,
  quat,
  readQuat,
  rotate,
  setQuat,
  slerp,
} from '../math/quat';
import { parentsFirst } from '../math/tree';
import {
  add,
  copyVec3,
  cross,
  length,
  type MutableVec3,
  normalise,
  readVec3,
  reject,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from '../math/vec3';
import { createSkeletonPose, type ImportedMotion, type SkeletonPose } from './imported-motion';

/** A clip of glTF has no rate of its own: it is read at this one [Hz]. */
const rateHz = 60;
/** Two and a half hours. */
const maxFrames = 540_000;
const maxNodes = 5000;
/** The longest time between two keys, on average, of clips above ten minutes [s]: few keys are not read for long. */
const maxKeySeconds = 10;
const shortClipSeconds = 600;

/** By how much a time in single precision may be too small, as a fraction of it. */
const precision = 2 ** -23;

type Path = 'translation' | 'rotation';
interface Track {
  readonly path: Path;
  readonly times: Float32Array;
  readonly values: Float32Array;
  readonly interpolation: 'LINEAR' | 'STEP' | 'CUBICSPLINE';
}

/** A node and its animation tracks. */
interface Node {
  parent: number;
  readonly translation: Vec3;
  readonly rotation: Quat;
  readonly scale: Vec3;
  readonly tracks: Track[];
}

/** Returns the objects of a list; an empty list where the value is no list. */
export const objects = (value: unknown): readonly Json[] => (Array.isArray(value) ? value.filter(isObject) : []);

const noMatrix: readonly number[] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function numbers(value: unknown, fallback: readonly number[], what: string): readonly number[] {
  if (value === undefined) return fallback;
  if (Array.isArray(value) && value.length === fallback.length && value.every(Number.isFinite)) return value;
  throw new Error(`${what} is not ${fallback.length} finite numbers`);
}

/** Decomposes a matrix (column-major) into translation, rotation and scale; shear and mirrors are lost. */
export function decompose(matrix: readonly number[]): Pick<Node, 'translation' | 'rotation' | 'scale'> {
  const column = (i: number): Vec3 => readVec3(matrix, 4 * i);
  const [x, y, z] = [column(0), column(1), column(2)];
  const size = vec3(length(x), length(y), length(z));
  const [right, up] = [normalise(x), normalise(reject(y, normalise(x)))];
  return { translation: column(3), rotation: fromAxes(right, up, cross(right, up)), scale: size };
}

function nodesOf(description: Json): Node[] {
  const given = objects(description.nodes);
  if (given.length > maxNodes) throw new Error(`more than ${maxNodes} nodes: not a human skeleton`);
  const nodes = given.map(({ translation, rotation, scale, matrix }, i): Node => {
    const place =
      matrix === undefined
        ? {
            translation: readVec3(numbers(translation, [0, 0, 0], `nodes[${i}].translation`), 0),
            rotation: readQuat(numbers(rotation, [0, 0, 0, 1], `nodes[${i}].rotation`), 0),
            scale: readVec3(numbers(scale, [1, 1, 1], `nodes[${i}].scale`), 0),
          }
        : decompose(numbers(matrix, noMatrix, `nodes[${i}].matrix`));
    return { parent: -1, ...place, tracks: [] };
  });
  for (const [i, { children }] of given.entries()) {
    for (const child of Array.isArray(children) ? children : []) {
      const node = isIndex(child) ? nodes[child] : undefined;
      if (!node) throw new Error(`nodes[${i}] has a child that is not there`);
      if (node.parent >= 0) throw new Error(`nodes[${child}] has two parents`);
      node.parent = i;
    }
  }
  return nodes;
}

/** Returns the numbers of an accessor; normalised integers are fractions of the largest. */
export function accessorOf(description: Json, binary: Uint8Array, index: unknown): Float32Array {
  if (!isIndex(index)) throw new Error('animations[0]: a sampler does not name its accessors');
  const accessor = objects(description.accessors)[index];
  const view = isIndex(accessor?.bufferView) ? objects(description.bufferViews)[accessor.bufferView] : undefined;
  const size = { SCALAR: 1, VEC3: 3, VEC4: 4, MAT4: 16 }[String(accessor?.type)];
  const kind = { 5126: Float32Array, 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array }[
    Number(accessor?.componentType)
  ];
  if (!accessor || !view || !size || !kind || !isIndex(accessor.count) || view.byteStride !== undefined)
    throw new Error(`accessors[${index}] is none of a clip's numbers`);
  const begin = Number(view.byteOffset ?? 0) + Number(accessor.byteOffset ?? 0);
  const bytes = accessor.count * size * kind.BYTES_PER_ELEMENT;
  if (!(isIndex(begin) && begin + bytes <= binary.length))
    throw new Error(`accessors[${index}] reaches beyond the end of the file`);
  const raw = new kind(binary.slice(begin, begin + bytes).buffer);
  const largest = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 }[Number(accessor.componentType)];
  const values = largest ? Float32Array.from(raw, (value) => Math.max(-1, value / largest)) : Float32Array.from(raw);
  const wrong = values.findIndex((value) => !Number.isFinite(value));
  if (wrong >= 0) throw new Error(`accessors[${index}]: its number ${wrong + 1} is not finite`);
  return values;
}

/** Adds the tracks of an animation to its nodes; returns the duration [s]. */
function readTracks(description: Json, binary: Uint8Array, nodes: readonly Node[], index: number): number {
  const animation = objects(description.animations)[index];
  if (!animation) throw new Error('there is no animation in it');
  const samplers = objects(animation.samplers);
  let duration = 0;
  for (const [i, { sampler, target }] of objects(animation.channels).entries()) {
    const { node, path } = isObject(target) ? target : {};
    const of = isIndex(sampler) ? samplers[sampler] : undefined;
    const moved = isIndex(node) ? nodes[node] : undefined;
    if (!of || !moved) throw new Error(`animations[${index}].channels[${i}] moves a node that is not there`);
    if (path !== 'translation' && path !== 'rotation') continue;
    const interpolation = of.interpolation ?? 'LINEAR';
    if (interpolation !== 'LINEAR' && interpolation !== 'STEP' && interpolation !== 'CUBICSPLINE')
      throw new Error(`animations[${index}].channels[${i}] is interpolated in a way that glTF does not know`);
    const times = accessorOf(description, binary, of.input);
    const values = accessorOf(description, binary, of.output);
    const size = (path === 'rotation' ? 4 : 3) * (interpolation === 'CUBICSPLINE' ? 3 : 1);
    if (times.length === 0 || values.length !== size * times.length)
      throw new Error(`animations[${index}].channels[${i}] has ${values.length} numbers for ${times.length} times`);
    if (times.some((time, at) => at > 0 && time < times[at - 1]!))
      throw new Error(`animations[${index}].channels[${i}]: its times do not rise`);
    moved.tracks.push({ path, times, values, interpolation });
    duration = Math.max(duration, times.at(-1)!);
  }
  return duration;
}

/** Returns the index of the last key that is not later than `time`; 0 where all are. */
function lastBefore(times: Float32Array, time: number): number {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

const before: number[] = [];
const after: number[] = [];

/** Writes the numbers of a track at a time [s]; rotations are interpolated along the shorter arc. */
function sample({ path, times, values, interpolation }: Track, time: number, target: number[]): void {
  const size = path === 'rotation' ? 4 : 3;
  const spline = interpolation === 'CUBICSPLINE';
  const index = lastBefore(times, time);
  const next = Math.min(index + 1, times.length - 1);
  const span = times[next]! - times[index]!;
  const fraction = span > 0 ? Math.max(0, Math.min(1, (time - times[index]!) / span)) : 0;
  const at = (key: number, part: number, i: number): number => values[(spline ? 3 * key + part : key) * size + i]!;
  for (let i = 0; i < size; i++) {
    [before[i], after[i]] = [at(index, 1, i), at(next, 1, i)];
    if (interpolation === 'STEP') target[i] = before[i]!;
    else if (!spline) target[i] = before[i]! + (after[i]! - before[i]!) * fraction;
    else {
      const [t2, t3] = [fraction * fraction, fraction ** 3];
      const [leaving, arriving] = [span * at(index, 2, i), span * at(next, 0, i)];
      const ends = (2 * t3 - 3 * t2 + 1) * before[i]! + (3 * t2 - 2 * t3) * after[i]!;
      target[i] = ends + (t3 - 2 * t2 + fraction) * leaving + (t3 - t2) * arriving;
    }
  }
  if (path === 'translation' || interpolation === 'STEP') return;
  const { x, y, z, w } = spline
    ? normaliseQuat(readQuat(target, 0))
    : slerp(readQuat(before, 0), readQuat(after, 0), fraction);
  [target[0], target[1], target[2], target[3]] = [x, y, z, w];
}

/** The forward kinematics of all nodes; without a time [s] they are at rest. */
class Scene {
  readonly #places: MutableVec3[];
  readonly #turns: MutableQuat[];
  readonly #scales: MutableVec3[];
  readonly #numbers: number[] = [];

  constructor(
    readonly nodes: readonly Node[],
    readonly order: readonly number[],
  ) {
    this.#places = nodes.map(() => vec3(0, 0, 0));
    this.#turns = nodes.map(() => quat(0, 0, 0, 1));
    this.#scales = nodes.map(() => vec3(1, 1, 1));
  }

  pose(time: number | null): void {
    for (const i of this.order) {
      const { parent, translation, rotation, scale, tracks } = this.nodes[i]!;
      const [place, turn, size] = [this.#places[i]!, this.#turns[i]!, this.#scales[i]!];
      copyVec3(translation, place);
      copyQuat(rotation, turn);
      copyVec3(scale, size);
      for (const track of time === null ? [] : tracks) {
        sample(track, time!, this.#numbers);
        const [x, y, z, w] = this.#numbers as [number, number, number, number];
        if (track.path === 'translation') setVec3(place, x, y, z);
        else setQuat(turn, x, y, z, w);
      }
      if (parent < 0) continue;
      const [from, by, larger] = [this.#places[parent]!, this.#turns[parent]!, this.#scales[parent]!];
      setVec3(place, place.x * larger.x, place.y * larger.y, place.z * larger.z);
      add(from, rotate(by, place, place), place);
      multiply(by, turn, turn);
      setVec3(size, size.x * larger.x, size.y * larger.y, size.z * larger.z);
    }
  }

  write(bones: readonly number[], target: SkeletonPose): SkeletonPose {
    for (const [i, node] of bones.entries()) {
      copyVec3(this.#places[node]!, target.positions[i]!);
      copyQuat(this.#turns[node]!, target.rotations[i]!);
    }
    return target;
  }
}

/** The nodes of a description and one of its animations. */
export class GltfClip {
  readonly nodes: readonly Node[];
  /** The indices of the nodes, parents before children. */
  readonly order: readonly number[];
  readonly frameCount: number;
  readonly #scene: Scene;

  /** Throws a sentence that names the field where something is wrong. `animation`: its index. */
  constructor(description: Json, binary: Uint8Array, animation = 0) {
    this.nodes = nodesOf(description);
    this.order = parentsFirst(this.nodes.map(({ parent }) => parent));
    if (this.order.length < this.nodes.length) throw new Error('the nodes go in a circle: a bone is its own ancestor');
    this.#scene = new Scene(this.nodes, this.order);
    const duration = readTracks(description, binary, this.nodes, animation);
    const keys = this.nodes
      .flatMap(({ tracks }) => tracks)
      .reduce((most, { times }) => Math.max(most, times.length), 0);
    if (duration > Math.max(shortClipSeconds, maxKeySeconds * keys))
      throw new Error(
        `it lasts ${Math.round(duration)} s with ${keys} keys; motion has one in ${maxKeySeconds} s at least`,
      );
    this.frameCount = Math.floor(duration * (1 + precision) * rateHz + 1e-6) + 1;
    if (!(this.frameCount <= maxFrames))
      throw new Error(`it lasts ${Math.round(duration)} s; a person's motion here may last 9000`);
  }

  /** Writes nodes as the file shows them without its animation. */
  rest(nodes: readonly number[]): SkeletonPose {
    this.#scene.pose(null);
    return this.#scene.write(nodes, createSkeletonPose(nodes.length));
  }

  /** Returns for each of these nodes which of them is the nearest above it; −1: none. */
  parentsAmong(nodes: readonly number[]): readonly number[] {
    const indexOf = new Map(nodes.map((node, index) => [node, index]));
    const above = new Map<number, number>();
    for (const node of this.order) {
      const { parent } = this.nodes[node]!;
      above.set(node, indexOf.get(parent) ?? above.get(parent) ?? -1);
    }
    return nodes.map((node) => above.get(node)!);
  }

  /** Returns the motion of nodes, counted from this rest, whose origin is the joint `root`. */
  motion(
    { names, nodes }: { readonly names: readonly string[]; readonly nodes: readonly number[] },
    { positions, rotations }: SkeletonPose,
    root: number,
  ): ImportedMotion {
    const scene = this.#scene;
    const back = rotations.map((rotation) => conjugate(rotation));
    return {
      ...{ names, parents: this.parentsAmong(nodes), rateHz, frameCount: this.frameCount, notes: [] },
      rest: positions.map((position) => subtract(position, positions[root]!)),
      pose(frame, target) {
        scene.pose(frame / rateHz);
        scene.write(nodes, target);
        for (const [i, rotation] of target.rotations.entries()) multiply(rotation, back[i]!, rotation);
        return target;
      },
    };
  }
}
