import { makePose } from '../core/math/pose';
import { identity, type Quat, setQuat } from '../core/math/quat';
import { setVec3, type Vec3 } from '../core/math/vec3';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import type { DeviceBodyReader } from './device-body-reader';
import { createTracker, type Tracker } from './tracker';

/** The space that a renderer draws its session in (`renderer.xr` of three.js): its own, or one that the page gave it; null: its own again. */
export interface DrawingSpace {
  getReferenceSpace(): XRReferenceSpace | null;
  setReferenceSpace(space: XRReferenceSpace | null): void;
}

/**
 * One session, read from its beginning to its end in the floor's space that the renderer asked it for. A page that moves its wearer has its
 * renderer draw in other spaces: they move what is drawn, and nothing of what is tracked.
 */
export class SessionReading {
  readonly #drawing: DrawingSpace;
  readonly #tracker: Tracker;
  /** The renderer's own space. */
  readonly #own: XRReferenceSpace;
  /** The frame that is read: the renderer's own space, or where the wearer's recentring laid it since. */
  #floor: XRReferenceSpace;
  /** What the renderer draws in since the wearer recentred, and drew in before; null: the wearer did not. */
  #recentred: { readonly space: XRReferenceSpace; readonly before: XRReferenceSpace | null } | null = null;
  readonly #floorPose = makePose();
  readonly #onReset: () => void;

  /** null: the renderer has no space yet. `onReset`: the device laid the floor elsewhere. */
  static of(
    session: XRSession,
    drawing: DrawingSpace,
    bodyReader: DeviceBodyReader | null,
    onReset: () => void,
  ): SessionReading | null {
    const own = ownSpaceOf(drawing);
    return own && new SessionReading(session, drawing, own, bodyReader, onReset);
  }

  private constructor(
    session: XRSession,
    drawing: DrawingSpace,
    own: XRReferenceSpace,
    bodyReader: DeviceBodyReader | null,
    onReset: () => void,
  ) {
    this.#drawing = drawing;
    this.#own = own;
    this.#floor = own;
    this.#onReset = onReset;
    this.#tracker = createTracker(session, own, (floor) => this.#layFloor(floor), bodyReader);
    own.addEventListener('reset', onReset);
  }

  /** Where the floor lies in the space that the renderer draws in, as of the last frame read [m]; overwritten by the next. */
  get floorPose(): { readonly position: Vec3; readonly orientation: Quat } {
    return this.#floorPose;
  }

  /** Head and wrists of this frame, floor frame; null while the head is not seen. Call it before any await of the frame. */
  read(frame: XRFrame, time: number): TrackingFrame | null {
    this.#locateFloor(frame);
    return this.#tracker.read(frame, time);
  }

  /** Moves the floor's origin under the head, its −Z to where the head looks; what is drawn moves along, as high as it was. */
  recentre(): void {
    this.#tracker.recentre();
  }

  dispose(): void {
    this.#own.removeEventListener('reset', this.#onReset);
    this.#tracker.dispose();
  }

  /** A floor of which this frame does not tell where it is stays where it was. */
  #locateFloor(frame: XRFrame): void {
    const { position, orientation } = this.#floorPose;
    const space = this.#drawing.getReferenceSpace() ?? this.#own;
    if (space === this.#floor) {
      setVec3(position, 0, 0, 0);
      setQuat(orientation, 0, 0, 0, 1);
      return;
    }
    const pose = frame.getPose(this.#floor, space);
    if (!pose) return;
    const { position: p, orientation: o } = pose.transform;
    setVec3(position, p.x, p.y, p.z);
    setQuat(orientation, o.x, o.y, o.z, o.w);
  }

  #layFloor(floor: XRReferenceSpace): void {
    const drawnIn = this.#drawing.getReferenceSpace();
    const recentred = this.#recentred?.space === drawnIn ? this.#recentred : null;
    this.#floor = floor;
    if (floor === this.#own) {
      // The device recentred: what the wearer did is forgotten, and a page that has moved them since keeps its space.
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

/** The space that the renderer asked the session for, whichever the page has it draw in now. */
function ownSpaceOf(drawing: DrawingSpace): XRReferenceSpace | null {
  const drawnIn = drawing.getReferenceSpace();
  drawing.setReferenceSpace(null);
  const own = drawing.getReferenceSpace();
  if (own !== drawnIn) drawing.setReferenceSpace(drawnIn);
  return own ?? drawnIn;
}
