import type { VRM } from '@pixiv/three-vrm';
import {
  Box3,
  type Camera,
  Color,
  type Material,
  type Mesh,
  MeshStandardMaterial,
  type Object3D,
  SkinnedMesh,
  Vector3,
} from 'three';
import type { SkinTone } from '../../core/body/built-in-bodies';
import { recordOf } from '../../core/records';
import type { Steps } from '../between-frames';
import { palettes, skinColors } from '../palettes';
import { meshesOf } from '../scene-meshes';
import type { ClothWeave } from './cloth-weave';
import { appendDistantTriangles, type MeshSimplifier } from './distant-triangles';
import { FlatPartsMaterial } from './flat-parts';
import type { Rig } from './rig';
import { type PartEnds, type SkinPart, skinParts, sortByPart } from './skin-parts';

/** VRM's layer of third-person-only meshes, such as the user's head. */
export const thirdPersonOnlyLayer = 10;
const firstPersonOnlyLayer = 9;

/** The materials that a palette recolours, and its colour for each. */
const paletteParts = {
  Suit: 'suit',
  Accent: 'color',
  Head: 'head',
  Visor: 'visor',
  Top: 'color',
  Bottom: 'suit',
} as const;

/** Returns CSS colours of the materials that a palette recolours. */
const colorsOf = (colorOf: (material: keyof typeof paletteParts) => string): Readonly<Record<string, string>> =>
  recordOf(Object.keys(paletteParts) as (keyof typeof paletteParts)[], colorOf);

/** Returns names and CSS colours of a material, or of those that were merged into it. */
const coloredParts = (material: Material): (readonly [name: string, color: string])[] => {
  const parts = material instanceof FlatPartsMaterial ? material.parts : [material as Partial<MeshStandardMaterial>];
  return parts.map(({ name = '', color }) => [name, color ? `#${color.getHexString()}` : '']);
};

export interface AvatarMesh {
  readonly mesh: Mesh;
  readonly visibleTo: 'both' | 'others' | 'self';
  /** A mesh without a skin is one part as a whole. */
  readonly ends: PartEnds;
}

/** Returns the meshes of a body, and sorts the indices of skinned ones by part; called once. */
export function* readMeshes(
  vrm: VRM,
  { bones, helpers }: Pick<Rig, 'bones' | 'helpers'>,
): Steps<readonly AvatarMesh[]> {
  const partByNode = new Map<Object3D, SkinPart | 'hips'>();
  const hipLine = bones.get('leftUpperLeg')?.restPosition.y ?? 0;
  for (const [name, { node }] of bones) {
    const part: SkinPart | 'hips' =
      name === 'hips'
        ? 'hips'
        : name.endsWith('Hand')
          ? 'hands'
          : name === 'head'
            ? 'head'
            : /Leg$|Foot$/.test(name)
              ? 'legs'
              : 'trunk';
    partByNode.set(node, part);
  }
  const partOfBone = (node: Object3D): SkinPart | 'hips' => {
    // The skin of a helper joint belongs to the part before its bone: that of a wrist to the sleeve.
    const from = helpers.has(node) ? (node.parent?.parent ?? null) : node;
    for (let above = from; above; above = above.parent) {
      const part = partByNode.get(above);
      if (part) return part;
    }
    return 'trunk';
  };
  const result: AvatarMesh[] = [];
  for (const mesh of meshesOf(vrm.scene)) {
    // Bones move the skin far from its rest position, so that the bounds of the geometry do not apply.
    mesh.frustumCulled = false;
    mesh.castShadow = true;
    const visibleTo = mesh.layers.isEnabled(0)
      ? 'both'
      : mesh.layers.isEnabled(firstPersonOnlyLayer)
        ? 'self'
        : 'others';
    const ends =
      mesh instanceof SkinnedMesh ? yield* sortByPart(mesh, partOfBone, hipLine) : endsOfPart(mesh, partOfBone(mesh));
    result.push({ mesh, visibleTo, ends });
  }
  return result;
}

/** Returns the index counts of a mesh that is one part as a whole. */
function endsOfPart({ geometry }: Mesh, part: SkinPart | 'hips'): PartEnds {
  const first = skinParts.indexOf(part === 'hips' ? 'trunk' : part);
  const count = geometry.index?.count ?? 0;
  return recordOf(skinParts, (_, index) => (index < first ? 0 : count));
}

/** The maximum number of vertices that are read for a head's height; hair has many. */
const maxCorners = 1500;

/** Returns the height of the head's skin and its descendants at rest [m], in the rig's frame. */
function topOf(meshes: readonly AvatarMesh[], head: Object3D | undefined): number {
  let top = 0;
  const place = new Vector3();
  for (const { mesh, ends } of meshes) {
    if (mesh instanceof SkinnedMesh) {
      const step = Math.max(1, Math.ceil((ends.head - ends.hands) / maxCorners));
      for (let corner = ends.hands; corner < ends.head; corner += step) {
        const vertex = mesh.geometry.index?.getX(corner) ?? 0;
        top = Math.max(top, mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld).y);
      }
    } else if (head && isBelow(mesh, head)) top = Math.max(top, new Box3().setFromObject(mesh).max.y);
  }
  return top;
}

/** Returns whether a node is `above` or a descendant of it. */
export const isBelow = (node: Object3D | null, above: Object3D): boolean =>
  node !== null && (node === above || isBelow(node.parent, above));

function materialsOf(mesh: Mesh): Material[] {
  return Array.isArray(mesh.material) ? mesh.material : [mesh.material];
}

/** The distance of a camera from the hips from which a body is drawn with fewer triangles [m]. */
const distantFrom = 3.5;

/** The visible parts of a body: all, head and hands, or nothing before its first pose. */
type VisibleParts = 'body' | 'hands' | 'nothing';

