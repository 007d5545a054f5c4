import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, ShaderMaterial } from 'three';
import {
  add,
  addScaled,
  cross,
  distance,
  normalise,
  scale,
  smoothstep,
  subtract,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import type { Arrow } from 'threepoint-games/archery';
import { doubleSided } from '../../scene/double-sided';
import { arrowPose, makeArrowPose } from './arrow-pose';

/** The duration of a trail [s], after which it has faded. */
const memory = 0.32;
const points = 20;
/** No archer has more arrows in the air. */
const most = 4;
const width = 0.034;

/** Creates the material of a trail: white, with the opacity of each vertex's strength. */
const trailMaterial = (): ShaderMaterial =>
  new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    ...doubleSided,
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

/** Bright ribbons behind arrows in flight; arena frame. arrowLength [m]: the ribbon begins at the nock. */
export function createTrails(arrowLength: number) {
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
  const material = trailMaterial();
  const object = new Mesh(geometry, material);
  object.name = 'trails';
  object.frustumCulled = false;
  object.renderOrder = 4;

  const pose = makeArrowPose();
  const middle = vec3(0, 0, 0);
  const aside = vec3(0, 0, 0);
  const edge = vec3(0, 0, 0);

  function lay(trail: number, arrow: Arrow, time: number, head: Vec3): void {
    const end = arrow.landing?.time ?? Number.POSITIVE_INFINITY;
    for (let i = 0; i < points; i++) {
      const share = i / (points - 1);
      const past = Math.max(arrow.release.time, Math.min(end - 1e-6, time - memory * share));
      const { tip, direction } = arrowPose(arrow, past, pose);
      addScaled(tip, direction, -arrowLength, middle);
      normalise(cross(direction, subtract(middle, head, aside), aside), up, aside);
      scale(aside, (width / 2) * (1 - 0.7 * share), aside);
      const at = (trail * points + i) * 2;
      add(middle, aside, edge);
      positions.setXYZ(at, edge.x, edge.y, edge.z);
      subtract(middle, aside, edge);
      positions.setXYZ(at + 1, edge.x, edge.y, edge.z);
      // A ribbon close to the eyes would cover the view.
      const strength = (1 - share) * smoothstep(0.9, 3, distance(middle, head));
      strengths.setX(at, strength);
      strengths.setX(at + 1, strength);
    }
  }

  return {
    object,
    /** Shows the trails at a match time [s], turned to eyes at `head`. */
    show(arrows: readonly Arrow[], time: number, head: Vec3): void {
      let trails = 0;
      for (let i = arrows.length - 1; i >= 0 && trails < most; i--) {
        const arrow = arrows[i]!;
        if (time < arrow.release.time || (arrow.landing && time >= arrow.landing.time + memory)) continue;
        lay(trails, arrow, time, head);
        trails += 1;
      }
      geometry.setDrawRange(0, trails * (points - 1) * 6);
      if (trails > 0) positions.needsUpdate = strengths.needsUpdate = true;
    },
  };
}
