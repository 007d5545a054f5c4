import {
  BoxGeometry,
  type BufferGeometry,
  Color,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  ShaderMaterial,
} from 'three';
import { doubleSided } from '../../scene/double-sided';
import { merged, paintedBox } from '../../scene/painted-geometry';
import { field } from './field';

const { width, depth } = field.zone;
const fenceHeight = 0.42;

/** Boards with gaps, sunk into the grass. */
function deck(): BufferGeometry {
  const count = 8;
  const board = width / count;
  const tones = ['#c2a57e', '#b89a72', '#c9ae88', '#b3946b'] as const;
  const boards = Array.from({ length: count }, (_, i) =>
    paintedBox(
      [board - 0.008, 0.02, depth],
      [-width / 2 + (i + 0.5) * board, -0.006, 0],
      tones[(i * 3) % tones.length]!,
    ),
  );
  const bed = paintedBox([width + 0.1, 0.012, depth + 0.1], [0, -0.004, 0], '#4b3d2d');
  return merged([bed, ...boards]);
}

/** Four bars along the edge, `thick` wide, inside of it. */
function border(thick: number): BufferGeometry {
  const bar = (w: number, d: number, x: number, z: number) => new BoxGeometry(w, 0.004, d).translate(x, 0.006, z);
  return merged([
    bar(width, thick, 0, (depth - thick) / 2),
    bar(width, thick, 0, (thick - depth) / 2),
    bar(thick, depth - 2 * thick, (width - thick) / 2, 0),
    bar(thick, depth - 2 * thick, (thick - width) / 2, 0),
  ]);
}

/** Stripes that lean and fade upwards. */
function createFence(): Mesh<BufferGeometry, ShaderMaterial> {
  const wall = (length: number, turn: number, x: number, z: number) =>
    new PlaneGeometry(length, fenceHeight).rotateY(turn).translate(x, fenceHeight / 2, z);
  const walls = merged([
    wall(width, 0, 0, depth / 2),
    wall(width, Math.PI, 0, -depth / 2),
    wall(depth, Math.PI / 2, width / 2, 0),
    wall(depth, -Math.PI / 2, -width / 2, 0),
  ]);
  const material = new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    ...doubleSided,
    fog: false,
    uniforms: {
      pulse: { value: 1 },
      bright: { value: new Color('#ff9e1a') },
      dark: { value: new Color('#170f05') },
    },
    vertexShader: `varying vec3 at;
      void main() {
        at = position;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `varying vec3 at; uniform float pulse; uniform vec3 bright; uniform vec3 dark;
      void main() {
        float along = (at.x - at.z + at.y) * 9.0;
        float edge = fwidth(along);
        float wave = abs(fract(along * 0.5) - 0.5) * 2.0;
        float stripe = smoothstep(0.5 - edge, 0.5 + edge, wave);
        float fade = 1.0 - at.y / ${fenceHeight.toFixed(3)};
        vec3 color = mix(dark, bright, stripe);
        gl_FragColor = vec4(color, fade * mix(0.35, 0.85, stripe) * pulse);
        #include <colorspace_fragment>
      }`,
  });
  const fence = new Mesh(walls, material);
  fence.renderOrder = 3;
  return fence;
}

/** The mark on the floor where the archer stands. Arena frame, about its origin. */
export function createZone() {
  const object = new Group();
  object.name = 'zone';
  const boards = new Mesh(deck(), new MeshLambertMaterial({ vertexColors: true }));
  boards.receiveShadow = true;
  const calm = new Mesh(border(0.03), new MeshLambertMaterial({ color: '#f7f4ea' }));
  calm.receiveShadow = true;
  const alarmed = new Mesh(border(0.06), new MeshBasicMaterial({ color: '#ff9d1f' }));
  const fence = createFence();
  alarmed.visible = fence.visible = false;
  object.add(boards, calm, alarmed, fence);
  return {
    object,
    /**
     * Warns that the archer has left the zone: the border turns orange and thicker, and a striped fence rises along it.
     */
    setWarning(on: boolean): void {
      calm.visible = !on;
      alarmed.visible = fence.visible = on;
    },
    /** Lets the warning pulse; time [s]. */
    animate(time: number): void {
      (fence.material.uniforms.pulse as { value: number }).value = 0.8 + 0.2 * Math.cos(time * 2 * Math.PI);
    },
  };
}
