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

/** What one hand points with in this frame: a ray (origin, direction, world) and, where there is one, a finger tip. */
export interface Pointer {
  readonly origin: Vector3;
  readonly direction: Vector3;
  readonly tip: Vector3 | null;
  /** The trigger or pinch went down since the last frame. */
  readonly pressed: boolean;
  /** Shows the ray up to this distance [m]; null hides it. */
  showRay(distance: number | null): void;
}

/** Both hands' pointers, of controllers and of bare hands alike. */
export interface VrPointers {
  readonly objects: Group;
  /** The pointers of this frame; presses are handed out once. */
  take(): readonly Pointer[];
}

/** Reads target rays, triggers and index fingers through three; poses themselves belong to xr/tracker. */
export function createVrPointers(renderer: WebGLRenderer): VrPointers {
  const objects = new Group();
  const hands = [0, 1].map((index) => {
    const ray = renderer.xr.getController(index);
    const hand = renderer.xr.getHand(index);
    const state = { connected: false, pressed: false };
    const line = new Line(
      new BufferGeometry().setAttribute('position', new Float32BufferAttribute([0, 0, 0, 0, 0, -1], 3)),
      new LineBasicMaterial({ color: '#ffb468', transparent: true, opacity: 0.7, fog: false, toneMapped: false }),
    );
    const dot = new Mesh(new SphereGeometry(0.007, 12, 8), new MeshBasicMaterial({ color: '#ffe3c4', fog: false }));
    line.visible = false;
    dot.visible = false;
    ray.add(line, dot);
    ray.addEventListener('connected', () => {
      state.connected = true;
    });
    ray.addEventListener('disconnected', () => {
      state.connected = false;
      state.pressed = false;
    });
    ray.addEventListener('selectstart', () => {
      state.pressed = true;
    });
    objects.add(ray, hand);
    const origin = new Vector3();
    const direction = new Vector3();
    const tip = new Vector3();
    const showRay = (distance: number | null) => {
      line.visible = dot.visible = distance !== null;
      if (distance === null) return;
      line.scale.z = distance;
      dot.position.z = -distance;
    };
    return { ray, hand, state, origin, direction, tip, showRay };
  });

  return {
    objects,
    take() {
      const pointers: Pointer[] = [];
      for (const { ray, hand, state, origin, direction, tip, showRay } of hands) {
        const pressed = state.pressed;
        state.pressed = false;
        if (!state.connected || !ray.visible) {
          showRay(null);
          continue;
        }
        ray.updateWorldMatrix(true, false);
        origin.setFromMatrixPosition(ray.matrixWorld);
        direction.set(0, 0, -1).transformDirection(ray.matrixWorld);
        const finger = hand.joints?.['index-finger-tip'];
        const hasFinger = finger?.visible === true;
        if (hasFinger) {
          finger.updateWorldMatrix(true, false);
          tip.setFromMatrixPosition(finger.matrixWorld);
        }
        pointers.push({ origin, direction, tip: hasFinger ? tip : null, pressed, showRay });
      }
      return pointers;
    },
  };
}
