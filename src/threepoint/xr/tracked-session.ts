import type { GripOffsets } from '../core/body/calibration';
import { makePose, type Pose } from '../core/math/pose';
import { conjugate, fromAxisAngle, identity, multiply, type Quat, rotate, setQuat } from '../core/math/quat';
import { setVec3, subtract, up, type Vec3 } from '../core/math/vec3';
import { headingOf } from '../core/tracking/heading';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import type { DeviceBodyReader } from './device-body-reader';
import type { InputReader } from './input-reader';
import type { Pointing } from './pointing';
import { TrackingReader } from './tracking-reader';

/**
 * The reference space that a renderer draws its session in (`renderer.xr` of three.js); setting null restores the
 * renderer's own space.
 */
export interface DrawingSpace {
  getReferenceSpace(): XRReferenceSpace | null;
  setReferenceSpace(space: XRReferenceSpace | null): void;
}

const noOffsets: GripOffsets = {};

interface TrackedSessionOptions {
  readonly session: XRSession;
  readonly drawing: DrawingSpace;
  /** Reads the device's own body into each frame; null: it is not read. */
  readonly bodyReader?: DeviceBodyReader | null;
  /** Reads what the session's input sources point at and press; null: it is not read. */
  readonly pointing?: Pointing | null;
  /** Returns the user's corrections of how they hold controllers; called in every frame. Default: none. */
  gripOffsets?(): GripOffsets | undefined;
  /** Called when the first frame is about to be read. */
  onStart?(): void;
  /** Called when the floor lies elsewhere from the next frame on: by the device, `recentre` or `turn`. */
  onDiscontinuity?(): void;
  onEnd?(): void;
}

/**
 * Turns the frames of one XRSession into tracking frames, from its start to its end. The tracking frame's floor is the
 * space that the renderer requested, or where `recentre` and `turn` moved it. A page that moves its user lets the
 * renderer draw in other spaces: these move what is drawn, not what is tracked.
 */
export class TrackedSession {
  readonly inputs: InputReader;
  readonly bodyReader: DeviceBodyReader | null;
  readonly #options: TrackedSessionOptions;
  readonly #session: XRSession;
  readonly #drawing: DrawingSpace;
  readonly #reader: TrackingReader;
  /** The renderer's own space; null before the session started. */
  #own: XRReferenceSpace | null = null;
  /** The space that is tracked in; null before the session started. */
  #floor: XRReferenceSpace | null = null;
  /** The spaces that the renderer draws in since a recentring, and drew in before it; null: there was none. */
  #recentred: { readonly space: XRReferenceSpace; readonly before: XRReferenceSpace | null } | null = null;
  readonly #floorPose = makePose();
  #lastHead: Pose<'floor'> | null = null;
  /** The height by which the user is raised above the reported one [m]. */
  #raised = 0;
  readonly #onReset = () => {
    this.#lastHead = null;
    if (this.#own && this.#floor !== this.#own) this.#moveTo(this.#own);
    if (this.#own && this.#raised !== 0) this.#moveTo(lowered(this.#own, this.#raised));
    this.#options.onDiscontinuity?.();
  };
  readonly #onEnd = () => {
    this.dispose();
    this.#options.onEnd?.();
  };

