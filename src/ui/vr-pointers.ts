import {
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Vector3,
  type WebGLRenderer,
} from 'three';

/**
 * What one input source points with: a ray (origin, direction, world) and, where there is one, a finger tip. The same
 * object in every frame while its source is there, as of the last `take`.
 */
export interface Pointer {
  readonly origin: Vector3;
  readonly direction: Vector3;
  readonly tip: Vector3 | null;
  /** The trigger or pinch went down since the last frame. */
  readonly pressed: boolean;
  /** Shows the ray up to this distance [m]; null hides it. */
  showRay(distance: number | null): void;
}

/** Pointers of controllers, of bare hands and of pinches that aim by the eyes, as many as a headset has at a time. */
export interface VrPointers {
  readonly objects: Group;
  /** The pointers of this frame; presses are handed out once. */
  take(): readonly Pointer[];
}

/**
 * Two hands, and a pinch of each: where eyes aim, hands themselves select nothing, and a pinch is an input source
 * beside them.
 */
const mostSources = 4;

/** Reads target rays, triggers and index fingers through three; poses themselves belong to xr/input-reader. */
export function createVrPointers(renderer: WebGLRenderer): VrPointers {
  const objects = new Group();
  const sources = Array.from({ length: mostSources }, (_, index) => {
    const ray = renderer.xr.getController(index);
    const hand = renderer.xr.getHand(index);
    const state = { connected: false, pressed: false, byEyes: false };
    const line = new Line(
      new BufferGeometry().setAttribute('position', new Float32BufferAttribute([0, 0, 0, 0, 0, -1], 3)),
      new LineBasicMaterial({ color: '#ffb468', transparent: true, opacity: 0.7, fog: false, toneMapped: false }),
    );
    const dot = new Mesh(new SphereGeometry(0.007, 12, 8), new MeshBasicMaterial({ color: '#ffe3c4', fog: false }));
    line.visible = false;
    dot.visible = false;
    ray.add(line, dot);
    ray.addEventListener('connected', ({ data }) => {
      state.connected = true;
      state.byEyes = data.targetRayMode === 'transient-pointer';
    });
    ray.addEventListener('disconnected', () => {
      state.connected = false;
      state.pressed = false;
    });
    ray.addEventListener('selectstart', () => {
      state.pressed = true;
    });
    objects.add(ray, hand);
    const tip = new Vector3();
    const pointer = {
      origin: new Vector3(),
      direction: new Vector3(),
      tip: null as Vector3 | null,
      pressed: false,
      showRay(distance: number | null) {
        dot.visible = distance !== null;
        // A line that begins between the eyes would only blind its wearer.
        line.visible = dot.visible && !state.byEyes;
        if (distance === null) return;
        line.scale.z = distance;
        dot.position.z = -distance;
      },
    };
    return { ray, hand, state, tip, pointer };
  });

  return {
    objects,
    take() {
      const pointers: Pointer[] = [];
      for (const { ray, hand, state, tip, pointer } of sources) {
        pointer.pressed = state.pressed;
        state.pressed = false;
        if (!state.connected || !ray.visible) {
          pointer.showRay(null);
          continue;
        }
        ray.updateWorldMatrix(true, false);
        pointer.origin.setFromMatrixPosition(ray.matrixWorld);
        pointer.direction.set(0, 0, -1).transformDirection(ray.matrixWorld);
        const finger = hand.joints?.['index-finger-tip'];
        pointer.tip = finger?.visible ? tip : null;
        if (finger && pointer.tip) {
          finger.updateWorldMatrix(true, false);
          tip.setFromMatrixPosition(finger.matrixWorld);
        }
        pointers.push(pointer);
      }
      return pointers;
    },
  };
}
