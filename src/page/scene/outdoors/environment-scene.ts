import {
  BackSide,
  Color,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  SphereGeometry,
  type Vector3,
} from 'three';

/** Sky above, grass below, the sun at its place, as a bow's varnish or an avatar's eyes reflect them. */
export function createEnvironmentScene(sun: Vector3): Scene {
  const reflected = new Scene();
  const dome = new Mesh(
    new SphereGeometry(10, 24, 16),
    new ShaderMaterial({
      side: BackSide,
      uniforms: {
        sky: { value: new Color('#9cc6ee') },
        haze: { value: new Color('#eef3f0').multiplyScalar(1.15) },
        grass: { value: new Color('#5f7a35').multiplyScalar(0.7) },
      },
      vertexShader: `varying vec3 direction;
        void main() { direction = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
      fragmentShader: `varying vec3 direction; uniform vec3 sky; uniform vec3 haze; uniform vec3 grass;
        void main() {
          float height = normalize(direction).y;
          vec3 above = mix(haze, sky, smoothstep(0.0, 0.5, height));
          gl_FragColor = vec4(mix(grass, above, smoothstep(-0.06, 0.03, height)), 1.0);
        }`,
    }),
  );
  const disc = new Mesh(
    new PlaneGeometry(3.2, 3.2),
    new MeshBasicMaterial({ color: new Color('#fff2d8').multiplyScalar(11), side: 2 }),
  );
  disc.position.copy(sun).setLength(8);
  disc.lookAt(0, 0, 0);
  reflected.add(dome, disc);
  return reflected;
}
