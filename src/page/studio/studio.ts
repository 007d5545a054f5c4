import {
  BackSide,
  BoxGeometry,
  Color,
  Group,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  Scene,
  ShadowMaterial,
  type WebGLRenderer,
} from 'three';
import { uploadToGpu } from '../scene/gpu-upload';
import { hazeColor } from '../scene/outdoors/sky';
import type { Quality } from '../scene/renderer';
import type { EstimatedLight, Lighting, Surroundings } from '../scene/surroundings';
import { type FollowedJoints, Lights } from './lights';
import { createRoom } from './room/room';

const shadowSize = 12;
const shadowDarkness = 0.4;

/** Receives the shadow of the body on a floor that is not lit itself: it has its light from a map, or is a real one. */
function createShadowPlane(): Mesh {
  const material = new ShadowMaterial({ opacity: shadowDarkness, fog: false });
  const plane = new Mesh(new PlaneGeometry(shadowSize, shadowSize).rotateX(-Math.PI / 2), material);
  plane.name = 'shadow plane';
  plane.receiveShadow = true;
  return plane;
}

/**
 * The environment that surfaces reflect: plaster walls, a wooden floor, the windows, the veranda and the skylight. It
 * is never shown.
 */
function createLightRoom(): Scene {
  const light = new Scene();
  const add = (
    color: string,
    strength: number,
    geometry: PlaneGeometry | BoxGeometry,
    at: [number, number, number],
  ) => {
    const material = new MeshBasicMaterial({ color: new Color(color).multiplyScalar(strength), side: BackSide });
    const mesh = new Mesh(geometry, material);
    mesh.position.set(...at);
    light.add(mesh);
  };
  add('#e9ddca', 0.55, new BoxGeometry(6, 3, 6.2), [0, 0.3, 0.6]);
  add('#c49d74', 0.5, new PlaneGeometry(6, 6.2).rotateX(Math.PI / 2), [0, -1.19, 0.6]);
  for (const z of [-1.2, 1.6]) add('#e6f0ff', 7, new PlaneGeometry(1.9, 2).rotateY(-Math.PI / 2), [-2.98, 0.3, z]);
  add('#dfeccb', 4, new PlaneGeometry(3.8, 2.4), [0, 0, 3.68]);
  add('#f2f7ff', 9, new PlaneGeometry(1.4, 1.5).rotateX(-Math.PI / 2), [1.1, 1.78, 1]);
  return light;
}

/** The sun that comes in on the left lights people from the front: further round than it shines on the floor. */
const studioLighting = (quality: Quality): Lighting => ({
  key: { color: '#fff0da', intensity: quality === 'high' ? 1.9 : 1.8, from: [-2.7, 3.1, -2.3] },
  rim: { color: '#eef4ff', intensity: 1.5, from: [1.6, 2.7, 3.4] },
  front: { color: '#fff3e4', intensity: 0.55, from: [1.7, 1.6, -2.6] },
  fill: { sky: '#f4f1ea', ground: '#b08a66', intensity: quality === 'high' ? 0.7 : 1.15 },
  shadow: { halfSize: 1.7, resolution: 1024, softness: 5, centre: null },
  fog: { color: hazeColor, near: 16, far: 95 },
  environment: createLightRoom,
  environmentIntensity: 0.5,
  contactShadow: quality === 'high' ? 0.3 : 0.7,
});

/**
 * Creates the studio around the people: a room with its light and shadow. The floor is y = 0 of the floor frame. The
 * garden before its windows comes with `openWindows`.
 */
export function createStudio(renderer: WebGLRenderer, quality: Quality) {
  const scene = new Scene();
  const lights = new Lights(scene, renderer, quality);
  const shadowPlane = quality === 'high' ? createShadowPlane() : null;
  const studio = new Group();
  studio.add(createRoom(quality));
  const studioPlace: Surroundings = { object: studio, scenery: [], lighting: studioLighting(quality) };
  scene.add(studio);
  if (shadowPlane) scene.add(shadowPlane);
  lights.set(studioPlace.lighting);
  let place = studioPlace;
  let layer = 0;
  let windows: Promise<void> | null = null;
  let realFloor: number | null = null;

  function showShadowPlane(): void {
    if (!shadowPlane) return;
    shadowPlane.visible = realFloor !== null || place === studioPlace;
    shadowPlane.position.y = (realFloor ?? 0) + 0.003;
  }
  showShadowPlane();

  async function addGarden(): Promise<void> {
    const { createGarden } = await import('./room/garden');
    const garden = createGarden(quality);
    await uploadToGpu(renderer, scene, garden);
    garden.traverse((node) => node.layers.set(layer));
    studio.add(garden);
  }

  /** Loads the garden before the windows, once and only where the studio is shown. Until then there is haze. */
  async function openWindows(): Promise<void> {
    if (place !== studioPlace) return;
    windows ??= addGarden();
    await windows;
  }

  return {
    scene,
    /** The studio's objects, which other surroundings replace. */
    home: studio,
    get surroundings(): Surroundings {
      return place;
    },
    /** Sets the light to a device's estimate of its room; null: to the lighting of the surroundings. */
    setEstimatedLight: (light: EstimatedLight | null): void => lights.setEstimate(light),
    /** Moves shadow and light to a person, drawn so far aside, along X [m]. Without hips the light stays. */
    follow: (joints: FollowedJoints, aside = 0): void => lights.follow(joints, aside),
    openWindows,
    /** Shows the studio on this layer only. */
    setLayer(onLayer: number): void {
      layer = onLayer;
      studio.traverse((node) => node.layers.set(layer));
    },
    /** Receives shadows on a real floor at this height [m]; null: on the floor of the studio. */
    setRealFloor(height: number | null): void {
      realFloor = height;
      showShadowPlane();
    },
    /** Replaces the studio by another place with its light and fog; null: shows the studio again. */
    setSurroundings(surroundings: Surroundings | null): void {
      const next = surroundings ?? studioPlace;
      if (next === place) return;
      scene.remove(place.object);
      scene.add(next.object);
      place = next;
      showShadowPlane();
      lights.set(next.lighting);
      void openWindows();
    },
    /** Rebuilds the graphics resources after a lost context. */
    restore: (): void => lights.set(place.lighting),
  };
}

export type Studio = ReturnType<typeof createStudio>;