/** Controls the meshes of an avatar: which parts are drawn, for which cameras, in which colours. */
export class BodyMeshes {
  /** The height of the top of the head at rest [m], in the rig's frame. */
  readonly top: number;
  private readonly meshes: readonly AvatarMesh[];
  private readonly looks = new Map<Material, { readonly transparent: boolean; readonly opacity: number }>();
  /** The colours of the file's materials that a palette recolours. */
  private readonly ownColors: Readonly<Record<string, string>>;
  /** The node of the hips, whose distance from a camera counts. */
  private readonly hips: Object3D | undefined;
  private shown: VisibleParts = 'nothing';
  private upperBodyOnly = false;
  private firstPerson = false;
  private opacity = 1;

  constructor(meshes: readonly AvatarMesh[], { bones }: Pick<Rig, 'bones'>) {
    this.meshes = meshes;
    const own = new Map(meshes.flatMap(({ mesh }) => materialsOf(mesh).flatMap(coloredParts)));
    this.ownColors = colorsOf((material) => own.get(material) ?? '');
    this.top = topOf(this.meshes, bones.get('head')?.node);
    this.hips = bones.get('hips')?.node;
    this.showParts();
    this.showLayers();
  }

  /** Sets the visible parts; returns whether they have changed. */
  setVisibleParts(shown: VisibleParts): boolean {
    if (shown === this.shown) return false;
    this.shown = shown;
    this.showParts();
    return true;
  }

  setUpperBodyOnly(on: boolean): void {
    this.upperBodyOnly = on;
    this.showParts();
  }

  setFirstPerson(on: boolean): void {
    if (on === this.firstPerson) return;
    this.firstPerson = on;
    this.showLayers();
  }

  /** Recolours the materials of a palette; null: in their own colours. An unknown palette changes nothing. */
  setPalette(name: string | null): void {
    const palette = palettes.find((candidate) => candidate.name === name);
    if (palette) this.recolour(colorsOf((material) => palette[paletteParts[material]]));
    else if (name === null) this.recolour(this.ownColors);
  }

  /** Recolours the skin of this project's bodies; null: unchanged. */
  setSkinTone(tone: SkinTone | null): void {
    if (tone) this.recolour({ Skin: skinColors[tone] });
  }

  /** Draws the cloth of this project's people with this weave; null: smooth. */
  setClothWeave(weave: ClothWeave | null): void {
    for (const { mesh } of this.meshes)
      for (const material of materialsOf(mesh))
        if (material instanceof FlatPartsMaterial) material.setClothWeave(weave);
  }

  /** Draws fewer triangles of skinned meshes in shadows and at a distance. */
  *simplifyAtDistance(simplifier: MeshSimplifier): Steps<void> {
    for (const { mesh, ends } of this.meshes) {
      if (!(mesh instanceof SkinnedMesh)) continue;
      const distantEnds = yield* appendDistantTriangles(mesh, ends, simplifier);
      const { geometry } = mesh;
      const drawNear = () => geometry.setDrawRange(0, ends[this.lastPart]);
      const drawDistant = () => geometry.setDrawRange(ends.legs, distantEnds[this.lastPart] - ends.legs);
      mesh.onBeforeShadow = drawDistant;
      mesh.onBeforeRender = (_renderer, _scene, camera) => (this.isDistant(camera) ? drawDistant() : drawNear());
    }
  }

  private isDistant({ matrixWorld: { elements: camera } }: Camera): boolean {
    const body = this.hips?.matrixWorld.elements;
    return (
      body !== undefined &&
      Math.hypot(camera[12] - body[12], camera[13] - body[13], camera[14] - body[14]) > distantFrom
    );
  }

  private recolour(colors: Readonly<Record<string, string>>): void {
    for (const { mesh } of this.meshes) {
      for (const material of materialsOf(mesh)) {
        if (material instanceof FlatPartsMaterial) material.recolour(colors);
        const color = colors[material.name];
        if (color && material instanceof MeshStandardMaterial) material.color = new Color(color);
      }
    }
  }

  setOpacity(opacity: number): void {
    if (opacity === this.opacity) return;
    this.opacity = opacity;
    for (const { mesh } of this.meshes) {
      for (const material of materialsOf(mesh)) {
        const solid = this.originalLook(material);
        const transparent = solid.transparent || opacity < 1;
        if (material.transparent !== transparent) {
          material.transparent = transparent;
          material.needsUpdate = true;
        }
        material.opacity = opacity * solid.opacity;
      }
      mesh.castShadow = opacity > 0.5;
    }
  }

  /** Returns a material's original transparency and opacity: hair and glasses may be transparent. */
  private originalLook(material: Material) {
    const { transparent, opacity } = material;
    const look = this.looks.get(material) ?? { transparent, opacity };
    this.looks.set(material, look);
    return look;
  }

  /** The last of the parts that are drawn. */
  private get lastPart(): SkinPart {
    return this.shown === 'hands' ? 'head' : this.upperBodyOnly ? 'trunk' : 'legs';
  }

  private showParts(): void {
    for (const { mesh, ends } of this.meshes) {
      const end = ends[this.lastPart];
      mesh.visible = this.shown !== 'nothing' && end > 0;
      // Meshes without a skin may share their geometry, and are drawn as a whole.
      if (end > 0) mesh.geometry.setDrawRange(0, end);
    }
  }

  private showLayers(): void {
    for (const { mesh, visibleTo } of this.meshes) {
      if (visibleTo === 'both') mesh.layers.set(0);
      else if (visibleTo === 'others') mesh.layers.set(this.firstPerson ? thirdPersonOnlyLayer : 0);
      else mesh.layers.set(this.firstPerson ? 0 : firstPersonOnlyLayer);
    }
  }
}
