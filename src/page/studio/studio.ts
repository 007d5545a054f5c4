import {
  BackSide,
  CircleGeometry,
  Color,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  RingGeometry,
  Scene,
  ShaderMaterial,
  SphereGeometry,
  type WebGLRenderer,
} from 'three';
import type { Quality } from '../scene/renderer';
import type { EstimatedLight, Lighting, Surroundings } from '../scene/surroundings';
import { Lights } from './lights';

const horizon = new Color('#3a475d');
const zenith = new Color('#121722');
const ground = new Color('#1c2431');
const floorRadius = 24;

/**
 * A level square about the origin. Its vertices lie far from where heads are: one right below a level camera has w = 0,
 * and SwiftShader clips the triangles of such a vertex wrongly.
 */
const levelSquare = (size: number) => new PlaneGeometry(size, size).rotateX(-Math.PI / 2);

/** Creates the sky, a sphere that is darker overhead. It is drawn behind everything and without fog. */
function createSky(): Mesh {
  const material = new ShaderMaterial({
    side: BackSide,
    depthWrite: false,
    depthTest: false,
    fog: false,
    uniforms: { horizon: { value: horizon }, zenith: { value: zenith } },
    vertexShader: `varying vec3 direction;
      void main() {
        direction = normalize(position);
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        // A mirror's tilted near plane tilts its far plane too: the sky must not depend on it.
        gl_Position.z = 0.0;
      }`,
    fragmentShader: `varying vec3 direction; uniform vec3 horizon; uniform vec3 zenith;
      void main() {
        float height = max(normalize(direction).y, 0.0);
        gl_FragColor = vec4(mix(horizon, zenith, smoothstep(0.0, 0.5, height)), 1.0);
        // Fog is not tone-mapped; neither is what it fades into.
        #include <colorspace_fragment>
      }`,
  });
  const sky = new Mesh(new SphereGeometry(40, 24, 16), material);
  sky.renderOrder = -1;
  return sky;
}

/** Creates lines every half metre, which fade with distance and are antialiased by their derivatives. */
function createGrid(): Mesh {
  const material = new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    fog: false,
    uniforms: { lineColor: { value: new Color('#8fa3c2') } },
    vertexShader: `varying vec3 onFloor;
      void main() {
        vec4 world = modelMatrix * vec4(position, 1.0);
        onFloor = world.xyz;
        gl_Position = projectionMatrix * viewMatrix * world;
      }`,
    fragmentShader: `varying vec3 onFloor; uniform vec3 lineColor;
      float lines(vec2 at) {
        vec2 width = fwidth(at);
        vec2 distanceToLine = abs(fract(at - 0.5) - 0.5) / max(width, vec2(1e-5));
        vec2 strength = (1.0 - min(distanceToLine, 1.0)) * (1.0 - smoothstep(0.15, 0.6, width));
        return max(strength.x, strength.y);
      }
      void main() {
        float fade = 1.0 - smoothstep(1.5, 9.0, length(onFloor.xz));
        float alpha = (0.10 * lines(onFloor.xz * 2.0) + 0.16 * lines(onFloor.xz)) * fade;
        gl_FragColor = vec4(lineColor, alpha);
        #include <colorspace_fragment>
      }`,
  });
  const grid = new Mesh(levelSquare(18), material);
  grid.position.y = 0.002;
  return grid;
}

/**
 * Creates the floor. Lambert is matt, and compiles in a third of the time where shaders are compiled for a processor.
 */
function createFloor(): Mesh {
  const floor = new Mesh(levelSquare(2 * floorRadius), new MeshLambertMaterial({ color: ground }));
  floor.receiveShadow = true;
  return floor;
}

