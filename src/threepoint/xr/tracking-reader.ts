import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { TrackingGate } from '../core/tracking/tracking-gate';
import type { DeviceBodyReader } from './device-body-reader';
import { InputReader } from './input-reader';
import type { Pointing } from './pointing';
import { toTrackedPose } from './tracked-pose';

/**
 * Reads the head, wrists and fingers of a session's frames, for pages of any engine. A hand that is not seen is null;
 * of two input sources of one side, the one in use is read. When the space is reset, call `discontinuity` of the body.
 *
 * @example
 * const reader = new TrackingReader(session);
 * const floor = await session.requestReferenceSpace('local-floor');
 * session.requestAnimationFrame(function draw(timeMs, frame) {
 *   session.requestAnimationFrame(draw);
 *   const pose = body.update(reader.read(timeMs, frame, floor));
 * });
 */
export class TrackingReader {
  /** The input that tracks each side, with its buttons; `setGripOffsets` corrects how controllers are held. */
  readonly inputs: InputReader;
  readonly #session: XRSession;
  readonly #gate = new TrackingGate({ assumesTracked: true });

  constructor(session: XRSession, pointing: Pointing | null = null) {
    this.#session = session;
    this.inputs = new InputReader(session, pointing);
  }

  /**
   * Returns head and wrists in a space whose origin is on the floor; null while the head is not seen. Call it before
   * any await of the frame: throws an InvalidStateError afterwards.
   */
  read(timeMs: number, frame: XRFrame, space: XRReferenceSpace): TrackingFrame | null {
    return this.readAt(timeMs / 1000, frame, space, null);
  }

  /**
   * Returns what `read` does, at a time [s], with the device's own body.
   *
   * @internal
   */
  readAt(
    time: number,
    frame: XRFrame,
    space: XRReferenceSpace,
    bodyReader: DeviceBodyReader | null,
  ): TrackingFrame | null {
    const viewer = frame.getViewerPose(space);
    const suspended = this.#session.visibilityState !== 'visible';
    const head = viewer && toTrackedPose(viewer);
    const { left, right } = this.inputs.read({ frame, space, time, head: head ?? null }, suspended);
    if (!head) return null;
    const deviceBody = bodyReader?.read(frame, space);
    const poses = { time, head, leftHand: left, rightHand: right, fingers: this.inputs.fingers };
    return this.#gate.validate({ ...poses, ...(deviceBody && { deviceBody }), ...(suspended && { suspended }) });
  }
}
