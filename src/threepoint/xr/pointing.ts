import type { Pointer } from '../core/input/pointer';
import type { Pose } from '../core/math/pose';
import type { Side } from '../core/math/side';
import type { Vec3 } from '../core/math/vec3';
import { DeviceCommands, isMenuPinch } from './device-commands';
import { PointerReader } from './pointer-reader';
import { SystemGesture } from './system-gesture';

/** One frame of a session, to be read in a space. */
export interface InputFrame {
  readonly frame: XRFrame;
  readonly space: XRReferenceSpace;
  /** [s] */
  readonly time: number;
  /** The head in the space; null: not seen. */
  readonly head: Pose<'floor'> | null;
}

/** The hand of an input source in a frame; the next source may overwrite it. */
export interface PointingHand {
  /** The wrist, floor frame; null: not seen. */
  wrist: Pose<'floor'> | null;
  /** Whether it is a hand without a controller. */
  isBare: boolean;
  /** The pinch of a bare hand, 0 to 1; NaN: its fingers are not seen. */
  pinch: number;
  /** The tip of the index finger, floor frame; null: not seen. */
  tip: Vec3 | null;
}

/**
 * Reads the pointers and commands of a session's input sources, and which hands the device uses itself. A page without
 * a menu in the headset does not need it.
 */
export class Pointing {
  /** The commands of devices besides pointing. */
  readonly commands = new DeviceCommands();
  /** The time of the newest frame in which a hand or a controller was seen [s]; −∞: none was. */
  handsSeenAt = Number.NEGATIVE_INFINITY;
  readonly #pointers: PointerReader;
  readonly #gestures: Readonly<Record<Side, SystemGesture>> = {
    left: new SystemGesture(),
    right: new SystemGesture(),
  };

  constructor(session: XRSession) {
    this.#pointers = new PointerReader(session);
  }

  /** The pointers of the newest frame; none while the session is suspended. */
  get pointers(): readonly Pointer[] {
    return this.#pointers.pointers;
  }

  /** Starts a frame. `suspended`: a menu of the device has the input. */
  begin(sources: XRInputSourceArray, suspended: boolean): void {
    if (suspended) this.commands.waitForRelease();
    else this.commands.watch(sources);
    this.#pointers.begin();
  }

  read(source: XRInputSource, { frame, space }: InputFrame): void {
    this.#pointers.read(source, frame.getPose(source.targetRaySpace, space) ?? null, false, null);
  }

  /** Reads a source with its hand; returns whether the hand belongs to the device. */
  readHand(source: XRInputSource, now: InputFrame, { wrist, isBare, pinch, tip }: PointingHand): boolean {
    const ray = now.frame.getPose(source.targetRaySpace, now.space) ?? null;
    const isTracked = source.targetRayMode === 'tracked-pointer';
    if (wrist && isTracked) this.handsSeenAt = now.time;
    const menu = isMenuPinch(source);
    const taken =
      wrist !== null &&
      isBare &&
      isTracked &&
      this.#gestures[source.handedness as Side].follow({ wrist, pinch, hasRay: ray !== null, menu }, now.head);
    this.#pointers.read(source, ray, taken, tip);
    return taken;
  }

  finish(suspended: boolean): void {
    this.#pointers.finish(suspended);
  }
}
