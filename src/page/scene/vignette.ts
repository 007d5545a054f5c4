import { BackSide, Mesh, ShaderMaterial, SphereGeometry } from 'three';
import { showToEyesOnly } from 'threepoint/internal/three';
import { type Pose, smoothstep } from 'threepoint/math';

/** Seconds until the picture is whole again after a turn. */
const openingSeconds = 0.4;

/**
 * Darkens the edges of the picture for a moment. A turn that only the centre of the eye sees causes less motion
 * sickness.
 */
export function createVignette() {
  const material = new ShaderMaterial({
    side: BackSide,
    transparent: true,
    depthTest: false,
    depthWrite: false,
    fog: false,
    uniforms: { darkness: { value: 0 } },
    vertexShader: `varying vec3 direction;
      void main() {
        direction = position;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    // Clear within 18 degrees of the gaze, dark from 38 on.
    fragmentShader: `uniform float darkness;
      varying vec3 direction;
      void main() {
        float middle = -normalize(direction).z;
        gl_FragColor = vec4(0.0, 0.0, 0.0, darkness * (1.0 - smoothstep(0.788, 0.951, middle)));
      }`,
  });
  const object = new Mesh(new SphereGeometry(0.4, 24, 16), material);
  object.name = 'vignette';
  object.renderOrder = 10_000;
  object.frustumCulled = false;
  // In a mirror it would be a black ball for a head.
  showToEyesOnly(object);
  object.visible = false;
  let closedAt = Number.NEGATIVE_INFINITY;
  return {
    object,
    /** Darkens the edges from this time on [s]. */
    close(time: number): void {
      closedAt = time;
    },
    /** Places the vignette around these eyes, floor frame; null: hidden. */
    show(time: number, eyes: Pose<'floor'> | null): void {
      const darkness = 1 - smoothstep(0, openingSeconds, time - closedAt);
      material.uniforms.darkness!.value = darkness;
      object.visible = eyes !== null && darkness > 0;
      if (!eyes) return;
      object.position.copy(eyes.position);
      object.quaternion.copy(eyes.orientation);
    },
    /** How dark the edges are, 0 to 1. */
    get darkness(): number {
      return material.uniforms.darkness!.value as number;
    },
  };
}
