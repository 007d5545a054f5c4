import {
  BufferAttribute,
  BufferGeometry,
  Color,
  CylinderGeometry,
  DynamicDrawUsage,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  ShaderMaterial,
  Vector3,
} from 'three';
import { conjugate, distance, lerp, quat, rotate, subtract, type Vec3, vec3 } from 'threepoint/math';
import type { BowView } from 'threepoint-games/archery';
import type { Quality } from '../../scene/renderer';
import { bendLimb, limbPoints, limbRoot, type MutableLimbPoint, makeLimb, stringBow } from './limb-shape';

/** Corners of a cross-section. */
const sides = 10;

/** A rounded rectangle of half-extents 1: its corners and outward normals. */
const profile = Array.from({ length: sides }, (_, i) => {
  const angle = ((i + 0.5) / sides) * 2 * Math.PI;
  const blunt = (value: number) => Math.sign(value) * Math.abs(value) ** 0.55;
  return { x: blunt(Math.cos(angle)), z: blunt(Math.sin(angle)), nx: Math.cos(angle), nz: Math.sin(angle) };
});

/** One cross-section of a swept body, in the plane at right angles to its centre line. */
interface Section {
  readonly y: number;
  readonly z: number;
  readonly angle: number;
  readonly x: number;
  /** Half width (along x) and half depth [m]. */
  readonly halfWidth: number;
  readonly halfDepth: number;
  /** The colours of the side that faces the archer, and of the other side. */
  readonly belly: Color;
  readonly back: Color;
}

/** Writes a swept body into arrays of its size; `down` mirrors it at y = 0. */
function sweep(
  sections: readonly Section[],
  down: boolean,
  positions: Float32Array,
  normals: Float32Array,
  offset: number,
): void {
  const sign = down ? -1 : 1;
  let at = offset * 3;
  for (const { y, z, angle, x, halfWidth, halfDepth } of sections) {
    const sine = Math.sin(angle);
    const cosine = Math.cos(angle);
    for (const corner of profile) {
      const depth = corner.z * halfDepth;
      positions[at] = x + corner.x * halfWidth;
      positions[at + 1] = sign * (y - sine * depth);
      positions[at + 2] = z + cosine * depth;
      const nx = corner.nx / halfWidth;
      const nz = corner.nz / halfDepth;
      // Math.hypot allocates: the engine boxes its arguments.
      const long = Math.sqrt(nx * nx + nz * nz);
      normals[at] = nx / long;
      normals[at + 1] = (sign * -sine * nz) / long;
      normals[at + 2] = (cosine * nz) / long;
      at += 3;
    }
  }
}

/** Triangles between neighbouring sections. */
function sweepIndex(count: number, offset: number, down: boolean): number[] {
  const index: number[] = [];
  for (let section = 0; section + 1 < count; section++) {
    for (let side = 0; side < sides; side++) {
      const a = offset + section * sides + side;
      const b = offset + section * sides + ((side + 1) % sides);
      const c = a + sides;
      const d = b + sides;
      if (down) index.push(a, b, c, b, d, c);
      else index.push(a, c, b, b, c, d);
    }
  }
  return index;
}

function sweepColors(sections: readonly Section[]): number[] {
  return sections.flatMap(({ belly, back }) =>
    profile.flatMap(({ nz }) => (nz > 0.45 ? belly : nz < -0.45 ? back : maple).toArray()),
  );
}

const maple = new Color('#d8a866');
const walnut = new Color('#935c35');
const darkWalnut = new Color('#744525');
const horn = new Color('#efe6d2');
const leather = new Color('#2c2320');
const stitching = new Color('#c98f4a');

/** Returns a section of a limb, which tapers towards its tip of horn. */
const limbSection = (point: MutableLimbPoint, index: number): LimbSection => {
  const along = index / (limbPoints - 1);
  const tip = along > 0.93;
  return {
    ...point,
    x: 0,
    halfWidth: 0.021 - 0.0145 * along ** 1.4,
    halfDepth: 0.0085 - 0.0035 * along,
    belly: tip ? horn : walnut,
    back: tip ? horn : maple,
  };
};

/** The riser: a leather grip in the middle, swelling above and below it, cut away where the arrow passes. */
function riserSections(): Section[] {
  const count = 41;
  return Array.from({ length: count }, (_, i) => {
    const y = -limbRoot - 0.012 + ((2 * limbRoot + 0.024) * i) / (count - 1);
    const away = Math.abs(y) / limbRoot;
    const window = Math.exp(-(((y - 0.075) / 0.05) ** 4));
    const gripping = Math.exp(-((y / 0.062) ** 4));
    const swell = Math.exp(-(((Math.abs(y) - 0.13) / 0.055) ** 2));
    const grip = Math.abs(y) < 0.052;
    const stitched = grip && Math.abs(y) > 0.046;
    return {
      y,
      z: -0.012 * swell + 0.004 * gripping + 0.01 * Math.max(0, away - 0.75),
      angle: 0,
      x: 0.017 * window,
      halfWidth: 0.0205 - 0.0115 * window - 0.003 * gripping + 0.002 * swell,
      halfDepth: 0.012 + 0.013 * swell + 0.008 * gripping,
      belly: stitched ? stitching : grip ? leather : darkWalnut,
      back: stitched ? stitching : grip ? leather : Math.abs(away - 0.93) < 0.05 ? maple : walnut,
    };
  });
}

