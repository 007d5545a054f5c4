import {
  type AnimationClip,
  Box3,
  type BufferAttribute,
  type BufferGeometry,
  type Group,
  type KeyframeTrack,
  Matrix4,
  type Mesh,
  type MeshPhongMaterial,
  type Object3D,
  type SkinnedMesh,
  type Texture,
  Vector3,
} from 'three';
import { mergeVertices } from 'three/addons/utils/BufferGeometryUtils.js';
import { packGlb } from '../../../core/motion/gltf';
import { imageSize } from '../image-size';

/** The parts of a scene to keep: the meshes of a body, or the clips of its bones. */
export type SceneParts = 'body' | 'motion';

type Picture = Uint8Array<ArrayBuffer>;
/** Reads the picture of a texture; null: there is none. */
type ReadPicture = (texture: Texture) => Promise<Picture | null>;

interface Description {
  [list: string]: object[] | object;
  readonly nodes: object[];
  readonly bufferViews: object[];
  readonly accessors: object[];
}

const floatType = 5126;
const shortType = 5123;
const wideType = 5125;
/** The distance below which vertices are merged [fraction of their mesh's size], and its maximum in the file's unit. */
const sameVertex = 1e-6;
const maxVertexDistance = 1e-4;
/** The roughness of skin and cloth, which FBX does not state. */
const roughness = 0.8;

/** Returns the number that FBXLoader gives a node of the file. */
const idOf = (node: Object3D): unknown => (node as { ID?: unknown }).ID;
/** Returns whether a node is a copy of its parent: FBXLoader adds one to a bone for each further skin. */
const isCopy = (node: Object3D): boolean =>
  idOf(node) !== undefined && node.parent !== null && idOf(node) === idOf(node.parent);
const original = (node: Object3D): Object3D => (isCopy(node) ? original(node.parent!) : node);
const nameOf = (node: Object3D): string => {
  const { originalName } = node.userData;
  return typeof originalName === 'string' ? originalName : node.name;
};

/** Writes a three.js scene as the parts of a GLB file. */
class GlbWriter {
  readonly #parts: Uint8Array<ArrayBuffer>[] = [];
  readonly #json: Description = { nodes: [], bufferViews: [], accessors: [] };
  readonly #nodes = new Map<Object3D, number>();
  /** The indices of written materials, with and without pictures. */
  readonly #materials = { painted: new Map<unknown, number>(), plain: new Map<unknown, number>() };
  readonly #pictures = new Map<string, number | null>();
  #length = 0;

  constructor(readonly readPicture: ReadPicture) {}

  #list(name: string): object[] {
    const list = (this.#json[name] ?? []) as object[];
    this.#json[name] = list;
    return list;
  }

  #view(bytes: Uint8Array<ArrayBuffer>): number {
    const padding = (4 - (this.#length % 4)) % 4;
    if (padding > 0) this.#parts.push(new Uint8Array(padding));
    this.#parts.push(bytes);
    const byteOffset = this.#length + padding;
    this.#length = byteOffset + bytes.length;
    return this.#json.bufferViews.push({ buffer: 0, byteOffset, byteLength: bytes.length }) - 1;
  }

  #accessor(values: Float32Array | Uint16Array | Uint32Array, type: string, size: number, bounds: object = {}): number {
    if (!values.every(Number.isFinite)) throw new Error('has numbers that are not finite');
    const componentType =
      values instanceof Float32Array ? floatType : values instanceof Uint16Array ? shortType : wideType;
    const bytes = new Uint8Array(values.slice().buffer as ArrayBuffer);
    const bufferView = this.#view(bytes);
    return this.#json.accessors.push({ bufferView, componentType, type, count: values.length / size, ...bounds }) - 1;
  }

