import { allReleased, type HandButtons } from '../core/games/button-presses';
import { smoothstep } from '../core/math/damper';
import type { Pose, TrackedPose } from '../core/math/pose';
import { conjugate, fromAxisAngle, multiply, rotate } from '../core/math/quat';
import type { Side } from '../core/math/side';
import { distance, scale, subtract, up } from '../core/math/vec3';
import { headingOf } from '../core/tracking/heading';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { Belief } from './believed';
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

const sides = ['left', 'right'] as const;

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
export const createTracker = (
  session: XRSession,
  floor: XRReferenceSpace,
  onSpace?: (space: XRReferenceSpace) => void,
): Tracker => new SessionTracker(session, floor, onSpace);

class SessionTracker implements Tracker {
  readonly kinds: Record<Side, InputKind> = { left: 'none', right: 'none' };
  readonly buttons: Record<Side, HandButtons> = { left: allReleased, right: allReleased };
  readonly #session: XRSession;
  readonly #onSpace: ((space: XRReferenceSpace) => void) | undefined;
  readonly #held = { controller: false, hand: false };
  readonly #sticks = new TurningSticks();
  readonly #belief = new Belief();
  /** Devices in the order in which they came. */
  readonly #devices = new WeakMap<XRInputSource, number>();
  #deviceCount = 0;
  #space: XRReferenceSpace;
  #lastHead: Pose<'floor'> | null = null;

  constructor(session: XRSession, floor: XRReferenceSpace, onSpace?: (space: XRReferenceSpace) => void) {
    this.#session = session;
    this.#space = floor;
    this.#onSpace = onSpace;
    floor.addEventListener('reset', () => {
      this.#lastHead = null;
      if (this.#space !== floor) this.#moveTo(floor);
    });
  }

  get input(): Tracker['input'] {
    const { controller, hand } = this.#held;
    if (controller && hand) return 'mixed';
    return hand ? 'hands' : 'controllers';
  }

  read(frame: XRFrame, time: number): TrackingFrame | null {
    const viewer = frame.getViewerPose(this.#space);
    const suspended = this.#session.visibilityState !== 'visible';
    if (suspended) this.#sticks.waitForRelease();
    else this.#sticks.watch(this.#session.inputSources);
    const { left, right } = this.#readHands(frame, suspended);
    const head = viewer && toTrackedPose(viewer);
    if (!head) return null;
    this.#lastHead = head;
    return this.#belief.of({ time, head, leftHand: left, rightHand: right, ...(suspended && { suspended }) });
  }

  recentre(): void {
    const head = this.#lastHead;
    if (!head) return;
    const turned = headingOf(head.orientation);
    const origin = { ...head.position, y: 0 };
    // The new space's origin in the old one: under the head, turned as it looks.
    this.#moveTo(this.#space.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, turned)));
    const toNew = conjugate(turned);
    const position = rotate(toNew, scale(origin, -1));
    this.#lastHead = { position: { ...position, y: head.position.y }, orientation: fromAxisAngle(up, 0) };
  }

  turn(angle: number): void {
    const head = this.#lastHead;
    if (!head) return;
    const oldFromNew = fromAxisAngle(up, -angle);
    const under = { ...head.position, y: 0 };
    // The head stays where it is, and everything turns about it.
    const origin = subtract(under, rotate(oldFromNew, under));
    this.#moveTo(this.#space.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, oldFromNew)));
    this.#lastHead = { ...head, orientation: multiply(conjugate(oldFromNew), head.orientation) };
  }

  takeTurn(): -1 | 0 | 1 {
    return this.#sticks.take();
  }

  #moveTo(next: XRReferenceSpace): void {
    this.#space = next;
    this.#onSpace?.(next);
  }

  /** The wrists of this frame; kinds and buttons are those of this frame too. */
  #readHands(frame: XRFrame, suspended: boolean): Record<Side, TrackedPose | null> {
    const { kinds, buttons } = this;
    const hands: Record<Side, TrackedPose | null> = { left: null, right: null };
    for (const side of sides) {
      kinds[side] = 'none';
      buttons[side] = allReleased;
    }
    if (suspended) return hands;
    for (const source of this.#session.inputSources) {
      const side = source.handedness;
      if (side === 'none') continue;
      const pose = this.#readHand(frame, source, side);
      // A device may list a controller that lies on the table beside the hand that left it: what is seen wins.
      if (pose && (hands[side] === null || pose.tracking === 'tracked')) hands[side] = pose;
      const own = source.hand ? this.#pinched(frame, source.hand) : pressed(source.gamepad);
      buttons[side] = { ...more(buttons[side], own), device: this.#deviceOf(source) };
    }
    for (const side of sides) {
      const kind = kinds[side];
      if (kind === 'none') continue;
      this.#held[kind] = true;
      buttons[side] = { ...buttons[side], kind };
    }
    return hands;
  }

  #readHand(frame: XRFrame, source: XRInputSource, side: Side): TrackedPose | null {
    const wrist = source.hand?.get('wrist');
    if (wrist) {
      this.kinds[side] = 'hand';
      const pose = frame.getJointPose?.(wrist, this.#space);
      return pose ? toTrackedPose(pose) : null;
    }
    if (!source.gripSpace) return null;
    this.kinds[side] = 'controller';
    const grip = frame.getPose(source.gripSpace, this.#space);
    if (!grip) return null;
    const tracked = toTrackedPose(grip);
    return tracked && { ...wristFromGrip(tracked, side, handleFit(source.profiles)), tracking: tracked.tracking };
  }

  /** Thumb against index finger; the gamepad of a hand would only say so once it is over. */
  #pinched(frame: XRFrame, hand: XRHand): HandButtons {
    const thumb = this.#fingerTip(frame, hand, 'thumb-tip');
    const index = this.#fingerTip(frame, hand, 'index-finger-tip');
    if (!thumb || !index) return allReleased;
    const gap = distance(thumb, index);
    return { ...allReleased, pinch: Number.isFinite(gap) ? 1 - smoothstep(closedPinch, openPinch, gap) : 0 };
  }

  #fingerTip(frame: XRFrame, hand: XRHand, name: 'thumb-tip' | 'index-finger-tip') {
    const joint = hand.get(name);
    return joint && frame.getJointPose?.(joint, this.#space)?.transform.position;
  }

  #deviceOf(source: XRInputSource): number {
    const known = this.#devices.get(source);
    if (known !== undefined) return known;
    this.#deviceCount += 1;
    this.#devices.set(source, this.#deviceCount);
    return this.#deviceCount;
  }
}

/** Turns by the sticks of a session's controllers: one push to the side is one turn. */
class TurningSticks {
  #pushed = false;
  #wanted: -1 | 0 | 1 = 0;

  watch(sources: XRInputSourceArray): void {
    let furthest = 0;
    for (const { gamepad } of sources) {
      const sideways = gamepad?.axes[2] ?? 0;
      if (Math.abs(sideways) > Math.abs(furthest)) furthest = sideways;
    }
    if (Math.abs(furthest) < stickBack) this.#pushed = false;
    else if (Math.abs(furthest) > stickPushed && !this.#pushed) {
      this.#pushed = true;
      this.#wanted = furthest > 0 ? -1 : 1;
    }
  }

  /** A stick that is pushed now turns only after it was back. */
  waitForRelease(): void {
    this.#pushed = true;
  }

  take(): -1 | 0 | 1 {
    const wanted = this.#wanted;
    this.#wanted = 0;
    return wanted;
  }
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