/** Creates the mark where to stand: a ring with a notch towards the mirror (−Z). */
function createMark(): Group {
  const material = new MeshBasicMaterial({ color: '#ffb468', transparent: true, opacity: 0.55, depthWrite: false });
  const gap = 0.5;
  const ring = new Mesh(new RingGeometry(0.4, 0.412, 72, 1, Math.PI / 2 + gap / 2, 2 * Math.PI - gap), material);
  const arrow = new Mesh(new CircleGeometry(0.035, 3, Math.PI / 2), material);
  arrow.position.y = 0.41;
  const mark = new Group();
  mark.add(ring, arrow);
  mark.rotation.x = -Math.PI / 2;
  mark.position.y = 0.004;
  return mark;
}

/** The environment that surfaces reflect: a bright ceiling panel, a warm side, a cool back. It is never shown. */
function createLightRoom(): Scene {
  const room = new Scene();
  room.background = new Color('#2a3342');
  const panel = (color: string, intensity: number, width: number, height: number, at: [number, number, number]) => {
    const mesh = new Mesh(
      new PlaneGeometry(width, height),
      new MeshBasicMaterial({ color: new Color(color).multiplyScalar(intensity), side: 2 }),
    );
    mesh.position.set(...at);
    mesh.lookAt(0, 0, 0);
    room.add(mesh);
  };
  panel('#ffffff', 9, 5, 5, [0, 6, 0]);
  panel('#ffd9b0', 5, 3, 5, [5, 2.5, 2]);
  panel('#a9c4ff', 4, 3, 5, [-5, 2, 1]);
  panel('#c8d6f0', 2.5, 6, 3, [0, 2, -6]);
  panel('#2b3647', 1, 14, 14, [0, -3, 0]);
  return room;
}

const studioLighting = (quality: Quality): Lighting => ({
  key: { color: '#fff1e0', intensity: quality === 'high' ? 2.6 : 2.8, from: [1.6, 4.2, 1.9] },
  rim: { color: '#b4caff', intensity: 1, from: [-2.4, 2.6, -2.8] },
  front: { color: '#eef2ff', intensity: 0.7, from: [-1.2, 1.8, -2.5] },
  fill: { sky: '#cfdcf5', ground: '#3a4354', intensity: quality === 'high' ? 0.35 : 1.1 },
  shadow: { halfSize: 1.7, resolution: 1024, softness: 5, centre: null },
  fog: { color: '#3a475d', near: 3, far: floorRadius - 6 },
  environment: createLightRoom,
  environmentIntensity: 0.38,
  contactShadow: quality === 'high' ? 0.45 : 0.7,
});

/**
 * Creates the studio around the people: floor, sky, light and shadow, without loading files. The floor is y = 0 of the
 * floor frame.
 */
export function createStudio(renderer: WebGLRenderer, quality: Quality) {
  const scene = new Scene();
  scene.background = null;
  const lights = new Lights(scene, renderer, quality);
  const mark = createMark();
  const studio = new Group();
  studio.add(createSky(), createFloor(), createGrid(), mark);
  const studioPlace: Surroundings = { object: studio, scenery: [], lighting: studioLighting(quality) };
  scene.add(studio);
  lights.set(studioPlace.lighting);
  let place = studioPlace;
  return {
    scene,
    /** The studio's objects, which other surroundings replace. */
    home: studio,
    get surroundings(): Surroundings {
      return place;
    },
    /** Sets the light to a device's estimate of its room; null: to the lighting of the surroundings. */
    setEstimatedLight: (light: EstimatedLight | null): void => lights.setEstimate(light),
    /** Moves shadow and light to the person at (x, z) [m], floor frame. */
    follow: (x: number, z: number): void => lights.follow(x, z),
    /** Shows or hides the mark on the floor of the studio where to stand. */
    setMarkVisible(visible: boolean): void {
      mark.visible = visible;
    },
    /** Replaces the studio by another place with its light and fog; null: shows the studio again. */
    setSurroundings(surroundings: Surroundings | null): void {
      const next = surroundings ?? studioPlace;
      if (next === place) return;
      scene.remove(place.object);
      scene.add(next.object);
      place = next;
      lights.set(next.lighting);
    },
    /** Rebuilds the graphics resources after a lost context. */
    restore: (): void => lights.set(place.lighting),
  };
}

export type Studio = ReturnType<typeof createStudio>;