  #attribute({ array, itemSize }: BufferAttribute, bounds?: object): number {
    return this.#accessor(array as Float32Array, `VEC${itemSize}`, itemSize, bounds);
  }

  /** Writes a node and its descendants; returns its index. */
  async node(object: Object3D, parts: SceneParts): Promise<number> {
    const node: Record<string, unknown> = {
      name: nameOf(object),
      translation: object.position.toArray(),
      rotation: object.quaternion.normalize().toArray(),
      scale: object.scale.toArray(),
    };
    if (![...object.position, ...object.quaternion, ...object.scale].every(Number.isFinite))
      throw new Error(`has a node without a finite place: “${nameOf(object).slice(0, 60)}”`);
    const index = this.#json.nodes.push(node) - 1;
    this.#nodes.set(object, index);
    const children: number[] = [];
    for (const child of object.children) if (!isCopy(child)) children.push(await this.node(child, parts));
    if (children.length > 0) node.children = children;
    if ('isMesh' in object && parts === 'body') {
      const primitives = await this.#primitives(object as Mesh);
      if (primitives.length > 0) node.mesh = this.#list('meshes').push({ primitives }) - 1;
    }
    return index;
  }

  /** Binds the meshes to their bones. All nodes must have been written. */
  skins(scene: Object3D, parts: SceneParts): void {
    scene.traverse((object) => {
      if (!('isSkinnedMesh' in object)) return;
      const { skeleton, bindMatrix } = object as SkinnedMesh;
      // FBXLoader leaves a hole for a cluster without a bone.
      const joints = Array.from(skeleton.bones, (bone) => (bone && this.#nodes.get(original(bone))) ?? 0);
      const inverses = new Float32Array(16 * joints.length);
      const matrix = new Matrix4();
      for (const [i, inverse] of skeleton.boneInverses.entries())
        matrix.multiplyMatrices(inverse, bindMatrix).toArray(inverses, 16 * i);
      const inverseBindMatrices = this.#accessor(inverses, 'MAT4', 16);
      const skin = this.#list('skins').push({ joints, inverseBindMatrices }) - 1;
      const node = this.#json.nodes[this.#nodes.get(object)!] as { mesh?: number; skin?: number };
      if (parts === 'body' && node.mesh !== undefined) node.skin = skin;
    });
  }

  async #primitives(mesh: Mesh): Promise<object[]> {
    const geometry = whole(mesh.geometry);
    if (!geometry) return [];
    const { position, normal, uv, color, skinIndex, skinWeight } = geometry.attributes as Record<
      string,
      BufferAttribute
    >;
    const attributes: Record<string, number> = { POSITION: this.#attribute(position!, boundsOf(position!)) };
    if (normal) attributes.NORMAL = this.#attribute(normal);
    if (uv) attributes.TEXCOORD_0 = this.#accessor(upsideDown(uv), 'VEC2', 2);
    if (color) attributes.COLOR_0 = this.#attribute(color);
    if (skinIndex && skinWeight && 'isSkinnedMesh' in mesh) {
      attributes.JOINTS_0 = this.#accessor(usedJoints(skinIndex, skinWeight), 'VEC4', 4);
      attributes.WEIGHTS_0 = this.#attribute(skinWeight);
    }
    const targets = (geometry.morphAttributes.position ?? []).map((target) => ({
      POSITION: this.#attribute(target as BufferAttribute, boundsOf(target as BufferAttribute)),
    }));
    const materials = [mesh.material].flat() as MeshPhongMaterial[];
    const primitives: object[] = [];
    for (const [material, corners] of cornersByMaterial(geometry)) {
      const narrow = position!.count < 65_535;
      const indices = this.#accessor(narrow ? Uint16Array.from(corners) : Uint32Array.from(corners), 'SCALAR', 1);
      const surface = materials[material] ?? materials[0];
      primitives.push({
        ...{ attributes, indices },
        ...(targets.length > 0 && { targets }),
        ...(surface && { material: await this.#material(surface, uv ? 'painted' : 'plain') }),
      });
    }
    return primitives;
  }

  /** Writes a material and returns its index. `kind`: 'plain' for a mesh without texture coordinates. */
  async #material(material: MeshPhongMaterial, kind: 'painted' | 'plain'): Promise<number> {
    const known = this.#materials[kind].get(material);
    if (known !== undefined) return known;
    const { name, color, map, normalMap, emissive, emissiveIntensity, emissiveMap, opacity, alphaMap } = material;
    const texture = (of: Texture | null) => (of && kind === 'painted' ? this.#texture(of) : undefined);
    const baseColorTexture = await texture(map);
    const normalTexture = await texture(normalMap);
    const emissiveTexture = await texture(emissiveMap);
    // A picture replaces the colour: programs export any colour with it.
    const tint = baseColorTexture || !color ? [1, 1, 1] : color.toArray().map(unit);
    const glow = emissive ? emissive.toArray().map((value) => unit(value * emissiveIntensity)) : [0, 0, 0];
    const index =
      this.#list('materials').push({
        ...(name && { name }),
        pbrMetallicRoughness: {
          baseColorFactor: [...tint, unit(opacity)],
          ...(baseColorTexture && { baseColorTexture }),
          ...{ metallicFactor: 0, roughnessFactor: roughness },
        },
        ...(normalTexture && { normalTexture }),
        ...(emissiveTexture && { emissiveTexture }),
        ...(glow.some((value) => value > 0) && { emissiveFactor: glow }),
        ...(opacity < 1 ? { alphaMode: 'BLEND' } : alphaMap ? { alphaMode: 'MASK', doubleSided: true } : {}),
      }) - 1;
    this.#materials[kind].set(material, index);
    return index;
  }

  /** Returns a texture of the file; undefined: its picture lies outside, or is of a kind that browsers do not show. */
  async #texture(texture: Texture): Promise<{ readonly index: number } | undefined> {
    const url = String(texture.userData.url);
    let index = this.#pictures.get(url);
    if (index === undefined) {
      const picture = await this.readPicture(texture);
      index = picture && imageSize(picture) ? this.#picture(picture) : null;
      this.#pictures.set(url, index);
    }
    return index === null ? undefined : { index };
  }

  #picture(picture: Picture): number {
    const mimeType = picture[0] === 0x89 ? 'image/png' : picture[0] === 0xff ? 'image/jpeg' : 'image/webp';
    const source = this.#list('images').push({ bufferView: this.#view(picture), mimeType }) - 1;
    if (mimeType !== 'image/webp') return this.#list('textures').push({ source }) - 1;
    const extensions = { EXT_texture_webp: { source } };
    this.#json.extensionsUsed = ['EXT_texture_webp'];
    this.#json.extensionsRequired = ['EXT_texture_webp'];
    return this.#list('textures').push({ extensions }) - 1;
  }

  /** Writes a clip: positions and rotations of nodes by the names that FBXLoader gave them. */
  clip({ name, tracks }: AnimationClip, scene: Object3D): void {
    const named = new Map<string, number>();
    for (const [object, index] of this.#nodes)
      if (!named.has(object.name) && object !== scene) named.set(object.name, index);
    for (const [object, index] of this.#nodes) if ('isBone' in object) named.set(object.name, index);
    const samplers: object[] = [];
    const channels: object[] = [];
    for (const track of tracks) {
      const [, owner = '', property] = /^(.*)\.(position|quaternion)$/.exec(track.name) ?? [];
      const node = named.get(owner);
      if (node === undefined || track.times.length === 0) continue;
      const path = property === 'position' ? 'translation' : 'rotation';
      const target = { node, path };
      channels.push({ sampler: samplers.push(this.#sampler(track, path)) - 1, target });
    }
    if (channels.length > 0) this.#list('animations').push({ ...(name && { name }), samplers, channels });
  }

  #sampler({ times, values }: KeyframeTrack, path: 'translation' | 'rotation'): object {
    const input = Float32Array.from(times);
    const bounds = { min: [input[0]], max: [input.at(-1)] };
    const [type, size] = path === 'translation' ? (['VEC3', 3] as const) : (['VEC4', 4] as const);
    return {
      input: this.#accessor(input, 'SCALAR', 1, bounds),
      output: this.#accessor(Float32Array.from(values), type, size),
      interpolation: 'LINEAR',
    };
  }

  get hasMeshes(): boolean {
    return 'meshes' in this.#json;
  }

  file(root: number): Promise<ArrayBuffer> {
    const description = {
      asset: { version: '2.0', generator: 'threepoint' },
      scene: 0,
      scenes: [{ nodes: [root] }],
      ...Object.fromEntries(Object.entries(this.#json).filter(([, list]) => (list as object[]).length > 0)),
      ...(this.#length > 0 && { buffers: [{ byteLength: this.#length }] }),
    };
    return new Blob([...packGlb(description, this.#parts)]).arrayBuffer();
  }
}

const unit = (value: number): number => Math.min(1, Math.max(0, Number.isFinite(value) ? value : 1));

/** Returns a mesh's shape with each vertex once; null: it has no triangles. */
function whole(geometry: BufferGeometry): BufferGeometry | null {
  const { position } = geometry.attributes;
  if (!position || position.count < 3) return null;
  const size = new Box3()
    .setFromBufferAttribute(position as BufferAttribute)
    .getSize(new Vector3())
    .length();
  return mergeVertices(geometry, Math.min(maxVertexDistance, size * sameVertex) || maxVertexDistance);
}

function boundsOf(attribute: BufferAttribute): object {
  const { min, max } = new Box3().setFromBufferAttribute(attribute);
  return { min: min.toArray(), max: max.toArray() };
}

/** Returns texture coordinates for glTF, which counts a picture's rows from the top; FBX counts from the bottom. */
function upsideDown(uv: BufferAttribute): Float32Array {
  const turned = Float32Array.from(uv.array);
  for (let i = 1; i < turned.length; i += 2) turned[i] = 1 - turned[i]!;
  return turned;
}

/** Returns the joints with 0 in place of joints without weight. */
function usedJoints(joints: BufferAttribute, weights: BufferAttribute): Uint16Array {
  return Uint16Array.from(joints.array, (joint, i) => (weights.array[i]! > 0 ? joint : 0));
}

/** Returns the corners of the triangles of each material. */
function cornersByMaterial({ index, groups }: BufferGeometry): ReadonlyMap<number, readonly number[]> {
  const all = [...(index?.array ?? [])];
  if (groups.length === 0) return new Map([[0, all]]);
  const corners = new Map<number, number[]>();
  for (const { start, count, materialIndex = 0 } of groups) {
    const known = corners.get(materialIndex) ?? [];
    for (let i = start; i < Math.min(start + count, all.length); i++) known.push(all[i]!);
    corners.set(materialIndex, known);
  }
  for (const [material, list] of corners) if (list.length === 0) corners.delete(material);
  return corners;
}

/**
 * Writes a scene as a GLB file: nodes and skins, with the meshes of a body or with the clips. A scene without meshes
 * keeps its clips.
 */
export async function glbOfScene(
  scene: Group & { readonly animations: readonly AnimationClip[] },
  parts: SceneParts,
  readPicture: ReadPicture,
): Promise<ArrayBuffer> {
  const writer = new GlbWriter(readPicture);
  const root = await writer.node(scene, parts);
  writer.skins(scene, parts);
  if (parts === 'motion' || !writer.hasMeshes) for (const clip of scene.animations) writer.clip(clip, scene);
  return writer.file(root);
}
