import { PerspectiveCamera, Raycaster, Vector2, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { type Pose, type Ray, smoothingFactor, type Vec3 } from 'threepoint/math';

export const viewNames = ['front', 'third-person', 'first-person'] as const;
/** front: orbits the body from the front. third-person: from behind, with what lies ahead. first-person: the eyes. */
export type ViewName = (typeof viewNames)[number];

/** Distances of the part that is left to the picture from the window's edges [CSS pixels]. */
export interface Insets {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
}

/** Half-life of the camera's motion towards the body [s]. */
const followHalfLife = 0.35;
/** A body up to this height [m] fits into the initial view. */
const tallest = 1.95;
/** The height of the pelvis of a standing person [m]. */
const pelvisHeight = 1;
/** The share of the picture's height that a body takes at most. */
const bodyShare = 0.94;
/** The width of a body with lowered arms as a share of its height. */
const bodyWidth = 0.45;
/** Radians a press of an arrow key turns the camera. */
const keyStep = Math.PI / 36;

/** A start of the camera and the point that it looks at, both from the pelvis [m]. */
interface CameraStart {
  readonly offset: Vec3;
  readonly aim: Vec3;
  readonly fovDegrees: number;
  /** What stays in sight above the body [m]; default 0. */
  readonly headroom?: number;
  /** What stays in sight to the left and right, as the tangent of its angle; absent: the whole body does. */
  readonly sides?: number;
}

/** The starts of the camera in one place. */
export interface CameraScene extends Readonly<Record<Exclude<ViewName, 'first-person'>, CameraStart>> {
  /** The view until another one is chosen; default third-person. */
  readonly initial?: ViewName;
  /** How far from the point that it looks at the camera may move [m]; default 7. */
  readonly maxDistance?: number;
  /** The camera may be moved anywhere, and not only about the body. */
  readonly free?: boolean;
}

/** The base of the neck, from the pelvis [m]: the camera turns about it and zooms to it. */
const neckBase: Vec3 = { x: 0, y: 0.6, z: 0 };
/** How far from the start of a view the point that the camera looks at may be moved [m]. */
const panRadius = 0.9;

/** The body in front of the mirror. The room ends 3 m from the body. */
export const studioScene: CameraScene = {
  front: { offset: { x: 1.15, y: 0.42, z: -2.25 }, aim: neckBase, fovDegrees: 44 },
  'third-person': { offset: { x: 1.05, y: 0.6, z: 2.4 }, aim: neckBase, fovDegrees: 50 },
  initial: 'front',
  maxDistance: 2.7,
};
const firstPersonFov = 78;

const up = new Vector3(0, 1, 0);

function createControls(camera: PerspectiveCamera, canvas: HTMLCanvasElement): OrbitControls {
  const controls = new OrbitControls(camera, canvas);
  controls.enableDamping = true;
  controls.dampingFactor = 0.12;
  controls.minDistance = 0.5;
  controls.minPolarAngle = 0.15;
  controls.maxPolarAngle = Math.PI / 2 + 0.12;
  return controls;
}

/**
 * Turns the arm that holds the camera by an arrow key, or changes its length by plus and minus; false: the key means
 * nothing here.
 */
function moveArm(arm: Vector3, key: string): boolean {
  const right = new Vector3().crossVectors(up, arm).normalize();
  const elevation = Math.asin(arm.y / arm.length());
  if (key === 'ArrowLeft') arm.applyAxisAngle(up, -keyStep);
  else if (key === 'ArrowRight') arm.applyAxisAngle(up, keyStep);
  else if (key === 'ArrowUp' && elevation < 1.3) arm.applyAxisAngle(right, -keyStep);
  else if (key === 'ArrowDown' && elevation > -0.1) arm.applyAxisAngle(right, keyStep);
  else if (key === '+' || key === '=') arm.multiplyScalar(0.92);
  else if (key === '-') arm.multiplyScalar(1.08);
  else return false;
  return true;
}

/** The camera of the desktop; in a session the headset moves the camera and this rests. */
export class DesktopView {
  readonly camera = new PerspectiveCamera(42, 1, 0.05, 90);
  readonly #controls: OrbitControls;
  readonly #raycaster = new Raycaster();
  /** The body's pelvis, as the camera follows it. */
  readonly #target = new Vector3(0, 1, 0);
  /** The target in the previous frame. */
  readonly #before = new Vector3();
  /** How far above the pelvis the camera aims [m], for a head that is larger than people's. */
  #rise = 0;
  /** The distance between the outermost of several bodies [m]. */
  #distance = 0;
  /** The view that the user or the address chose in this scene; null: none. */
  #chosen: ViewName | null = null;
  #scene = studioScene;
  #orbit = true;
  #insets: Insets = { left: 0, right: 0, top: 0, bottom: 0 };

  constructor(canvas: HTMLCanvasElement) {
    this.#controls = createControls(this.camera, canvas);
    canvas.addEventListener('keydown', (event) => this.#pressed(event));
    this.setScene(studioScene);
  }

  get pose(): Pose<'floor'> {
    const { position, quaternion } = this.camera;
    return {
      position: { x: position.x, y: position.y, z: position.z },
      orientation: { x: quaternion.x, y: quaternion.y, z: quaternion.z, w: quaternion.w },
    };
  }

  get view(): ViewName {
    return this.#chosen ?? this.#scene.initial ?? 'third-person';
  }

  setView(view: ViewName): void {
    this.#chosen = view;
    this.setOrbit(this.#orbit);
    this.recentre();
  }

  /** Moves the camera to the start of a scene. Another scene begins with its own view. */
  setScene(scene: CameraScene): void {
    if (scene !== this.#scene) this.#chosen = null;
    this.#scene = scene;
    this.#controls.maxTargetRadius = scene.free ? Number.POSITIVE_INFINITY : panRadius;
    this.#controls.maxDistance = scene.maxDistance ?? 7;
    this.setOrbit(this.#orbit);
    this.recentre();
  }

  /** Whether mouse and touch turn the camera; arrow keys always do. */
  setOrbit(on: boolean): void {
    this.#orbit = on;
    this.#controls.enabled = on && this.view !== 'first-person';
  }

  setInsets(insets: Insets): void {
    this.#insets = insets;
    this.#project();
  }

  resize(): void {
    this.#project();
  }

  /** Moves the camera back to the start of the view. */
  recentre(): void {
    this.#place();
    this.#project();
  }

  /** The ray through a point of the window (from −1 to 1, right and up); unit direction, floor frame. */
  rayThrough(x: number, y: number): Ray {
    this.#raycaster.setFromCamera(new Vector2(x, y), this.camera);
    const { origin, direction } = this.#raycaster.ray;
    return { origin: { ...origin }, direction: { ...direction } };
  }

  /**
   * Sets the height of the body and the distance between the outermost of several bodies [m]: the view also fits bodies
   * taller than people, and all that stand in a row.
   */
  setBodies(height: number, distance: number): void {
    const rise = Math.max(0, height - tallest) / 2;
    if (rise === this.#rise && distance === this.#distance) return;
    this.#rise = rise;
    this.#distance = distance;
    this.#project();
  }

  /** Follows a body: its pelvis and eyes, floor frame; elapsed [s] since the last call. */
  update(pelvis: Vec3, { position, orientation }: Pose<'floor'>, elapsed: number): void {
    const { camera } = this;
    if (this.view === 'first-person') {
      camera.position.copy(position);
      camera.quaternion.copy(orientation);
      return;
    }
    const part = smoothingFactor(followHalfLife, elapsed);
    const target = this.#target;
    const before = this.#before.copy(target);
    target.x += (pelvis.x - target.x) * part;
    target.y += (pelvis.y + this.#rise - target.y) * part;
    target.z += (pelvis.z - target.z) * part;
    camera.position.add(target).sub(before);
    this.#controls.target.add(target).sub(before);
    this.#controls.cursor.add(target).sub(before);
    this.#controls.update();
  }

  /** Returns the box of these points, floor frame [m], in the window. */
  boxOf(points: Iterable<Vec3>) {
    const box = { left: Infinity, right: -Infinity, top: Infinity, bottom: -Infinity };
    for (const point of points) {
      const { x, y } = new Vector3().copy(point).project(this.camera);
      const across = ((1 + x) / 2) * window.innerWidth;
      const down = ((1 - y) / 2) * window.innerHeight;
      box.left = Math.min(box.left, across);
      box.right = Math.max(box.right, across);
      box.top = Math.min(box.top, down);
      box.bottom = Math.max(box.bottom, down);
    }
    return box;
  }

  /** Moves the camera to the start of the view. */
  #place(): void {
    const { camera, view } = this;
    if (view === 'first-person') {
      camera.fov = firstPersonFov;
      return;
    }
    const { offset, aim, fovDegrees } = this.#scene[view];
    camera.fov = fovDegrees;
    camera.up.copy(up);
    this.#controls.target.copy(this.#target).add(aim);
    this.#controls.cursor.copy(this.#controls.target);
    camera.position.copy(this.#target).add(offset);
    this.#controls.update();
  }

  /** Fits the picture to the window, and the body to the part of it that is left to the picture. */
  #project(): void {
    const { camera } = this;
    const width = window.innerWidth;
    const height = window.innerHeight;
    camera.aspect = width / height;
    const { view } = this;
    if (view === 'first-person') {
      camera.zoom = 1;
      camera.clearViewOffset();
    } else {
      const { zoom, shift, rise } = this.#fitBody(view);
      camera.zoom = zoom;
      camera.setViewOffset(width, height, shift, rise, width, height);
    }
    camera.updateProjectionMatrix();
  }

  /**
   * Returns the zoom at which what must stay in sight, by default a standing body, fits the part that is left to the
   * picture, and how far the picture moves left and up [CSS pixels] to show it there. The scene's own composition is
   * changed no further.
   */
  #fitBody(view: Exclude<ViewName, 'first-person'>): Readonly<Record<'zoom' | 'shift' | 'rise', number>> {
    const { left, right, top, bottom } = this.#insets;
    const height = window.innerHeight;
    const freeHeight = Math.max(1, height - top - bottom);
    const freeWidth = Math.max(1, window.innerWidth - left - right);
    const { sides, fovDegrees } = this.#scene[view];
    if (sides !== undefined) {
      const widest = (freeWidth * Math.tan((fovDegrees * Math.PI) / 360)) / (height * sides);
      return { zoom: Math.min(1, widest), shift: (right - left) / 2, rise: (bottom - top) / 2 };
    }
    const { head, feet, leftmost, rightmost } = this.#standing(view);
    const zoom = Math.min(1, (bodyShare * freeHeight) / (head - feet), freeWidth / (rightmost - leftmost));
    const margin = ((1 - bodyShare) / 2) * freeHeight;
    const least = bottom + margin - height / 2 - zoom * feet;
    const most = height / 2 - top - margin - zoom * head;
    // What the picture shows beside the body may lie under a column at the left.
    const leftEdge = window.innerWidth / 2 + zoom * leftmost;
    const middle = (zoom * (leftmost + rightmost)) / 2;
    return {
      zoom,
      shift: Math.max(middle + (right - left) / 2, Math.min(middle + right / 2, leftEdge - left - margin)),
      rise: Math.min(most, Math.max(least, (bottom - top) / 2)),
    };
  }

  /**
   * Returns how far head and feet of standing bodies are above the window's middle, and their sides to the right of it,
   * at the start [CSS pixels].
   */
  #standing(view: Exclude<ViewName, 'first-person'>) {
    const { offset, aim, fovDegrees, headroom = 0 } = this.#scene[view];
    const start = new PerspectiveCamera(fovDegrees, this.camera.aspect, 0.05, 90);
    start.position.copy(offset);
    start.lookAt(aim.x, aim.y, aim.z);
    start.updateMatrixWorld();
    const bodies = [-this.#distance / 2, this.#distance / 2].map((x) => {
      const top = new Vector3(x, tallest - pelvisHeight + this.#rise + headroom, 0).project(start);
      const bottom = new Vector3(x, -pelvisHeight - this.#rise, 0).project(start);
      const [head, feet] = [(top.y * window.innerHeight) / 2, (bottom.y * window.innerHeight) / 2];
      const middle = (bottom.x * window.innerWidth) / 2;
      const half = (bodyWidth * (head - feet)) / 2;
      return { head, feet, leftmost: middle - half, rightmost: middle + half };
    });
    return {
      head: Math.max(...bodies.map(({ head }) => head)),
      feet: Math.min(...bodies.map(({ feet }) => feet)),
      leftmost: Math.min(...bodies.map(({ leftmost }) => leftmost)),
      rightmost: Math.max(...bodies.map(({ rightmost }) => rightmost)),
    };
  }

  #pressed(event: KeyboardEvent): void {
    if (this.view === 'first-person' || event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = this.#controls;
    const arm = this.camera.position.clone().sub(target);
    if (!moveArm(arm, event.key)) return;
    event.preventDefault();
    this.camera.position.copy(target).add(arm);
  }
}
