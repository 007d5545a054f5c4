import { forward, fromAxisAngle, rotate, up, type Vec3, vec3 } from 'threepoint/math';

/** The foot of the mirror [m], floor frame, and its turn [rad]; turned by 0 it faces +Z. */
interface MirrorPlace {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly turned: number;
}

/** WebXR's persistent anchors, which the types leave out. */
interface PersistingSession {
  restorePersistentAnchor?(handle: string): Promise<XRAnchor>;
  deletePersistentAnchor?(handle: string): Promise<void>;
}
interface PersistentAnchor extends XRAnchor {
  requestPersistentHandle?(): Promise<string>;
}

/** The stored handle of the mirror's persistent anchor; undefined: there is none. */
export interface StoredAnchor {
  readonly handle: string | undefined;
  store(handle: string | undefined): void;
}

interface MirrorStandOptions {
  readonly session: XRSession;
  /** The space of the page's floor frame; null before the session started. */
  floorSpace(): XRReferenceSpace | null;
  /** Whether a menu lies before the mirror, under the hands' rays. It is pressed, and the mirror is not grabbed. */
  isCovered(): boolean;
  readonly kept: StoredAnchor;
}

/** The place of the mirror until a floor is found: ahead of the origin [m]. */
const defaultPlace: MirrorPlace = { x: 0, y: 0, z: -1.5, turned: 0 };
/** The smallest and the largest distance of the mirror from its user [m]. */
const minDistance = 0.9;
const maxDistance = 8;
/** The direction of the hit test, below the gaze: 2.3 m ahead of a person of 1.7 m for a level gaze. */
const gazeToFloor = { x: 0, y: -0.7, z: -1 };
/** The longest search for the floor [s]. */
const searchSeconds = 6;
/** A surface this far from the session's own floor is a table or a step [m]. */
const floorTolerance = 0.3;
/** The area in which the mirror can be grabbed [m]. */
const grabArea = { halfWidth: 0.82, height: 2.35 };
/** The movement of the mirror per movement of the hand towards or away from the user. */
const pullFactor = 4;

/** A grab: its source, the distance of the mirror from the user, and of the hand at its beginning [m]. */
interface Grab {
  readonly source: XRInputSource;
  readonly distance: number;
  readonly hand: number;
}

interface Ray {
  readonly origin: Vec3;
  readonly direction: Vec3;
}

function rayOf(pose: XRPose): Ray {
  const { position: p, orientation: o } = pose.transform;
  return { origin: vec3(p.x, p.y, p.z), direction: rotate({ x: o.x, y: o.y, z: o.z, w: o.w }, forward) };
}

/** Returns whether a ray meets the mirror at a place. */
export function meetsMirror({ origin, direction }: Ray, { x, y, z, turned }: MirrorPlace): boolean {
  const local = fromAxisAngle(up, -turned);
  const from = rotate(local, vec3(origin.x - x, origin.y - y, origin.z - z));
  const along = rotate(local, direction);
  const distance = -from.z / along.z;
  if (!(distance > 0)) return false;
  const height = from.y + distance * along.y;
  return Math.abs(from.x + distance * along.x) < grabArea.halfWidth && height > 0 && height < grabArea.height;
}

/** Returns a place at this distance from the head in a horizontal direction, facing the head. */
function placeFacing(head: Vec3, towards: { readonly x: number; readonly z: number }, distance: number, y: number) {
  const length = Math.hypot(towards.x, towards.z) || 1;
  const clamped = Math.min(maxDistance, Math.max(minDistance, distance));
  const [x, z] = [head.x + (towards.x / length) * clamped, head.z + (towards.z / length) * clamped];
  return { x, y, z, turned: Math.atan2(head.x - x, head.z - z) };
}

/**
 * Keeps the mirror at its place in the user's room: on the floor that a hit test finds, held by an anchor, moved by a
 * grab. Devices without hit test or anchors use the floor of the session.
 */
export class MirrorStand {
  readonly #options: MirrorStandOptions;
  readonly #listening = new AbortController();
  /** A space that is fixed to the room at the foot of the mirror; null: none yet. */
  #fixed: XRSpace | null = null;
  #anchor: XRAnchor | null = null;
  #place = defaultPlace;
  #hitTest: XRHitTestSource | null = null;
  #searchUntil: number | null = null;
  #restoring = true;
  #grab: Grab | null = null;
  /** Whether a grab has moved the mirror since it was fixed. */
  #moved = false;
  #disposed = false;

