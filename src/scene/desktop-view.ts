import { PerspectiveCamera, Raycaster, Vector2, Vector3 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Pose } from '../core/math/pose';
import type { Vec3 } from '../core/math/vec3';

export const viewNames = ['third-person', 'front', 'first-person'] as const;
/** third-person: orbits the body from behind. front: from where the mirror hangs. first-person: through the eyes. */
export type ViewName = (typeof viewNames)[number];

/**
 * studio: mirror and body. range: past the archer to the targets. court: past a player to the others. stands: the whole court, from
 * aside; the camera may also be moved along.
 */
export type SceneName = 'studio' | 'range' | 'court' | 'stands';

interface Point {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}

/** Where the eyes are and where they look; floor frame. */
interface Eyes {
  readonly position: Point;
  readonly orientation: Point & { readonly w: number };
}

/** Parts of the window [CSS pixels] that the controls cover, so that the body is centred in what is left. */
export interface Insets {
  readonly left: number;
  readonly right: number;
  readonly bottom: number;
}

/** The camera of the desktop; in a session the headset moves the camera and this rests. */
export interface DesktopView {
  readonly camera: PerspectiveCamera;
  /** From where and whereto the camera looks. */
  readonly pose: Pose<'floor'>;
  readonly view: ViewName;
  setView(view: ViewName): void;
  /** Where the body stands: it decides from where it is seen best. */
  setScene(scene: SceneName): void;
  /** Whether mouse and touch turn the camera; arrow keys always do. */
  setOrbit(on: boolean): void;
  setInsets(insets: Insets): void;
  /** The window changed its size. */
  resize(): void;
  /** Back to where the view began. */
  recentre(): void;
  /** The ray through a point of the window (from −1 to 1, right and up); unit direction, floor frame. */
  rayThrough(x: number, y: number): { readonly origin: Vec3; readonly direction: Vec3 };
  /** Where the body is now (its pelvis and eyes, floor frame); elapsed [s] since the last call. */
  update(pelvis: Point, eyes: Eyes, elapsed: number): void;
}

/** Seconds in which the camera makes half the way to a body that walks. */
const followHalfLife = 0.35;
/** Radians a press of an arrow key turns the camera. */
const keyStep = Math.PI / 36;

/** Where the camera begins and what it looks at, both from the pelvis [m]. */
interface Outlook {
  readonly offset: Vector3;
  readonly aim: Vector3;
  readonly fov: number;
}

const start: Record<SceneName, Record<Exclude<ViewName, 'first-person'>, Outlook>> = {
  studio: {
    'third-person': { offset: new Vector3(1.95, 0.5, 2.95), aim: new Vector3(), fov: 42 },
    front: { offset: new Vector3(-0.55, 0.25, -3.2), aim: new Vector3(), fov: 42 },
  },
  range: {
    'third-person': { offset: new Vector3(-1.35, 0.95, 3.3), aim: new Vector3(0.15, -0.2, -2), fov: 46 },
    front: { offset: new Vector3(1.6, 0.35, -2.7), aim: new Vector3(), fov: 46 },
  },
  court: {
    'third-person': { offset: new Vector3(-0.8, 1.05, 3.5), aim: new Vector3(0.3, 0.12, -2.4), fov: 50 },
    front: { offset: new Vector3(-1.9, 0.6, -3.1), aim: new Vector3(), fov: 50 },
  },
  stands: {
    'third-person': { offset: new Vector3(4.6, 2.1, 4.6), aim: new Vector3(0.4, 0.15, 0), fov: 54 },
    front: { offset: new Vector3(-4.6, 1.7, -3.6), aim: new Vector3(0, -0.1, 0), fov: 50 },
  },
};
const firstPersonFov = 78;

