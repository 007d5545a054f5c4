import {
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  type Mesh,
  PMREMGenerator,
  type Scene,
  type WebGLRenderer,
  type WebGLRenderTarget,
} from 'three';
import { ContactShadow } from 'threepoint/internal/three';
import type { Vec3 } from 'threepoint/math';
import type { Quality } from '../scene/renderer';
import type { DistantLight, EstimatedLight, Lighting } from '../scene/surroundings';

/** The height of the key light's target above the floor [m]. */
const aimHeight = 0.9;
/** The blur of reflections [rad]. */
const reflectionBlur = 0.03;

function setLight(light: DirectionalLight, { color, intensity, from }: DistantLight): void {
  light.color.set(color);
  light.intensity = intensity;
  light.position.set(...from);
}

const scaled = ([x, y, z]: DistantLight['from'], by: number): DistantLight['from'] => [x * by, y * by, z * by];

/** The joints of a person that light and shadow follow, floor frame [m]. */
export type FollowedJoints = Readonly<Partial<Record<'hips' | 'leftFoot' | 'rightFoot', Vec3>>>;

/** The lights, the fog and the shadows of a scene. Each place sets the same objects. */
export class Lights {
  readonly #scene: Scene;
  readonly #renderer: WebGLRenderer;
  readonly #quality: Quality;
  /** The one light that throws shadows. */
  readonly #key = new DirectionalLight();
  readonly #rim = new DirectionalLight();
  readonly #front = new DirectionalLight();
  readonly #fill = new HemisphereLight();
  readonly #fog = new Fog(new Color());
  readonly #contact = new ContactShadow();
  /** The position of the body, floor frame [m]. */
  readonly #stand = { x: 0, z: 0 };
  #lighting: Lighting | null = null;
  #estimate: EstimatedLight | null = null;
  /** The environment that surfaces reflect; null: none yet, or low quality. */
  #reflections: WebGLRenderTarget | null = null;

  constructor(scene: Scene, renderer: WebGLRenderer, quality: Quality) {
    this.#scene = scene;
    this.#renderer = renderer;
    this.#quality = quality;
    this.#key.castShadow = quality === 'high';
    this.#key.shadow.bias = -0.0006;
    this.#key.shadow.normalBias = 0.015;
    scene.fog = this.#fog;
    // What nothing covers is haze.
    scene.background = this.#fog.color;
    scene.add(this.#contact.object, this.#key, this.#key.target, this.#rim, this.#front, this.#fill);
  }

  /** Moves light and shadow to a person, drawn so far aside, along X [m]. Without hips the light stays. */
  follow(joints: FollowedJoints, aside: number): void {
    const { hips } = joints;
    this.#contact.follow(joints, aside);
    if (!hips) return;
    this.#stand.x = hips.x + aside;
    this.#stand.z = hips.z;
    if (this.#lighting) this.#aimKey(this.#lighting);
  }

  /** Lights a place. Also rebuilds the graphics resources after a lost context. */
  set(lighting: Lighting): void {
    this.#lighting = lighting;
    this.#estimate = null;
    setLight(this.#key, lighting.key);
    setLight(this.#rim, lighting.rim);
    setLight(this.#front, lighting.front);
    this.#fill.color.set(lighting.fill.sky);
    this.#fill.groundColor.set(lighting.fill.ground);
    this.#fill.intensity = lighting.fill.intensity;
    this.#fog.color.set(lighting.fog.color);
    this.#fog.near = lighting.fog.near;
    this.#fog.far = lighting.fog.far;
    this.#contact.setOpacity(lighting.contactShadow);
    this.#aimKey(lighting);
    if (this.#quality === 'low') return;
    this.#setShadow(lighting);
    this.#setReflections(lighting);
  }

  /** Sets key and fill light to a device's estimate of its room; null: to the lighting of the place. */
  setEstimate(light: EstimatedLight | null): void {
    const lighting = this.#lighting;
    if (!lighting) return;
    this.#estimate = light;
    setLight(this.#key, lighting.key);
    this.#fill.color.set(lighting.fill.sky);
    this.#fill.intensity = lighting.fill.intensity;
    if (light) {
      this.#key.color.setRGB(...light.key);
      this.#fill.color.setRGB(...light.fill);
      this.#fill.intensity = 1;
    }
    this.#aimKey(lighting);
  }

  #aimKey({ key, shadow }: Lighting): void {
    const from = this.#estimate ? scaled(this.#estimate.from, Math.hypot(...key.from)) : key.from;
    const { x, z } = shadow.centre ?? this.#stand;
    this.#key.target.position.set(x, aimHeight, z);
    this.#key.position.set(x + from[0], from[1], z + from[2]);
  }

  #setShadow({ key, shadow: { halfSize, resolution, softness } }: Lighting): void {
    const { shadow } = this.#key;
    const { camera, mapSize } = shadow;
    camera.left = camera.bottom = -halfSize;
    camera.right = camera.top = halfSize;
    camera.near = 1;
    camera.far = 2 * Math.hypot(...key.from);
    camera.updateProjectionMatrix();
    shadow.radius = softness;
    if (mapSize.width === resolution) return;
    mapSize.set(resolution, resolution);
    // The next frame rebuilds the map in the new size.
    shadow.map?.dispose();
    shadow.map = null;
  }

  #setReflections({ environment, environmentIntensity }: Lighting): void {
    const generator = new PMREMGenerator(this.#renderer);
    const room = environment();
    // A target keeps its texture on the graphics device until it is disposed.
    this.#reflections?.dispose();
    this.#reflections = generator.fromScene(room, reflectionBlur);
    this.#scene.environment = this.#reflections.texture;
    this.#scene.environmentIntensity = environmentIntensity;
    generator.dispose();
    // Materials hold only shader programs, which the next place uses too.
    room.traverse((node) => (node as Mesh).geometry?.dispose());
  }
}
