import { type FbxNode, type FbxObject, type FbxValue, isNumbers, listIn } from './fbx-node';
import type { SceneParts } from './glb-of-scene';
import { isBinaryFbx } from './is-fbx';
import { limitFbxWork, plainCurve } from './limit-fbx-work';
import { readBinaryFbx } from './read-binary-fbx';
import { readTextFbx } from './read-text-fbx';
import { writeFbx } from './write-fbx';

/** The form of a field: a text, a number, the bytes of a picture, or a list of numbers, of this length if stated. */
type Form = 'text' | 'number' | 'picture' | 'list' | 16;
/** The fields of an object that FBXLoader reads; an inner record has fields itself. */
interface Fields {
  readonly [name: string]: Form | Fields;
}

/** The lists of values and of indices of the layers of a mesh; some programs write layers without one. */
const layers: Readonly<Record<string, { readonly values: readonly string[]; readonly indices: readonly string[] }>> = {
  LayerElementNormal: { values: ['Normals'], indices: ['NormalsIndex', 'NormalIndex'] },
  LayerElementUV: { values: ['UV'], indices: ['UVIndex'] },
  LayerElementColor: { values: ['Colors'], indices: ['ColorIndex'] },
  LayerElementMaterial: { values: ['Materials'], indices: ['Materials'] },
};
const layerFields = Object.entries(layers).map(([name, { values, indices }]) => {
  const lists = [...values, ...indices].map((list) => [list, 'list'] as const);
  return [name, { MappingInformationType: 'text', ReferenceInformationType: 'text', ...Object.fromEntries(lists) }];
});
const kinds: Readonly<Record<string, Fields>> = {
  ...{ Model: {}, Material: {}, LayeredTexture: {}, AnimationStack: {}, AnimationLayer: {}, AnimationCurveNode: {} },
  Geometry: {
    ...{ Vertices: 'list', PolygonVertexIndex: 'list', Indexes: 'list' },
    ...Object.fromEntries(layerFields),
  },
  Texture: { FileName: 'text' },
  Video: { RelativeFilename: 'text', Filename: 'text', Content: 'picture' },
  Deformer: { Indexes: 'list', Weights: 'list', TransformLink: 16, FullWeights: 'list' },
  Pose: { PoseNode: { Node: 'number', Matrix: 16 } },
  AnimationCurve: { KeyTime: 'list', KeyValueFloat: 'list' },
};
/** The settings of objects that FBXLoader and the writer of the GLB file use, with the count of their numbers. */
const settings: ReadonlyMap<FbxValue, 1 | 3> = new Map<FbxValue, 1 | 3>([
  ...['Lcl Translation', 'Lcl Rotation', 'Lcl Scaling', 'PreRotation', 'PostRotation'].map(
    (name) => [name, 3] as const,
  ),
  ...['ScalingOffset', 'ScalingPivot', 'RotationOffset', 'RotationPivot'].map((name) => [name, 3] as const),
  ...['GeometricTranslation', 'GeometricRotation', 'GeometricScaling'].map((name) => [name, 3] as const),
  ...['Diffuse', 'DiffuseColor', 'Emissive', 'EmissiveColor'].map((name) => [name, 3] as const),
  ...['InheritType', 'RotationOrder', 'UpAxis'].map((name) => [name, 1] as const),
  ...['EmissiveFactor', 'TransparencyFactor', 'Opacity'].map((name) => [name, 1] as const),
]);

const maxDepth = 256;
const rotationOrders: readonly number[] = [0, 1, 2, 3, 4, 5, 6];

const namesIn = (fields: Fields): string[] =>
  Object.entries(fields).flatMap(([name, form]) => [name, ...(typeof form === 'object' ? namesIn(form) : [])]);
const needed = new Set(['Objects', 'Connections', 'C', 'GlobalSettings', 'Properties70', 'P', ...namesIn(kinds)]);

/** The connections that FBXLoader reads, from a kind to the kind above it. */
const connectable = new Set([
  ...['Model>Model', 'Geometry>Model', 'Material>Model', 'AnimationCurveNode>Model', 'Model>Cluster'],
  ...[
    'Cluster>Skin',
    'Skin>Geometry',
    'Shape>BlendShapeChannel',
    'BlendShapeChannel>BlendShape',
    'BlendShape>Geometry',
  ],
  ...['Video>Texture', 'Texture>Material', 'Texture>LayeredTexture', 'LayeredTexture>Material'],
  ...['AnimationCurve>AnimationCurveNode', 'AnimationCurveNode>AnimationLayer', 'AnimationLayer>AnimationStack'],
]);

