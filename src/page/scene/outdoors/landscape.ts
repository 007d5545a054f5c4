import {
  BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  IcosahedronGeometry,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Vector3,
} from 'three';
import { clamp } from 'threepoint/math';
import { merged, painted } from '../painted-geometry';
import { createRandomRange } from '../random-range';
import type { Quality } from '../renderer';
import { hazeColor } from './sky';

/**
 * A far silhouette all round: radius and height [m], its colour at the top; towards its foot it sinks into the haze.
 */
interface Ridge {
  readonly radius: number;
  readonly height: number;
  readonly color: string;
  /** Waves round the horizon, and how jagged its edge is. */
  readonly waves: number;
  readonly ragged: number;
  readonly phase: number;
}

const ridges: readonly Ridge[] = [
  { radius: 80, height: 11, color: '#a9c3d3', waves: 7, ragged: 0.05, phase: 0.4 },
  { radius: 72, height: 6.5, color: '#8fb0a8', waves: 5, ragged: 0.04, phase: 2.1 },
  { radius: 64, height: 3.7, color: '#6f9873', waves: 9, ragged: 0.32, phase: 4.4 },
];

function ridgeGeometry({ radius, height, color, waves, ragged, phase }: Ridge, seed: number): BufferGeometry {
  const segments = 240;
  const random = createRandomRange(seed);
  const top = new Color(color);
  const foot = new Color(color).lerp(new Color(hazeColor), 0.6);
  const positions: number[] = [];
  const colors: number[] = [];
  const heights = Array.from({ length: segments }, (_, i) => {
    const angle = (i / segments) * 2 * Math.PI;
    const rolling =
      0.55 + 0.26 * Math.sin(waves * angle + phase) + 0.14 * Math.sin((2 * waves + 1) * angle + 2 * phase);
    return height * rolling + ragged * random(-1, 1.4);
  });
  const corner = (i: number, atTop: boolean) => {
    const angle = (i / segments) * 2 * Math.PI;
    positions.push(
      Math.sin(angle) * radius,
      atTop ? (heights[i % segments] as number) : -0.5,
      Math.cos(angle) * radius,
    );
    colors.push(...(atTop ? top : foot).toArray());
  };
  for (let i = 0; i < segments; i++) {
    for (const [step, atTop] of [
      [0, false],
      [0, true],
      [1, true],
      [0, false],
      [1, true],
      [1, false],
    ] as const)
      corner(i + step, atTop);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  geometry.setAttribute('color', new Float32BufferAttribute(colors, 3));
  return geometry;
}

/** Leaves catch light above and keep it from what is below. */
function foliage(geometry: BufferGeometry, color: Color, low: number, high: number): BufferGeometry {
  const shade = color.clone().multiplyScalar(0.55);
  const lit = color.clone().lerp(new Color('#d9e07c'), 0.16);
  return painted(geometry, (_x, y, _z, paint) => {
    paint.copy(shade).lerp(lit, clamp((y - low) / (high - low), 0, 1));
  });
}

/** Returns a ball with displaced corners, equal where faces meet. */
function lump(radius: number, detail: number, random: () => number): BufferGeometry {
  const geometry = new IcosahedronGeometry(radius, detail);
  const position = geometry.getAttribute('position');
  const pushed = new Map<string, number>();
  const corner = new Vector3();
  for (let i = 0; i < position.count; i++) {
    corner.fromBufferAttribute(position, i);
    const key = corner
      .toArray()
      .map((value) => Math.round(value * 1000))
      .join();
    const push = pushed.get(key) ?? 0.84 + 0.32 * random();
    pushed.set(key, push);
    corner.multiplyScalar(push);
    position.setXYZ(i, corner.x, corner.y * 0.92, corner.z);
  }
  // Between a crystal, which is a face's own normal, and a balloon, which is that of a ball.
  geometry.computeVertexNormals();
  const normal = geometry.getAttribute('normal');
  const blended = new Vector3();
  for (let i = 0; i < position.count; i++) {
    corner.fromBufferAttribute(position, i).normalize();
    blended.fromBufferAttribute(normal, i).lerp(corner, 0.6).normalize();
    normal.setXYZ(i, blended.x, blended.y, blended.z);
  }
  return geometry;
}

function tree(
  x: number,
  z: number,
  height: number,
  random: (low?: number, high?: number) => number,
  detail: number,
): BufferGeometry[] {
  const trunk = painted(
    new CylinderGeometry(0.022 * height, 0.04 * height, 0.42 * height, 6, 1, true).translate(x, 0.2 * height, z),
    random() < 0.3 ? '#9b8f80' : '#6d5542',
  );
  if (random() < 0.3) {
    const color = new Color().setHSL(random(0.34, 0.4), random(0.26, 0.36), random(0.2, 0.27));
    return [
      trunk,
      ...[0, 1, 2].map((layer) => {
        const wide = height * (0.24 - 0.055 * layer);
        const at = height * (0.34 + 0.24 * layer);
        const cone = new ConeGeometry(wide, height * 0.42, 9, 1).rotateY(random(0, 3)).translate(x, at, z);
        return foliage(cone, color, at - 0.2 * height, at + 0.25 * height);
      }),
    ];
  }
  const color = new Color().setHSL(random(0.225, 0.32), random(0.4, 0.52), random(0.25, 0.33));
  const lumps = Array.from({ length: 3 + Math.floor(random(0, 2)) }, (_, i) => {
    const radius = height * random(0.17, 0.25) * (i === 0 ? 1.3 : 1);
    const angle = random(0, 2 * Math.PI);
    const out = i === 0 ? 0 : height * random(0.13, 0.2);
    return lump(radius, detail, random).translate(
      x + Math.cos(angle) * out,
      height * (i === 0 ? 0.62 : random(0.5, 0.78)),
      z + Math.sin(angle) * out,
    );
  });
  return [trunk, ...lumps.map((geometry) => foliage(geometry, color, height * 0.3, height))];
}

/** Builds the trees: a wood behind the backstop, lines along both sides, a few behind the archer. */
function treeGeometry(quality: Quality): BufferGeometry {
  const random = createRandomRange(20231);
  const detail = quality === 'high' ? 2 : 1;
  const parts: BufferGeometry[] = [];
  const plant = (x: number, z: number, height: number, fine = detail) =>
    parts.push(...tree(x, z, height, random, fine));
  const inWood = quality === 'high' ? 34 : 22;
  for (let i = 0; i < inWood; i++) {
    const x = -27 + (54 * (i + random(0.1, 0.9))) / inWood;
    plant(x, -random(24, 33) + Math.abs(x) * 0.22, random(4, 7), detail - 1);
  }
  for (const side of [-1, 1]) {
    const count = quality === 'high' ? 9 : 6;
    for (let i = 0; i < count; i++) {
      plant(side * random(11, 19), -17 + (36 * (i + random(0.1, 0.9))) / count, random(3.6, 6.4));
    }
  }
  for (let i = 0; i < 9; i++)
    plant(-18 + 36 * ((i + random(0.2, 0.8)) / 9), random(17, 27), random(4.2, 6.8), detail - 1);
  for (let i = 0; i < (quality === 'high' ? 46 : 18); i++) {
    // Bushes.
    const side = random() < 0.5 ? -1 : 1;
    const radius = random(0.35, 0.9);
    const x = side * random(7.4, 13);
    const z = random(-19, 7);
    const color = new Color().setHSL(random(0.25, 0.33), random(0.4, 0.52), random(0.22, 0.3));
    parts.push(
      foliage(
        lump(radius, detail, random)
          .scale(1.25, 0.8, 1.1)
          .translate(x, radius * 0.35, z),
        color,
        0,
        radius,
      ),
    );
  }
  return merged(parts);
}

/** Hills, a wood and bushes around the field. Arena frame. */
export function createLandscape(quality: Quality): Group {
  const landscape = new Group();
  landscape.name = 'landscape';
  const far = new MeshBasicMaterial({ vertexColors: true, side: DoubleSide, fog: false, toneMapped: false });
  far.onBeforeCompile = (shader) => {
    // A mirror's tilted near plane tilts its far plane too: what is far away must not be cut off by it.
    shader.vertexShader = shader.vertexShader.replace(
      '#include <project_vertex>',
      '#include <project_vertex>\ngl_Position.z = min(gl_Position.z, 0.9999 * gl_Position.w);',
    );
  };
  const hills = new Mesh(merged(ridges.map((ridge, index) => ridgeGeometry(ridge, 31 + index))), far);
  hills.renderOrder = -1;
  const trees = new Mesh(treeGeometry(quality), new MeshLambertMaterial({ vertexColors: true }));
  // No shadow reaches them; they are drawn together with what receives shadows.
  trees.receiveShadow = true;
  landscape.add(hills, trees);
  return landscape;
}