/** Orbit by mouse, touch and arrow keys around the body, a front view, and the view through the body's own eyes. */
export function createDesktopView(canvas: HTMLCanvasElement): DesktopView {
  const camera = new PerspectiveCamera(42, 1, 0.05, 90);
  const controls = new OrbitControls(camera, canvas);
  controls.enableDamping = true;
  controls.dampingFactor = 0.12;
  controls.enablePan = false;
  controls.minDistance = 0.9;
  controls.maxDistance = 7;
  controls.minPolarAngle = 0.15;
  controls.maxPolarAngle = Math.PI / 2 + 0.12;
  const raycaster = new Raycaster();
  const target = new Vector3(0, 1, 0);
  let view: ViewName = 'third-person';
  let scene: SceneName = 'studio';
  let orbit = true;
  let insets: Insets = { left: 0, right: 0, bottom: 0 };

  function place(): void {
    if (view === 'first-person') return;
    const { offset: wide, aim, fov } = start[scene][view];
    const free = Math.max(1, window.innerWidth - insets.left - insets.right) / window.innerHeight;
    // A narrow window shows the mirror only where it stands behind the body.
    const offset = wide.clone();
    if (free < 0.8) offset.x *= 0.6;
    // A narrow window sees less to the sides: step back until the body and the mirror fit.
    const distance = Math.max(1, Math.min(1.35, 1 / Math.max(free, 0.1)));
    camera.fov = fov;
    camera.up.set(0, 1, 0);
    controls.target.copy(target).add(aim);
    camera.position.copy(target).addScaledVector(offset, distance);
    controls.update();
  }

  function project(): void {
    const width = window.innerWidth;
    const height = window.innerHeight;
    camera.aspect = width / height;
    const shiftX = view === 'first-person' ? 0 : (insets.right - insets.left) / 2;
    const shiftY = view === 'first-person' ? 0 : insets.bottom / 2;
    // What is left above a tall sheet of controls still holds the whole body.
    camera.zoom = view === 'first-person' ? 1 : Math.min(1, (1 - insets.bottom / height) / 0.75);
    camera.setViewOffset(width, height, shiftX, shiftY, width, height);
    camera.updateProjectionMatrix();
  }

  canvas.addEventListener('keydown', (event) => {
    if (view === 'first-person' || event.ctrlKey || event.metaKey || event.altKey) return;
    const arm = camera.position.clone().sub(controls.target);
    const right = new Vector3(0, 1, 0).cross(arm).normalize();
    const elevation = Math.asin(arm.y / arm.length());
    if (event.key === 'ArrowLeft') arm.applyAxisAngle(camera.up, -keyStep);
    else if (event.key === 'ArrowRight') arm.applyAxisAngle(camera.up, keyStep);
    else if (event.key === 'ArrowUp' && elevation < 1.3) arm.applyAxisAngle(right, -keyStep);
    else if (event.key === 'ArrowDown' && elevation > -0.1) arm.applyAxisAngle(right, keyStep);
    else if (event.key === '+' || event.key === '=') arm.multiplyScalar(0.92);
    else if (event.key === '-') arm.multiplyScalar(1.08);
    else return;
    event.preventDefault();
    camera.position.copy(controls.target).add(arm);
  });

  place();
  project();
  return {
    camera,
    get pose() {
      const { position, quaternion } = camera;
      return {
        position: { x: position.x, y: position.y, z: position.z },
        orientation: { x: quaternion.x, y: quaternion.y, z: quaternion.z, w: quaternion.w },
      };
    },
    rayThrough(x, y) {
      raycaster.setFromCamera(new Vector2(x, y), camera);
      const { origin, direction } = raycaster.ray;
      return { origin: { ...origin }, direction: { ...direction } };
    },
    get view() {
      return view;
    },
    setView(next) {
      view = next;
      controls.enabled = orbit && view !== 'first-person';
      if (view === 'first-person') camera.fov = firstPersonFov;
      place();
      project();
    },
    setScene(next) {
      scene = next;
      controls.enablePan = scene === 'stands';
      controls.maxDistance = scene === 'stands' ? 14 : 7;
      place();
      project();
    },
    setOrbit(on) {
      orbit = on;
      controls.enabled = orbit && view !== 'first-person';
    },
    setInsets(next) {
      insets = next;
      project();
    },
    resize: project,
    recentre: place,
    update(pelvis, eyes, elapsed) {
      if (view === 'first-person') {
        camera.position.set(eyes.position.x, eyes.position.y, eyes.position.z);
        camera.quaternion.set(eyes.orientation.x, eyes.orientation.y, eyes.orientation.z, eyes.orientation.w);
        return;
      }
      const part = 1 - 0.5 ** (elapsed / followHalfLife);
      const before = target.clone();
      target.x += (pelvis.x - target.x) * part;
      target.y += (pelvis.y - target.y) * part;
      target.z += (pelvis.z - target.z) * part;
      camera.position.add(target).sub(before);
      controls.target.add(target).sub(before);
      controls.update();
    },
  };
}
