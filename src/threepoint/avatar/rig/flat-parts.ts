import type { VRM } from '@pixiv/three-vrm';
import {
  BufferAttribute,
  type BufferGeometry,
  type Color,
  DataTexture,
  FloatType,
  MeshStandardMaterial,
  RGBAFormat,
  type SkinnedMesh,
  Texture,
} from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import type { Steps } from '../between-frames';
import { skinnedMeshesOf } from '../scene-meshes';
import { type ClothWeave, weaves } from './cloth-weave';

type FlatMesh = SkinnedMesh<BufferGeometry, MeshStandardMaterial>;

/** Returns whether a mesh's material differs from three's default only in colour, roughness and metalness. */
function isFlat(mesh: SkinnedMesh): mesh is FlatMesh {
  const { material } = mesh;
  if (Array.isArray(material) || material.type !== 'MeshStandardMaterial') return false;
  const { emissive, transparent, alphaTest } = material as MeshStandardMaterial;
  if (transparent || alphaTest > 0 || emissive.getHex() !== 0) return false;
  return !Object.values(material).some((value) => value instanceof Texture);
}

/** Attributes that `prepare` writes for every part. */
const written = ['uv', 'color'];

/** Returns a key that is equal for primitives that can be merged. */
function kindOf({ parent, skeleton, geometry, material }: FlatMesh): string {
  const attributes = Object.entries(geometry.attributes)
    .filter(([name]) => !written.includes(name))
    .map(([name, { array, itemSize, normalized }]) => [name, array.constructor.name, itemSize, normalized].join())
    .sort();
  const shapes = Object.entries(geometry.morphAttributes).map(([name, targets]) => [name, targets?.length].join());
  return [parent?.id, skeleton.uuid, material.side, material.flatShading, ...attributes, ...shapes].join(' ');
}

/** A material with the values of several others in a row of texels, so that their meshes can be one draw call. */
export class FlatPartsMaterial extends MeshStandardMaterial {
  /** The names and colours of the materials, in the order of their texels. */
  readonly parts: readonly { readonly name: string; readonly color: Color }[];
  readonly #colors: DataTexture;

  constructor(parts: readonly MeshStandardMaterial[]) {
    super({ color: 0xffffff, roughness: 1, metalness: 1, vertexColors: true, side: parts[0]!.side });
    this.parts = parts.map(({ name, color }) => ({ name, color: color.clone() }));
    this.name = 'flat parts';
    const row = (texels: readonly (readonly number[])[]) => {
      const texture = new DataTexture(new Float32Array(texels.flat()), parts.length, 1, RGBAFormat, FloatType);
      texture.needsUpdate = true;
      return texture;
    };
    this.#colors = row(parts.map(({ color }) => [...color.toArray(), 1]));
    const surfaces = row(parts.map(({ name, roughness, metalness }) => [weaves[name] ?? 0, roughness, metalness, 1]));
    this.map = this.#colors;
    this.roughnessMap = surfaces;
    this.metalnessMap = surfaces;
  }

  /** Draws the cloth of the project's own people with this weave; null: smooth, as it is at first. */
  setClothWeave(weave: ClothWeave | null): void {
    this.onBeforeCompile = weave ?? super.onBeforeCompile;
    this.needsUpdate = true;
  }

  /** Recolours the materials with these names: CSS colours. */
  recolour(colors: Readonly<Record<string, string>>): void {
    const texels = this.#colors.image.data as Float32Array;
    for (const [index, { name, color }] of this.parts.entries()) {
      const given = colors[name];
      if (given) color.set(given).toArray(texels, 4 * index);
    }
    this.#colors.needsUpdate = true;
  }
}

/** Points each vertex of a part to its texel, and gives all vertices a colour, which is white in most files. */
function prepare({ geometry }: FlatMesh, part: number, parts: number): BufferGeometry {
  const { count } = geometry.getAttribute('position');
  const texels = new Float32Array(2 * count).fill(0.5);
  for (let vertex = 0; vertex < count; vertex++) texels[2 * vertex] = (part + 0.5) / parts;
  const colors = new BufferAttribute(new Uint8Array(4 * count).fill(255), 4, true);
  const own = geometry.getAttribute('color');
  for (let vertex = 0; own && vertex < count; vertex++) {
    colors.setXYZ(vertex, own.getX(vertex), own.getY(vertex), own.getZ(vertex));
  }
  return geometry.setAttribute('uv', new BufferAttribute(texels, 2)).setAttribute('color', colors);
}

/**
 * Merges the primitives of each skinned mesh of a file whose materials have colours and no textures, so that it is one
 * draw call. The first primitive becomes the whole; the others leave the scene.
 */
export function* mergeFlatParts({ scene, expressionManager }: VRM): Steps<void> {
  // An expression that recolours a material names the material itself.
  if (expressionManager?.expressions.some(({ binds }) => binds.some((bind) => 'material' in bind))) return;
  const kinds = new Map<string, FlatMesh[]>();
  for (const mesh of skinnedMeshesOf(scene).filter(isFlat)) {
    const kind = kindOf(mesh);
    kinds.set(kind, [...(kinds.get(kind) ?? []), mesh]);
  }
  for (const meshes of kinds.values()) {
    const [first] = meshes;
    if (!first || meshes.length < 2) continue;
    yield;
    const whole = mergeGeometries(meshes.map((mesh, part) => prepare(mesh, part, meshes.length)));
    const material = new FlatPartsMaterial(meshes.map(({ material }) => material));
    for (const mesh of meshes) {
      mesh.geometry.dispose();
      mesh.material.dispose();
      if (mesh !== first) mesh.removeFromParent();
    }
    first.geometry = whole;
    first.material = material;
  }
}
