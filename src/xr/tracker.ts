import { allReleased, type HandButtons } from '../core/games/button-presses';
import { smoothstep } from '../core/math/damper';
import type { Pose, TrackedPose } from '../core/math/pose';
import { conjugate, fromAxisAngle, multiply, rotate } from '../core/math/quat';
import type { Side } from '../core/math/side';
import { distance, scale, subtract, up } from '../core/math/vec3';
import { headingOf } from '../core/tracking/heading';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { handleFit, wristFromGrip } from './grip-offsets';

/** Tips of thumb and index finger this near are a full pinch, this far are none [m]. */
const closedPinch = 0.012;
const openPinch = 0.05;

/** WebXR's standard mapping: the first button is the trigger, the second the squeeze. */
const pressed = (gamepad: Gamepad | undefined): HandButtons => ({
  ...allReleased,
  trigger: gamepad?.buttons[0]?.value ?? 0,
  grip: gamepad?.buttons[1]?.value ?? 0,
});

const more = (a: HandButtons, b: HandButtons): HandButtons => ({
  trigger: Math.max(a.trigger, b.trigger),
  grip: Math.max(a.grip, b.grip),
  pinch: Math.max(a.pinch, b.pinch),
});

/** How a side is tracked at the moment. */
export type InputKind = 'controller' | 'hand' | 'none';

/** XRFrame -> TrackingFrame: the only place that touches XRFrame. */
export interface Tracker {
  /** Head and wrists of this frame, floor frame; null while the head is not seen. Call it before any await of the frame. */
  read(frame: XRFrame, time: number): TrackingFrame | null;
  readonly kinds: Readonly<Record<Side, InputKind>>;
  /** What both sides held until now, since the session began: mixed where it changed or differed. */
  readonly input: 'controllers' | 'hands' | 'mixed';
  /** How far the buttons of each side are pressed; a bare hand has a pinch and nothing else. */
  readonly buttons: Readonly<Record<Side, HandButtons>>;
  /** Moves the floor's origin under the head, its −Z to where the head looks, as of the last frame read. */
  recentre(): void;
  /** Turns the floor about the head by this angle [rad], to the left where it is above 0, as of the last frame read. */
  turn(angle: number): void;
  /** Which way a stick was pushed since the last call: 1 left, −1 right, 0 neither. One push is one turn. */
  takeTurn(): -1 | 0 | 1;
}

/** A stick pushed this far to the side turns, and may turn again once it is back below the second. */
const stickPushed = 0.7;
const stickBack = 0.35;

/**
 * Reads by handedness, never by index, so that swapped and returning controllers stay where they belong. `onSpace` hears of the
 * reference space that drawing must use too, after each `recentre` and `turn`. When the device recentres by itself, what was turned
 * here before is forgotten. Behind a menu of the device (session not `visible`) no hand is read: it is busy there.
 */
export function createTracker(
  session: XRSession,
  floor: XRReferenceSpace,
  onSpace?: (space: XRReferenceSpace) => void,
): Tracker {
  let space = floor;
  let lastHead: Pose<'floor'> | null = null;
  /** Devices in the order in which they came. */
  const devices = new WeakMap<XRInputSource, number>();
  let deviceCount = 0;
  let pushed = false;
  let turnWanted: -1 | 0 | 1 = 0;

  function deviceOf(source: XRInputSource): number {
    const known = devices.get(source);
    if (known !== undefined) return known;
    deviceCount += 1;
    devices.set(source, deviceCount);
    return deviceCount;
  }

  function moveTo(next: XRReferenceSpace): void {
    space = next;
    onSpace?.(next);
  }
  floor.addEventListener('reset', () => {
    lastHead = null;
    if (space !== floor) moveTo(floor);
  });

  function watchSticks(): void {
    const sideways = Array.from(session.inputSources, ({ gamepad }) => gamepad?.axes[2] ?? 0);
    const furthest = sideways.reduce((most, x) => (Math.abs(x) > Math.abs(most) ? x : most), 0);
    if (Math.abs(furthest) < stickBack) pushed = false;
    else if (Math.abs(furthest) > stickPushed && !pushed) {
      pushed = true;
      turnWanted = furthest > 0 ? -1 : 1;
    }
  }
  const kinds: Record<Side, InputKind> = { left: 'none', right: 'none' };
  const buttons: Record<Side, HandButtons> = { left: allReleased, right: allReleased };
  const held = { controller: false, hand: false };

  /** Thumb against index finger; the gamepad of a hand would only say so once it is over. */
  function pinched(frame: XRFrame, hand: XRHand): HandButtons {
    const tip = (name: 'thumb-tip' | 'index-finger-tip') => {
      const joint = hand.get(name);
      return joint && frame.getJointPose?.(joint, space)?.transform.position;
    };
    const thumb = tip('thumb-tip');
    const index = tip('index-finger-tip');
    if (!thumb || !index) return allReleased;
    const gap = distance(thumb, index);
    return { ...allReleased, pinch: Number.isFinite(gap) ? 1 - smoothstep(closedPinch, openPinch, gap) : 0 };
  }

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
    buttons,
    get input() {
      if (held.controller && held.hand) return 'mixed';
      return held.hand ? 'hands' : 'controllers';
    },
    read(frame, time) {
      const viewer = frame.getViewerPose(space);
      const hands: Record<Side, TrackedPose | null> = { left: null, right: null };
      for (const side of ['left', 'right'] as const) {
        kinds[side] = 'none';
        buttons[side] = allReleased;
      }
      const suspended = session.visibilityState !== 'visible';
      if (suspended) pushed = true;
      else watchSticks();
      for (const source of suspended ? [] : session.inputSources) {
        const side = source.handedness;
        if (side === 'none') continue;
        const pose = readHand(frame, source, side);
        // A device may list a controller that lies on the table beside the hand that left it: what is seen wins.
        if (pose && (hands[side] === null || pose.tracking === 'tracked')) hands[side] = pose;
        const own = source.hand ? pinched(frame, source.hand) : pressed(source.gamepad);
        buttons[side] = { ...more(buttons[side], own), device: deviceOf(source) };
      }
      for (const side of ['left', 'right'] as const) {
        const kind = kinds[side];
        if (kind === 'none') continue;
        held[kind] = true;
        buttons[side] = { ...buttons[side], kind };
      }
      const head = viewer && toTrackedPose(viewer);
      if (!head) return null;
      lastHead = head;
      return { time, head, leftHand: hands.left, rightHand: hands.right, ...(suspended && { suspended }) };
    },
    recentre() {
      if (!lastHead) return;
      const turned = headingOf(lastHead.orientation);
      const origin = { ...lastHead.position, y: 0 };
      // The new space's origin in the old one: under the head, turned as it looks.
      moveTo(space.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, turned)));
      const toNew = conjugate(turned);
      const position = rotate(toNew, scale(origin, -1));
      lastHead = { position: { ...position, y: lastHead.position.y }, orientation: fromAxisAngle(up, 0) };
    },
    turn(angle) {
      if (!lastHead) return;
      const oldFromNew = fromAxisAngle(up, -angle);
      const under = { ...lastHead.position, y: 0 };
      // The head stays where it is, and everything turns about it.
      const origin = subtract(under, rotate(oldFromNew, under));
      moveTo(space.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, oldFromNew)));
      lastHead = { ...lastHead, orientation: multiply(conjugate(oldFromNew), lastHead.orientation) };
    },
    takeTurn() {
      const wanted = turnWanted;
      turnWanted = 0;
      return wanted;
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