  constructor(options: TrackedSessionOptions) {
    this.#options = options;
    this.#session = options.session;
    this.#drawing = options.drawing;
    this.bodyReader = options.bodyReader ?? null;
    this.#reader = new TrackingReader(options.session, options.pointing);
    this.inputs = this.#reader.inputs;
    options.session.addEventListener('end', this.#onEnd);
  }

  /** The floor in the space that the renderer draws in, as of the last frame read [m]; overwritten by the next. */
  get floorPose(): { readonly position: Vec3; readonly orientation: Quat } {
    return this.#floorPose;
  }

  /** The space of the tracking frames; null before the session started. */
  get floorSpace(): XRReferenceSpace | null {
    return this.#floor;
  }

  /** Starts tracking in the renderer's space, unless it has started. Returns false while the renderer has none. */
  start(): boolean {
    if (this.#own) return true;
    this.#own = ownSpaceOf(this.#drawing);
    if (!this.#own) return false;
    this.#floor = this.#own;
    this.#own.addEventListener('reset', this.#onReset);
    this.#options.onStart?.();
    return true;
  }

  /**
   * Returns head and wrists of this frame, floor frame, and starts the session where that has not happened; null while
   * the head is not seen. `time`: [s]. Call it before any await of the frame: throws an InvalidStateError afterwards.
   */
  read(frame: XRFrame, time: number): TrackingFrame | null {
    if (!this.start() || !this.#floor) return null;
    this.#locateFloor(frame, this.#floor);
    this.inputs.setGripOffsets(this.#options.gripOffsets?.() ?? noOffsets);
    const tracked = this.#reader.readAt(time, frame, this.#floor, this.bodyReader);
    if (tracked) this.#lastHead = tracked.head;
    return tracked;
  }

  /**
   * Moves the floor's origin under the head, its −Z to where the head looks; the drawing moves along and keeps its
   * height.
   */
  recentre(): void {
    const head = this.#lastHead;
    if (head && this.#floor) {
      const turned = headingOf(head.orientation);
      const origin = { ...head.position, y: 0 };
      // The new space's origin in the old one: under the head, turned as it looks.
      this.#moveTo(this.#floor.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, turned)));
      const { y } = head.position;
      this.#lastHead = { position: { x: 0, y, z: 0 }, orientation: multiply(conjugate(turned), head.orientation) };
    }
    this.#options.onDiscontinuity?.();
  }

  /** Turns the floor about the head by this angle [rad], to the left above 0, as of the last frame read. */
  turn(angle: number): void {
    const head = this.#lastHead;
    if (head && this.#floor) {
      const oldFromNew = fromAxisAngle(up, -angle);
      const under = { ...head.position, y: 0 };
      // The head stays where it is, and everything turns about it.
      const origin = subtract(under, rotate(oldFromNew, under));
      this.#moveTo(this.#floor.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, oldFromNew)));
      this.#lastHead = { ...head, orientation: multiply(conjugate(oldFromNew), head.orientation) };
    }
    this.#options.onDiscontinuity?.();
  }

  /** The height by which the user is raised above the reported one [m]. */
  get heightOffset(): number {
    return this.#raised;
  }

  /** Sets the height offset of the user: the floor is this far [m] below the device's. Recentring keeps it. */
  setHeightOffset(height: number): void {
    const by = height - this.#raised;
    if (!Number.isFinite(by) || by === 0) return;
    this.#raised = height;
    const head = this.#lastHead;
    if (head) this.#lastHead = { ...head, position: { ...head.position, y: head.position.y + by } };
    if (this.#floor) this.#moveTo(lowered(this.#floor, by));
    this.#options.onDiscontinuity?.();
  }

  /** Removes the listeners: the session is over, or another object reads it. */
  dispose(): void {
    this.#session.removeEventListener('end', this.#onEnd);
    this.#own?.removeEventListener('reset', this.#onReset);
  }

  /** Keeps the last known floor pose where this frame does not report it. */
  #locateFloor(frame: XRFrame, floor: XRReferenceSpace): void {
    const { position, orientation } = this.#floorPose;
    const space = this.#drawing.getReferenceSpace() ?? this.#own;
    if (!space || space === floor) {
      setVec3(position, 0, 0, 0);
      setQuat(orientation, 0, 0, 0, 1);
      return;
    }
    const pose = frame.getPose(floor, space);
    if (!pose) return;
    const { position: p, orientation: o } = pose.transform;
    setVec3(position, p.x, p.y, p.z);
    setQuat(orientation, o.x, o.y, o.z, o.w);
  }

  #moveTo(floor: XRReferenceSpace): void {
    const drawnIn = this.#drawing.getReferenceSpace();
    const recentred = this.#recentred?.space === drawnIn ? this.#recentred : null;
    this.#floor = floor;
    if (floor === this.#own) {
      // The device recentred: earlier recentring is void, and a page that has moved its user since keeps its space.
      this.#recentred = null;
      if (recentred) this.#drawing.setReferenceSpace(recentred.before);
      return;
    }
    const { y } = this.#floorPose.position;
    const space = y === 0 ? floor : floor.getOffsetReferenceSpace(new XRRigidTransform({ y: -y }, identity));
    this.#recentred = { space, before: recentred ? recentred.before : drawnIn };
    this.#drawing.setReferenceSpace(space);
  }
}

/** Returns a space whose floor lies this far [m] lower. */
const lowered = (space: XRReferenceSpace, by: number): XRReferenceSpace =>
  space.getOffsetReferenceSpace(new XRRigidTransform({ x: 0, y: -by, z: 0, w: 1 }, identity));

/** Returns the space that the renderer requested from the session, whichever one the page lets it draw in. */
function ownSpaceOf(drawing: DrawingSpace): XRReferenceSpace | null {
  const drawnIn = drawing.getReferenceSpace();
  drawing.setReferenceSpace(null);
  const own = drawing.getReferenceSpace();
  if (own !== drawnIn) drawing.setReferenceSpace(drawnIn);
  return own ?? drawnIn;
}
