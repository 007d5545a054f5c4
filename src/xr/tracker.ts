import type { Side } from '../core/body/joints';
import type { Pose } from '../core/math/pose';
import { conjugate, fromAxisAngle, rotate } from '../core/math/quat';
import { scale, up } from '../core/math/vec3';
import { headingOf } from '../core/tracking/heading';
import type { TrackedPose, TrackingFrame } from '../core/tracking/tracking-frame';
import { handleFit, wristFromGrip } from './grip-offsets';

/** How a side is tracked at the moment. */
export type InputKind = 'controller' | 'hand' | 'none';

/** XRFrame -> TrackingFrame: the only place that touches XRFrame. */
export interface Tracker {
  /** Head and wrists of this frame, floor frame; null while the head is not seen. Call it before any await of the frame. */
  read(frame: XRFrame, time: number): TrackingFrame | null;
  readonly kinds: Readonly<Record<Side, InputKind>>;
  /** How far trigger or grip button are pressed, 0 to 1; pinching hands have none. */
  readonly squeezed: Readonly<Record<Side, number>>;
  /** Moves the floor's origin under the head, its −Z to where the head looks, as of the last frame read. */
  recentre(): void;
}

/**
 * Reads by handedness, never by index, so that swapped and returning controllers stay where they belong. `onSpace` hears of the
 * reference space that drawing must use too, after each `recentre`.
 */
export function createTracker(
  session: XRSession,
  floor: XRReferenceSpace,
  onSpace?: (space: XRReferenceSpace) => void,
): Tracker {
  let space = floor;
  let lastHead: Pose<'floor'> | null = null;
  const kinds: Record<Side, InputKind> = { left: 'none', right: 'none' };
  const squeezed: Record<Side, number> = { left: 0, right: 0 };

  function readHand(frame: XRFrame, source: XRInputSource, side: Side): TrackedPose | null {
    const wrist = source.hand?.get('wrist');
    if (wrist) {
      kinds[side] = 'hand';
      const pose = frame.getJointPose?.(wrist, space);
      return pose ? toTrackedPose(pose) : null;
    }
    if (!source.gripSpace) return null;
    kinds[side] = 'controller';
    const grip = frame.getPose(source.gripSpace, space);
    if (!grip) return null;
    const tracked = toTrackedPose(grip);
    return tracked && { ...wristFromGrip(tracked, side, handleFit(source.profiles)), tracking: tracked.tracking };
  }

  return {
    kinds,
    squeezed,
    read(frame, time) {
      const viewer = frame.getViewerPose(space);
      const hands: Record<Side, TrackedPose | null> = { left: null, right: null };
      for (const side of ['left', 'right'] as const) {
        kinds[side] = 'none';
        squeezed[side] = 0;
      }
      for (const source of session.inputSources) {
        const side = source.handedness;
        if (side === 'none') continue;
        const pose = readHand(frame, source, side);
        // A device may list a controller that lies on the table beside the hand that left it: what is seen wins.
        if (pose && (hands[side] === null || pose.tracking === 'tracked')) hands[side] = pose;
        const buttons = source.gamepad?.buttons;
        if (buttons) squeezed[side] = Math.max(squeezed[side], buttons[0]?.value ?? 0, buttons[1]?.value ?? 0);
      }
      const head = viewer && toTrackedPose(viewer);
      if (!head) return null;
      lastHead = head;
      return { time, head, leftHand: hands.left, rightHand: hands.right };
    },
    recentre() {
      if (!lastHead) return;
      const turned = headingOf(lastHead.orientation);
      const origin = { ...lastHead.position, y: 0 };
      // The new space's origin in the old one: under the head, turned as it looks.
      space = space.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, turned));
      onSpace?.(space);
      const toNew = conjugate(turned);
      const position = rotate(toNew, scale(origin, -1));
      lastHead = { position: { ...position, y: lastHead.position.y }, orientation: fromAxisAngle(up, 0) };
    },
  };
}

/** Copies the live objects of a frame; a pose with anything that is not finite counts as not seen. */
function toTrackedPose(pose: XRPose): TrackedPose | null {
  const { position: p, orientation: o } = pose.transform;
  if (![p.x, p.y, p.z, o.x, o.y, o.z, o.w].every(Number.isFinite)) return null;
  return {
    position: { x: p.x, y: p.y, z: p.z },
    orientation: { x: o.x, y: o.y, z: o.z, w: o.w },
    tracking: pose.emulatedPosition ? 'emulated' : 'tracked',
  };
}
