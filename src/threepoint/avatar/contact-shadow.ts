import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  DynamicDrawUsage,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
} from 'three';
import { smoothstep } from '../core/math/damper';
import type { Vec3 } from '../core/math/vec3';

/** Half the width of a disc [m], and its darkness in the middle, 0 to 1. */
interface Disc {
  readonly reach: number;
  readonly darkness: number;
}

const underBody: Disc = { reach: 0.55, darkness: 0.6 };
const underFoot: Disc = { reach: 0.23, darkness: 0.8 };
/** The heights of an ankle between which the disc below it fades [m]. */
const standing = 0.12;
const lifted = 0.35;
/** The height above the floor [m]. */
const above = 0.006;

const corners = [
  [-1, -1],
  [-1, 1],
  [1, 1],
  [1, -1],
] as const;
const textureSize = 128;

/** Returns the texture of a disc that is dark in the middle and fades to its edge. */
function createDiscTexture(): DataTexture {
  const pixels = new Uint8Array(textureSize * textureSize * 4);
  for (let y = 0; y < textureSize; y++) {
    for (let x = 0; x < textureSize; x++) {
      const out = Math.hypot((x + 0.5) / textureSize - 0.5, (y + 0.5) / textureSize - 0.5) * 2;
      pixels.set([6, 9, 14, 255 * (1 - smoothstep(0, 1, out))], (y * textureSize + x) * 4);
    }
  }
  const texture = new DataTexture(pixels, textureSize, textureSize);
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  return texture;
}

/** The joints that a shadow lies under, floor frame [m]; none: head and hands without a body. */
type ShadowJoints = Readonly<Partial<Record<'hips' | 'leftFoot' | 'rightFoot', Vec3>>>;

/** A soft disc under a body and a smaller one under each foot, in one draw call: cheaper than a shadow map. */
export class ContactShadow {
  readonly object: Mesh<BufferGeometry, MeshBasicMaterial>;
  readonly #places = new Float32Array(3 * 3 * corners.length);
  readonly #colors = new Float32Array(3 * 4 * corners.length).fill(1);

  constructor() {
    const geometry = new BufferGeometry();
    const attribute = (values: Float32Array, size: number) =>
      new BufferAttribute(values, size).setUsage(DynamicDrawUsage);
    const uvs = [0, 1, 2].flatMap(() => corners.flatMap(([x, z]) => [(x + 1) / 2, (z + 1) / 2]));
    geometry.setAttribute('position', attribute(this.#places, 3));
    geometry.setAttribute('color', attribute(this.#colors, 4));
    geometry.setAttribute('uv', new BufferAttribute(Float32Array.from(uvs), 2));
    geometry.setIndex([0, 4, 8].flatMap((first) => [0, 1, 2, 0, 2, 3].map((corner) => first + corner)));
    const look = { transparent: true, depthWrite: false, toneMapped: false, vertexColors: true };
    this.object = new Mesh(geometry, new MeshBasicMaterial({ map: createDiscTexture(), ...look }));
    this.object.frustumCulled = false;
    this.object.position.y = above;
    this.object.renderOrder = 1;
  }

  setOpacity(opacity: number): void {
    this.object.material.opacity = opacity;
  }

  /** Lies under the joints of a body that is drawn so far aside, along X [m]. */
  follow({ hips, leftFoot, rightFoot }: ShadowJoints, aside = 0): void {
    this.#lay(0, underBody, hips, aside, 1);
    this.#lay(1, underFoot, leftFoot, aside, leftFoot ? 1 - smoothstep(standing, lifted, leftFoot.y) : 0);
    this.#lay(2, underFoot, rightFoot, aside, rightFoot ? 1 - smoothstep(standing, lifted, rightFoot.y) : 0);
    const { position, color } = this.object.geometry.attributes;
    position!.needsUpdate = true;
    color!.needsUpdate = true;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.map?.dispose();
    this.object.material.dispose();
  }

  #lay(disc: number, { reach, darkness }: Disc, under: Vec3 | undefined, aside: number, share: number): void {
    for (let corner = 0; corner < corners.length; corner++) {
      const [x, z] = corners[corner]!;
      const vertex = disc * corners.length + corner;
      this.#colors[4 * vertex + 3] = under ? darkness * share : 0;
      if (!under) continue;
      this.#places[3 * vertex] = under.x + aside + x * reach;
      this.#places[3 * vertex + 2] = under.z + z * reach;
    }
  }
}
