import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, ShaderMaterial } from 'three';
import type { Arrow } from '../../core/games/archery/archery-state';
import { smoothstep } from '../../core/math/damper';
import { add, addScaled, cross, distance, normalise, scale, subtract, up, type Vec3 } from '../../core/math/vec3';
import { disposeTree } from '../../scene/dispose-tree';
import { arrowPose } from './arrow-pose';

/** Bright ribbons behind arrows in flight; arena frame. */
export interface Trails {
  readonly object: Mesh;
  /** At a time of the match [s], turned to eyes at `head`. */
  show(arrows: readonly Arrow[], time: number, head: Vec3): void;
  dispose(): void;
}

/** How long a trail lasts [s]: what lies further back has faded. */
const memory = 0.32;
const points = 20;
/** No archer has more arrows in the air. */
const most = 4;
const width = 0.034;

/** arrowLength [m]: the ribbon begins at the nock. */
export function createTrails(arrowLength: number): Trails {
  const positions = new BufferAttribute(new Float32Array(most * points * 2 * 3), 3).setUsage(DynamicDrawUsage);
  const strengths = new BufferAttribute(new Float32Array(most * points * 2), 1).setUsage(DynamicDrawUsage);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', positions);
  geometry.setAttribute('strength', strengths);
  const index: number[] = [];
  for (let trail = 0; trail < most; trail++) {
    for (let i = 0; i + 1 < points; i++) {
      const a = (trail * points + i) * 2;
      index.push(a, a + 1, a + 2, a + 1, a + 3, a + 2);
    }
  }
  geometry.setIndex(index);
  geometry.setDrawRange(0, 0);
  const material = new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    side: DoubleSide,
    fog: false,
    vertexShader: `attribute float strength; varying float alpha;
      void main() {
        alpha = strength;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `varying float alpha;
      void main() {
        gl_FragColor = vec4(1.0, 0.97, 0.85, alpha * alpha * 0.8);
        #include <colorspace_fragment>
      }`,
  });
  const object = new Mesh(geometry, material);
  object.name = 'trails';
  object.frustumCulled = false;
  object.renderOrder = 4;

  function lay(trail: number, arrow: Arrow, time: number, head: Vec3): void {
    const end = arrow.landing?.time ?? Number.POSITIVE_INFINITY;
    for (let i = 0; i < points; i++) {
      const share = i / (points - 1);
      const past = Math.max(arrow.release.time, Math.min(end - 1e-6, time - memory * share));
      const { tip, direction } = arrowPose(arrow, past);
      const middle = addScaled(tip, direction, -arrowLength);
      const across = normalise(cross(direction, subtract(middle, head)), up);
      const aside = scale(across, (width / 2) * (1 - 0.7 * share));
      const at = (trail * points + i) * 2;
      const left = add(middle, aside);
      const right = subtract(middle, aside);
      positions.setXYZ(at, left.x, left.y, left.z);
      positions.setXYZ(at + 1, right.x, right.y, right.z);
      // Right before the eyes a ribbon would be a veil.
      const strength = (1 - share) * smoothstep(0.9, 3, distance(middle, head));
      strengths.setX(at, strength);
      strengths.setX(at + 1, strength);
    }
  }

  return {
    object,
    show(arrows, time, head) {
      const flying = arrows
        .filter(({ release, landing }) => time >= release.time && (!landing || time < landing.time + memory))
        .slice(-most);
      flying.forEach((arrow, trail) => {
        lay(trail, arrow, time, head);
      });
      geometry.setDrawRange(0, flying.length * (points - 1) * 6);
      if (flying.length > 0) positions.needsUpdate = strengths.needsUpdate = true;
    },
    dispose() {
      object.removeFromParent();
      disposeTree(object);
    },
  };
}