function sweptGeometry(bodies: readonly { sections: readonly Section[]; down: boolean }[]): BufferGeometry {
  const vertices = bodies.reduce((sum, { sections }) => sum + sections.length * sides, 0);
  const positions = new Float32Array(vertices * 3);
  const normals = new Float32Array(vertices * 3);
  const colors: number[] = [];
  const index: number[] = [];
  let offset = 0;
  for (const { sections, down } of bodies) {
    sweep(sections, down, positions, normals, offset);
    colors.push(...sweepColors(sections));
    index.push(...sweepIndex(sections.length, offset, down));
    offset += sections.length * sides;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3).setUsage(DynamicDrawUsage));
  geometry.setAttribute('normal', new BufferAttribute(normals, 3).setUsage(DynamicDrawUsage));
  geometry.setAttribute('color', new Float32BufferAttribute(colors, 3));
  geometry.setIndex(index);
  return geometry;
}

type LimbSection = Section & MutableLimbPoint;

/** A straight limb, to be bent. */
const makeLimbSections = (): readonly LimbSection[] => makeLimb().map(limbSection);

/** Creates the material of a cord along +Y. Its width on the screen is limited from about a pixel up. */
function createStringMaterial(color: string, thickness: number): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { color: { value: new Color(color) } },
    vertexShader: `varying float lit;
      void main() {
        vec4 middle = modelViewMatrix * vec4(0.0, position.y, 0.0, 1.0);
        vec3 outward = (modelViewMatrix * vec4(position.x, 0.0, position.z, 0.0)).xyz;
        float radius = clamp(-middle.z * 0.0009, 0.0006, 0.004) * ${thickness.toFixed(2)};
        vec3 up = (viewMatrix * vec4(0.35, 0.8, 0.5, 0.0)).xyz;
        lit = 0.72 + 0.28 * dot(outward, up);
        gl_Position = projectionMatrix * (middle + vec4(outward * radius, 0.0));
      }`,
    fragmentShader: `varying float lit; uniform vec3 color;
      void main() {
        gl_FragColor = vec4(color * lit, 1.0);
        #include <colorspace_fragment>
      }`,
  });
}

const yAxis = new Vector3(0, 1, 0);

const along = new Vector3();

/** Lays a unit cylinder along +Y between two points. */
function stretch(mesh: Mesh, from: Vec3, to: Vec3): void {
  along.set(to.x - from.x, to.y - from.y, to.z - from.z);
  const length = along.length();
  mesh.position.set((from.x + to.x) / 2, (from.y + to.y) / 2, (from.z + to.z) / 2);
  mesh.quaternion.setFromUnitVectors(yAxis, along.normalize());
  mesh.scale.set(1, length, 1);
}

/** Creates the meshes of the bow. The serving is the winding of the string at the nocking point. */
function createBowParts(quality: Quality, limbSections: readonly LimbSection[]) {
  const material =
    quality === 'high'
      ? new MeshStandardMaterial({ vertexColors: true, roughness: 0.42, metalness: 0 })
      : new MeshLambertMaterial({ vertexColors: true });
  const fibre = createStringMaterial('#f3efe4', 1);
  const cylinder = new CylinderGeometry(1, 1, 1, 6, 1, true);
  const limbGeometry = sweptGeometry([
    { sections: limbSections, down: false },
    { sections: limbSections, down: true },
  ]);
  const riser = new Mesh(sweptGeometry([{ sections: riserSections(), down: false }]), material);
  const limbs = new Mesh(limbGeometry, material);
  const upperString = new Mesh(cylinder, fibre);
  const lowerString = new Mesh(cylinder, fibre);
  const serving = new Mesh(cylinder, createStringMaterial('#3a2f2a', 1.6));
  const object = new Group();
  object.name = 'bow';
  object.add(riser, limbs, upperString, lowerString, serving);
  for (const mesh of object.children) {
    mesh.castShadow = mesh === riser || mesh === limbs;
    mesh.frustumCulled = false;
  }
  object.visible = false;
  return { object, riser, limbGeometry, upperString, lowerString, serving };
}

/**
 * The bow in the archer's hand, in the frame of its BowView (floor). A recurve bow of walnut, maple and horn.
 * braceHeight [m]: from the grip to the string at rest.
 */
export function createBow(quality: Quality, braceHeight: number) {
  const strung = stringBow(braceHeight);
  const sections = makeLimbSections();
  bendLimb(0, sections);
  const { object, riser, limbGeometry, upperString, lowerString, serving } = createBowParts(quality, sections);
  let bend = Number.NaN;
  const nock = vec3(0, 0, 0);
  const served = vec3(0, 0, 0);
  const fromBow = quat(0, 0, 0, 1);

  function bendLimbs(next: number): void {
    if (next === bend) return;
    bend = next;
    bendLimb(bend, sections);
    const position = limbGeometry.getAttribute('position') as BufferAttribute;
    const normal = limbGeometry.getAttribute('normal') as BufferAttribute;
    sweep(sections, false, position.array as Float32Array, normal.array as Float32Array, 0);
    sweep(sections, true, position.array as Float32Array, normal.array as Float32Array, sections.length * sides);
    position.needsUpdate = normal.needsUpdate = true;
  }

  return {
    object,
    /** null hides it. */
    show(view: BowView | null): void {
      object.visible = view !== null;
      if (!view) return;
      const { position, orientation } = view.bow;
      object.position.copy(position);
      object.quaternion.copy(orientation);
      // The arrow passes on the outer side of the hand: the window of a left-handed archer's bow is on the other side.
      riser.scale.x = view.bowSide === 'left' ? 1 : -1;
      rotate(conjugate(orientation, fromBow), subtract(view.nockPoint, position, nock), nock);
      bendLimbs(strung.bendFor(nock));
      const { upper, lower } = strung.tips(bend);
      stretch(upperString, upper, nock);
      stretch(lowerString, lower, nock);
      // The serving follows the upper half of the bent string.
      stretch(serving, lerp(nock, upper, 0.035 / distance(upper, nock), served), nock);
    },
  };
}