const nodeOf = (name: string, values: readonly FbxValue[], children: readonly FbxNode[] = []): FbxNode => ({
  ...{ name, values, children },
});

const isText = (value: FbxValue | undefined): value is string => typeof value === 'string';
const isFiniteNumber = (value: FbxValue | undefined): value is number => Number.isFinite(value);

const tests: Readonly<Record<Form, (value: FbxValue | undefined) => boolean>> = {
  text: isText,
  number: isFiniteNumber,
  picture: (value) => isText(value) || value instanceof Uint8Array,
  list: (value) => isNumbers(value) && value.every(Number.isFinite),
  16: (value) => isNumbers(value) && value.length === 16 && value.every(Number.isFinite),
};

/** Returns a node with its needed fields. Throws if one of them has another form. */
function checkedNode({ name, values, children }: FbxNode, fields: Fields): FbxNode {
  const checked = children.flatMap((child) => {
    const form = Object.hasOwn(fields, child.name) ? fields[child.name] : undefined;
    if (typeof form === 'object')
      return checkedLayer(checkedNode({ ...child, values: child.values.slice(0, 1) }, form));
    if (child.name === 'Properties70') return [nodeOf(child.name, [], child.children.flatMap(checkedSetting))];
    if (form === undefined) return [];
    // Pictures in FBX as text are split into several values.
    const value = form === 'picture' && child.values.every(isText) ? child.values.join('') : child.values[0];
    if (!tests[form](value)) throw new Error(`${child.name} in ${name} is damaged`);
    return [nodeOf(child.name, [value!])];
  });
  return nodeOf(name, values, checked);
}

/** Returns a layer of a mesh that has values, by the order of the values if it has no indices; FBXLoader needs both. */
function checkedLayer(node: FbxNode): readonly FbxNode[] {
  const layer = layers[node.name];
  if (!layer) return [node];
  const has = (names: readonly string[]): boolean => node.children.some(({ name }) => names.includes(name));
  if (!has(layer.values)) return [];
  return [
    has(layer.indices)
      ? node
      : { ...node, children: [...node.children, nodeOf('ReferenceInformationType', ['Direct'])] },
  ];
}

function checkedSetting({ values }: FbxNode): readonly FbxNode[] {
  const [name, type, , , ...rest] = values;
  const count = settings.get(name!);
  if (count === undefined) return [];
  const numbers = rest.slice(0, count);
  // A setting of fewer numbers is another one of this name.
  if (numbers.length < count) return [];
  const isWrongOrder = name === 'RotationOrder' && !rotationOrders.includes(numbers[0] as number);
  if (!numbers.every(isFiniteNumber) || isWrongOrder) throw new Error(`the setting “${name}” is damaged`);
  const kind = /^Color(RGB)?$/.test(String(type)) ? 'Color' : count === 3 ? 'Vector3D' : 'double';
  return [nodeOf('P', [name!, kind, '', 'A', ...numbers])];
}

/** Returns the objects by their numbers in the file: those of a body, or of its motion. */
function objectsIn(nodes: readonly FbxNode[], parts: SceneParts): ReadonlyMap<FbxValue, FbxObject> {
  const objects = new Map<FbxValue, FbxObject>();
  const isBody = parts === 'body' && nodes.some((node) => listIn(node, 'PolygonVertexIndex').length > 0);
  for (const node of nodes) {
    const fields = Object.hasOwn(kinds, node.name) ? kinds[node.name] : undefined;
    const [number, name = '', type = ''] = node.values;
    if (!fields || typeof number !== 'number' || objects.has(number)) continue;
    if (node.name === 'Geometry' && type !== 'Mesh' && type !== 'Shape') continue;
    if (node.name === 'AnimationCurveNode' && name !== 'T' && name !== 'R') continue;
    // A body needs no motion; it is read of files without a body, whose refusal states that they hold motion.
    if (isBody && /^Animation/.test(node.name)) continue;
    // Motion needs the skins of meshes, and not their shapes and surfaces.
    if (parts === 'motion' && /^(Material|(Layered)?Texture|Video)$/.test(node.name)) continue;
    const isShape = node.name === 'Geometry' && parts === 'motion';
    const checked = checkedNode(node, isShape ? {} : fields);
    const { children } = node.name === 'AnimationCurve' ? plainCurve(checked) : checked;
    const extra =
      { Material: [nodeOf('ShadingModel', ['phong'])], Texture: [nodeOf('FileName', [''])] }[node.name] ?? [];
    const id = objects.size + 1;
    objects.set(number, {
      id,
      kind: node.name === 'Deformer' || type === 'Shape' ? String(type) : node.name,
      node: nodeOf(node.name, [id, String(name), String(type)], [...extra, ...children]),
      below: [],
    });
  }
  return objects;
}