  constructor(options: MirrorStandOptions) {
    this.#options = options;
    const { session } = options;
    const listening = { signal: this.#listening.signal };
    for (const type of ['selectstart', 'squeezestart'] as const)
      session.addEventListener(type, (event) => this.#begin(event, type === 'squeezestart'), listening);
    for (const type of ['selectend', 'squeezeend'] as const)
      session.addEventListener(type, ({ inputSource }) => this.#end(inputSource), listening);
    session.addEventListener(
      'inputsourceschange',
      ({ removed }) => {
        for (const source of removed) this.#end(source);
      },
      listening,
    );
    void this.#start();
  }

  get place(): MirrorPlace {
    return this.#place;
  }

  /** Whether an anchor of the device holds the mirror. */
  get anchored(): boolean {
    return this.#anchor !== null;
  }

  /** Updates the place. `time`: [s]. */
  update(frame: XRFrame, time: number): void {
    const floor = this.#options.floorSpace();
    if (!floor) return;
    if (this.#grab) this.#drag(this.#grab, frame, floor);
    else if (this.#moved) this.#fix(frame, floor);
    else if (this.#fixed) this.#locate(this.#fixed, frame, floor);
    else if (!this.#restoring) this.#findFloor(frame, floor, time);
  }

  dispose(): void {
    this.#disposed = true;
    this.#listening.abort();
    this.#hitTest?.cancel();
  }

  /** Restores the anchor of an earlier visit, or asks for hit tests of the floor ahead. */
  async #start(): Promise<void> {
    const { session, kept } = this.#options;
    const { restorePersistentAnchor } = session as PersistingSession;
    if (kept.handle !== undefined && restorePersistentAnchor) {
      try {
        this.#hold(await restorePersistentAnchor.call(session, kept.handle));
      } catch {
        // reason: the room was forgotten, or is another one; the mirror is placed as on a first visit
        kept.store(undefined);
      }
    }
    if (!this.#fixed) await this.#requestHitTest();
    this.#restoring = false;
  }

  async #requestHitTest(): Promise<void> {
    const { session } = this.#options;
    try {
      const space = await session.requestReferenceSpace('viewer');
      const offsetRay = new XRRay({ x: 0, y: 0, z: 0, w: 1 }, { ...gazeToFloor, w: 0 });
      const source = (await session.requestHitTestSource?.({ space, offsetRay })) ?? null;
      if (this.#disposed) source?.cancel();
      else this.#hitTest = source;
    } catch {
      // reason: hit tests are optional; without them the mirror stands on the floor of the session
    }
  }

  #findFloor(frame: XRFrame, floor: XRReferenceSpace, time: number): void {
    const viewer = frame.getViewerPose(floor);
    if (!viewer) return;
    this.#searchUntil ??= time + (this.#hitTest ? searchSeconds : 0);
    const { origin: head, direction } = rayOf(viewer);
    const hit = this.#hitTest && frame.getHitTestResults(this.#hitTest)[0]?.getPose(floor)?.transform;
    const isFloor = hit && Math.abs(hit.position.y) < floorTolerance && rotate(hit.orientation, up).y > 0.9;
    if (!isFloor && time < this.#searchUntil) return;
    const height = isFloor ? hit.position.y : 0;
    const distance = isFloor ? Math.hypot(hit.position.x - head.x, hit.position.z - head.z) : -defaultPlace.z;
    this.#place = placeFacing(head, direction, Math.max(1.3, Math.min(2.5, distance)), height);
    this.#hitTest?.cancel();
    this.#hitTest = null;
    this.#fix(frame, floor);
  }

  #locate(space: XRSpace, frame: XRFrame, floor: XRReferenceSpace): void {
    const found = frame.getPose(space, floor);
    if (!found) return;
    const { position, orientation } = found.transform;
    const faces = rotate(orientation, vec3(0, 0, 1));
    this.#place = { x: position.x, y: position.y, z: position.z, turned: Math.atan2(faces.x, faces.z) };
  }

  /** Grabs the mirror with the grip of a controller, or with the pinch of a hand. */
  #begin({ frame, inputSource }: XRInputSourceEvent, squeezes: boolean): void {
    const { floorSpace, isCovered } = this.#options;
    const pinches = Boolean(inputSource.hand) || inputSource.targetRayMode === 'transient-pointer';
    const floor = floorSpace();
    if (!floor || this.#grab || isCovered() || !(squeezes || pinches)) return;
    const [pose, viewer] = [frame.getPose(inputSource.targetRaySpace, floor), frame.getViewerPose(floor)];
    if (!pose || !viewer || !meetsMirror(rayOf(pose), this.#place)) return;
    const head = viewer.transform.position;
    const hand = pose.transform.position;
    this.#grab = {
      source: inputSource,
      distance: Math.hypot(this.#place.x - head.x, this.#place.z - head.z),
      hand: Math.hypot(hand.x - head.x, hand.z - head.z),
    };
  }

  #drag({ source, distance, hand: before }: Grab, frame: XRFrame, floor: XRReferenceSpace): void {
    const [pose, viewer] = [frame.getPose(source.targetRaySpace, floor), frame.getViewerPose(floor)];
    if (!pose || !viewer) return;
    const { origin: hand, direction } = rayOf(pose);
    const { origin: head } = rayOf(viewer);
    const now = Math.hypot(hand.x - head.x, hand.z - head.z);
    this.#place = placeFacing(head, direction, distance + pullFactor * (now - before), this.#place.y);
    this.#moved = true;
  }

  #end(source: XRInputSource): void {
    // The next frame fixes the place.
    if (this.#grab?.source === source) this.#grab = null;
  }

  /** Fixes the place to the room: by the session's own space at once, and by an anchor as soon as there is one. */
  #fix(frame: XRFrame, floor: XRReferenceSpace): void {
    this.#moved = false;
    const { x, y, z, turned } = this.#place;
    const transform = new XRRigidTransform({ x, y, z, w: 1 }, fromAxisAngle(up, turned));
    this.#anchor?.delete();
    this.#anchor = null;
    this.#fixed = floor.getOffsetReferenceSpace(transform);
    const fixed = this.#fixed;
    void frame
      .createAnchor?.(transform, floor)
      ?.then((anchor) => (this.#fixed === fixed && !this.#disposed ? this.#store(anchor) : anchor.delete()))
      // reason: a device without anchors here holds the mirror by the session's own space
      .catch(() => undefined);
  }

  #hold(anchor: XRAnchor): void {
    this.#anchor = anchor;
    this.#fixed = anchor.anchorSpace;
  }

  /** Holds the mirror by an anchor, and stores the anchor for later visits. */
  async #store(anchor: PersistentAnchor): Promise<void> {
    const { session, kept } = this.#options;
    this.#hold(anchor);
    if (!anchor.requestPersistentHandle) return;
    const before = kept.handle;
    kept.store(await anchor.requestPersistentHandle());
    if (before !== undefined) await (session as PersistingSession).deletePersistentAnchor?.(before);
  }
}
