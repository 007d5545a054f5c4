import { MutablePointer, type Pointer, type PointerSource } from '../core/input/pointer';
import { isFinitePose } from '../core/math/pose';
import { rotate } from '../core/math/quat';
import { forward, setVec3, type Vec3 } from '../core/math/vec3';

function sourceOf({ targetRayMode, hand }: XRInputSource): PointerSource {
  if (targetRayMode !== 'tracked-pointer') return 'transient';
  return hand ? 'hand' : 'controller';
}

/** Reads the pointers of a session: the rays, finger tips and select events of its input sources. */
export class PointerReader {
  readonly #known = new WeakMap<XRInputSource, MutablePointer>();
  #now: MutablePointer[] = [];
  #before: MutablePointer[] = [];
  /** The sources that select now, and those that began to since the last frame. */
  readonly #selecting = new Set<XRInputSource>();
  readonly #began = new Set<XRInputSource>();

  constructor(session: XRSession) {
    session.addEventListener('selectstart', ({ inputSource }) => {
      this.#selecting.add(inputSource);
      this.#began.add(inputSource);
    });
    session.addEventListener('selectend', ({ inputSource }) => this.#selecting.delete(inputSource));
  }

  /** The pointers of the newest frame. */
  get pointers(): readonly Pointer[] {
    return this.#now;
  }

  begin(): void {
    const before = this.#before;
    this.#before = this.#now;
    before.length = 0;
    this.#now = before;
  }

  /** Reads a source. `taken`: it belongs to the device in this frame. `tip`: of its index finger; null: not seen. */
  read(source: XRInputSource, ray: XRPose | null, taken: boolean, tip: Vec3 | null): void {
    if (!ray || taken || !isFinitePose(ray.transform)) return;
    const pointer = this.#pointerOf(source);
    pointer.begin();
    const { position: p, orientation: o } = ray.transform;
    setVec3(pointer.origin, p.x, p.y, p.z);
    rotate(o, forward, pointer.direction);
    pointer.setTip(tip);
    pointer.pressed = this.#began.has(source);
    // A select that began while the device had the hand is not for the page.
    pointer.held = this.#selecting.has(source) && (pointer.held || pointer.pressed);
    this.#now.push(pointer);
  }

  /** Ends a frame: pointers that are gone release what they held. `ended`: the device took all of them. */
  finish(ended: boolean): void {
    for (const pointer of this.#before) {
      if (this.#now.includes(pointer)) continue;
      const held = pointer.held;
      pointer.begin();
      pointer.held = false;
      pointer.cancelled = held && (ended || pointer.source !== 'transient');
    }
    this.#began.clear();
  }

  #pointerOf(source: XRInputSource): MutablePointer {
    const known = this.#known.get(source);
    if (known) return known;
    const side = source.handedness === 'none' ? null : source.handedness;
    const pointer = new MutablePointer(sourceOf(source), side);
    this.#known.set(source, pointer);
    return pointer;
  }
}