/** Connects the objects of a file and returns the connections. Throws if models are above each other without end. */
function connect(nodes: readonly FbxNode[], objects: ReadonlyMap<FbxValue, FbxObject>): readonly FbxNode[] {
  const connections: FbxNode[] = [];
  for (const { values } of nodes) {
    const [child, parent] = [objects.get(values[1]!), objects.get(values[2]!)];
    if (!child || !parent || !connectable.has(`${child.kind}>${parent.kind}`)) continue;
    if (child.kind === 'Model' && parent.kind === 'Model') {
      child.parent = parent;
      continue;
    }
    parent.below.push(child);
    connections.push(nodeOf('C', ['', child.id, parent.id, ...values.slice(3, 4).filter(isText)]));
  }
  for (const { id, kind, parent } of objects.values()) {
    // FBXLoader needs a connection of each model and texture.
    if (kind === 'Model' || kind === 'Texture') connections.push(nodeOf('C', ['', id, parent?.id ?? 0]));
    let depth = 0;
    for (let above = parent; above; above = above.parent) {
      depth += 1;
      if (depth > maxDepth) throw new Error(`has bones that are nested deeper than ${maxDepth} levels`);
    }
  }
  return connections;
}

/** Returns the node of an object without references to objects that are left out. */
function resolvedNodes(
  { kind, node, below }: FbxObject,
  objects: ReadonlyMap<FbxValue, FbxObject>,
): readonly FbxNode[] {
  const { name, values, children } = node;
  if (kind === 'Pose') {
    const poses = children.flatMap((pose) => {
      const bone = objects.get(pose.children.find((child) => child.name === 'Node')?.values[0] ?? '');
      const matrix = pose.children.filter((child) => child.name === 'Matrix');
      return bone && matrix.length > 0 ? [nodeOf('PoseNode', [], [nodeOf('Node', [bone.id]), ...matrix])] : [];
    });
    return poses.length > 0 ? [nodeOf(name, values, [nodeOf('NbPoseNodes', [poses.length]), ...poses])] : [];
  }
  if (kind !== 'Model') return [node];
  const isMesh = below.some((object) => object.kind === 'Geometry');
  const [id, label, type] = values as [number, string, string];
  const isKnown = type === 'LimbNode' || type === 'Root' || (type === 'Mesh' && isMesh);
  return [nodeOf(name, [id, label, isKnown ? type : 'Null'], children)];
}

/**
 * Returns what three.js's loader needs of an FBX file, in a form in which it reads it without a window and in bounded
 * time. Throws the end of a sentence about the file if its parts do not fit together or a limit is exceeded.
 */
export function checkedFbx(bytes: Uint8Array, parts: SceneParts): ArrayBuffer {
  const read = isBinaryFbx(bytes) ? readBinaryFbx : readTextFbx;
  const file = read(bytes, (name) => needed.has(name));
  const section = (name: string) => file.filter((node) => node.name === name);
  const inside = (name: string) => section(name).flatMap(({ children }) => children);
  const objects = objectsIn(inside('Objects'), parts);
  const connections = connect(inside('Connections'), objects);
  const connected = new Set(connections.flatMap(({ values }) => values));
  const used = [...objects.values()].filter(({ id, kind }) => connected.has(id) || kind === 'Pose');
  limitFbxWork(used);
  return writeFbx([
    ...section('GlobalSettings').map((node) => checkedNode({ ...node, values: [] }, {})),
    nodeOf(
      'Objects',
      [],
      used.flatMap((object) => resolvedNodes(object, objects)),
    ),
    nodeOf('Connections', [], connections),
  ]);
}
