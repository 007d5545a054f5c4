import { type FbxNode, type FbxObject, listIn } from './fbx-node';

/** The most models; a GLB file of a body or of its motion may have fewer. */
const maxModels = 5000;
/** The largest polygon that is cut into triangles [corners]. */
const maxCorners = 1000;
/** The limit of FBXLoader's steps: it compares each item of some lists with each of another (about 2 s). */
const maxSteps = 2e9;
/** The limit of subdivisions of all curves: the loader subdivides turns of more than half a circle. */
const maxSubdivisions = 2e6;
/** The limit of the numbers that FBXLoader makes: at the corners of triangles, for morph targets and for keys. */
const maxMadeNumbers = 60e6;
/** The numbers at a corner: position, normal, texture coordinates, colour, joints and weights. */
const numbersOfCorner = 20;
/** The numbers of a key: its time, and a rotation as angles and as a quaternion. */
const numbersOfKey = 8;

/** The work of FBXLoader for a part of a file. */
interface Work {
  steps: number;
  numbers: number;
  subdivisions: number;
}

/** Returns the work of cutting a mesh into triangles. Throws if its lists do not fit together. */
function meshWork({ node, below }: FbxObject): Work {
  const work: Work = { steps: 0, numbers: 0, subdivisions: 0 };
  const vertices = listIn(node, 'Vertices').length / 3;
  const weights = new Map<number, number>();
  for (const cluster of below.flatMap((object) => (object.kind === 'Skin' ? object.below : []))) {
    const indices = listIn(cluster.node, 'Indexes');
    if (indices.length !== listIn(cluster.node, 'Weights').length)
      throw new Error('has a bone with more vertices than weights, or fewer');
    for (const index of indices) weights.set(index, (weights.get(index) ?? 0) + 1);
  }
  const channels = below.flatMap((object) => (object.kind === 'BlendShape' ? object.below : []));
  let count = 0;
  let corners = 0;
  for (const corner of listIn(node, 'PolygonVertexIndex')) {
    const vertex = corner < 0 ? ~corner : corner;
    if (!(vertex < vertices)) throw new Error('has a polygon whose vertices are not there');
    work.steps += weights.get(vertex) ?? 0;
    count += 1;
    if (count > maxCorners) throw new Error(`has a polygon of more than ${maxCorners} corners`);
    if (corner >= 0) continue;
    corners += 3 * Math.max(1, count - 2);
    // A mesh is cut into triangles again for each morph target.
    if (count > 3) work.steps += count * count * (1 + channels.length);
    count = 0;
  }
  work.numbers = corners * (numbersOfCorner + 3 * channels.length);
  return work;
}

/** Returns the work of making tracks of the curves that move a model. */
function tracksWork({ node, below }: FbxObject): Work {
  const work: Work = { steps: 0, numbers: 0, subdivisions: 0 };
  const isRotation = node.values[1] === 'R';
  const times = new Set<number>();
  for (const curve of below) for (const time of listIn(curve.node, 'KeyTime')) times.add(time);
  for (const curve of below) {
    const values = listIn(curve.node, 'KeyValueFloat');
    if (!isRotation || values.length !== times.size) work.steps += (values.length * times.size) / 2;
    if (isRotation)
      for (let i = 1; i < values.length; i++) work.subdivisions += Math.abs(values[i]! - values[i - 1]!) / 180;
  }
  work.numbers = numbersOfKey * times.size;
  return work;
}

/**
 * Returns a curve without the keys between equal ones, which FBXLoader would read in the square of their number. Throws
 * if it has not one value for each time, or its times do not rise.
 */
export function plainCurve(curve: FbxNode): FbxNode {
  const [times, values] = [listIn(curve, 'KeyTime'), listIn(curve, 'KeyValueFloat')];
  if (times.length !== values.length)
    throw new Error(`has an animation with ${values.length} values for ${times.length} times`);
  if (times.some((time, i) => i > 0 && time < times[i - 1]!))
    throw new Error('has an animation whose times do not rise');
  const isNeeded = (_: number, i: number): boolean => values[i - 1] !== values[i] || values[i + 1] !== values[i];
  const lists = { KeyTime: times.filter(isNeeded), KeyValueFloat: values.filter(isNeeded) };
  const children = Object.entries(lists).map(([name, list]) => ({ name, values: [list], children: [] }));
  return { ...curve, children };
}

/** Adds up the work for the parts of a file; throws the end of a sentence about the file where it exceeds a limit. */
class TotalWork implements Work {
  steps = 0;
  numbers = 0;
  subdivisions = 0;

  add({ steps = 0, numbers = 0, subdivisions = 0 }: Partial<Work>, times = 1): this {
    this.steps += steps * times;
    this.numbers += numbers * times;
    this.subdivisions += subdivisions * times;
    if (this.subdivisions > maxSubdivisions) throw new Error('has an animation that turns without end');
    if (this.numbers > maxMadeNumbers)
      throw new Error(`needs more than ${maxMadeNumbers / 1e6} million numbers for its meshes and keys`);
    if (this.steps > maxSteps) throw new Error('is too large in a way that takes minutes to read');
    return this;
  }
}

/** Limits the work of FBXLoader for these objects. Throws the end of a sentence about the file. */
export function limitFbxWork(objects: readonly FbxObject[]): void {
  const ofKind = (kind: string) => objects.filter((object) => object.kind === kind);
  const models = ofKind('Model');
  if (models.length > maxModels) throw new Error(`has more than ${maxModels} nodes`);
  const clusters = ofKind('Cluster');
  const clusterBones = clusters.reduce((sum, { below }) => sum + below.length, models.length);
  const total = new TotalWork().add({ steps: clusterBones * clusters.length });
  // A mesh is written for each model that has it.
  const meshes = new Map<FbxObject, number>();
  for (const { below } of models) for (const object of below) meshes.set(object, (meshes.get(object) ?? 0) + 1);
  for (const geometry of ofKind('Geometry')) {
    const { steps, numbers } = meshWork(geometry);
    total.add({ steps }).add({ numbers }, meshes.get(geometry) ?? 0);
  }
  // A layer is read for each clip that has it.
  const clips = new Map<FbxObject | undefined, number>();
  for (const { below } of ofKind('AnimationStack')) clips.set(below[0], (clips.get(below[0]) ?? 0) + 1);
  for (const layer of ofKind('AnimationLayer')) {
    total.add({ steps: layer.below.length * models.length });
    for (const curves of layer.below) total.add(tracksWork(curves), clips.get(layer) ?? 0);
  }
}
