import type { HandShape } from '../core/body/hand-shape';
import { allReleased, type HandButtons } from '../core/input/button-presses';
import type { Pose, TrackedPose } from '../core/math/pose';
import { conjugate, fromAxisAngle, multiply, rotate } from '../core/math/quat';
import { type Side, sides } from '../core/math/side';
import { subtract, up } from '../core/math/vec3';
import { headingOf } from '../core/tracking/heading';
import type { TrackingFrame } from '../core/tracking/tracking-frame';
import { Belief } from './believed';
import { ControllerFingers, squeezeButton, triggerButton } from './controller-fingers';
import type { DeviceBodyReader } from './device-body-reader';
import { handleFit, wristFromGrip } from './grip-offsets';
import { HandReader } from './hand-reader';
import { toTrackedPose } from './tracked-pose';

const pressed = (gamepad: Gamepad | undefined): HandButtons => ({
  ...allReleased,
  trigger: gamepad?.buttons[triggerButton]?.value ?? 0,
  grip: gamepad?.buttons[squeezeButton]?.value ?? 0,
});

const more = (a: HandButtons, b: HandButtons): HandButtons => ({
  trigger: Math.max(a.trigger, b.trigger),
  grip: Math.max(a.grip, b.grip),
  pinch: Math.max(a.pinch, b.pinch),
});

/** How a side is tracked at the moment. */
export type InputKind = 'controller' | 'hand' | 'none';

const kindOf = ({ hand, gripSpace }: XRInputSource): InputKind =>
  hand?.get('wrist') ? 'hand' : gripSpace ? 'controller' : 'none';

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
  /** Whether a stick was pressed down since the last call. */
  takePress(): boolean;
  /** Ends what it listens to: the session is over, or read by another tracker. */
  dispose(): void;
}

/** A stick pushed this far to the side turns, and may turn again once it is back below the second. */
const stickPushed = 0.7;
const stickBack = 0.35;
/** Where a stick's own button is among those of an “xr-standard” gamepad. */
const stickButton = 3;

/**
 * Reads by handedness, never by index, so that swapped and returning controllers stay where they belong. `onSpace` hears of the
 * reference space that drawing must use too, after each `recentre` and `turn`. When the device recentres by itself, what was turned
 * here before is forgotten. Behind a menu of the device (session not `visible`) no hand is read: it is busy there. `bodyReader` reads the
 * device's own body into each frame; without it none is read.
 */
export const createTracker = (
  session: XRSession,
  floor: XRReferenceSpace,
  onSpace?: (space: XRReferenceSpace) => void,
  bodyReader: DeviceBodyReader | null = null,
): Tracker => new SessionTracker(session, floor, bodyReader, onSpace);

class SessionTracker implements Tracker {
  readonly kinds: Record<Side, InputKind> = { left: 'none', right: 'none' };
  readonly buttons: Record<Side, HandButtons> = { left: allReleased, right: allReleased };
  readonly #session: XRSession;
  readonly #onSpace: ((space: XRReferenceSpace) => void) | undefined;
  readonly #bodyReader: DeviceBodyReader | null;
  readonly #held = { controller: false, hand: false };
  readonly #sticks = new Sticks();
  readonly #belief = new Belief();
  readonly #fingers: Record<Side, HandShape | null> = { left: null, right: null };
  readonly #handReaders = { left: new HandReader('left'), right: new HandReader('right') };
  readonly #controllerFingers = { left: new ControllerFingers(), right: new ControllerFingers() };
  /** Devices in the order in which they came. */
  readonly #devices = new WeakMap<XRInputSource, number>();
  #deviceCount = 0;
  readonly #floor: XRReferenceSpace;
  #space: XRReferenceSpace;
  #lastHead: Pose<'floor'> | null = null;
  readonly #reset = () => {
    this.#lastHead = null;
    if (this.#space !== this.#floor) this.#moveTo(this.#floor);
  };

  constructor(
    session: XRSession,
    floor: XRReferenceSpace,
    bodyReader: DeviceBodyReader | null,
    onSpace?: (space: XRReferenceSpace) => void,
  ) {
    this.#session = session;
    this.#bodyReader = bodyReader;
    this.#floor = floor;
    this.#space = floor;
    this.#onSpace = onSpace;
    floor.addEventListener('reset', this.#reset);
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
    const { left, right } = this.#readHands(frame, suspended, time);
    const head = viewer && toTrackedPose(viewer);
    if (!head) return null;
    this.#lastHead = head;
    const deviceBody = this.#bodyReader?.read(frame, this.#space);
    const poses = { time, head, leftHand: left, rightHand: right, fingers: this.#fingers };
    return this.#belief.of({ ...poses, ...(deviceBody && { deviceBody }), ...(suspended && { suspended }) });
  }

  recentre(): void {
    const head = this.#lastHead;
    if (!head) return;
    const turned = headingOf(head.orientation);
    const origin = { ...head.position, y: 0 };
    // The new space's origin in the old one: under the head, turned as it looks.
    this.#moveTo(this.#space.getOffsetReferenceSpace(new XRRigidTransform({ ...origin, w: 1 }, turned)));
    const { y } = head.position;
    this.#lastHead = { position: { x: 0, y, z: 0 }, orientation: multiply(conjugate(turned), head.orientation) };
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

  takePress(): boolean {
    return this.#sticks.takePress();
  }

  dispose(): void {
    this.#floor.removeEventListener('reset', this.#reset);
  }

  #moveTo(next: XRReferenceSpace): void {
    this.#space = next;
    this.#onSpace?.(next);
  }

  /** The wrists of this frame; kinds and buttons are those of this frame too. */
  #readHands(frame: XRFrame, suspended: boolean, time: number): Record<Side, TrackedPose | null> {
    const { kinds, buttons } = this;
    const fingers = this.#fingers;
    const hands: Record<Side, TrackedPose | null> = { left: null, right: null };
    for (const side of sides) {
      kinds[side] = 'none';
      buttons[side] = allReleased;
      fingers[side] = null;
    }
    if (suspended) return hands;
    for (const source of this.#session.inputSources) {
      const side = source.handedness;
      if (side === 'none' || this.#tellsOfHandAgain(source)) continue;
      const pose = this.#readHand(frame, source, side, time);
      // A device may list a controller that lies on the table beside the hand that left it: what is seen wins.
      const wins = pose !== null && (hands[side] === null || pose.tracking === 'tracked');
      if (wins) {
        hands[side] = pose;
        fingers[side] = this.#shapeOf(source, side, time);
      }
      const kind = wins || kinds[side] === 'none' ? kindOf(source) : kinds[side];
      const device = wins ? this.#deviceOf(source) : (buttons[side].device ?? this.#deviceOf(source));
      kinds[side] = kind;
      buttons[side] = { ...more(buttons[side], this.#pressedBy(source, side)), device };
    }
    for (const side of sides) {
      const kind = kinds[side];
      if (kind === 'none') continue;
      this.#held[kind] = true;
      buttons[side] = { ...buttons[side], kind };
    }
    return hands;
  }

  /** A pinch that a device tells of as a pointer of its own, for as long as it lasts: where it tells of the hand as well, that has it all. */
  #tellsOfHandAgain({ targetRayMode, handedness }: XRInputSource): boolean {
    if (targetRayMode !== 'transient-pointer') return false;
    for (const other of this.#session.inputSources) {
      if (other.handedness === handedness && other.targetRayMode !== 'transient-pointer') return true;
    }
    return false;
  }

  #readHand(frame: XRFrame, source: XRInputSource, side: Side, time: number): TrackedPose | null {
    if (source.hand?.get('wrist')) return this.#handReaders[side].read(frame, source.hand, this.#space, time);
    if (!source.gripSpace) return null;
    const grip = frame.getPose(source.gripSpace, this.#space);
    if (!grip) return null;
    const tracked = toTrackedPose(grip);
    return tracked && { ...wristFromGrip(tracked, side, handleFit(source.profiles)), tracking: tracked.tracking };
  }

  /** What a source that was just read presses: of a bare hand the pinch; its gamepad would only say so once it is over. */
  #pressedBy(source: XRInputSource, side: Side): HandButtons {
    if (!source.hand) return pressed(source.gamepad);
    const { pinch } = this.#handReaders[side];
    return Number.isNaN(pinch) ? allReleased : { ...allReleased, pinch };
  }

  #shapeOf(source: XRInputSource, side: Side, time: number): HandShape {
    return source.hand ? this.#handReaders[side].shape : this.#controllerFingers[side].read(source.gamepad, time);
  }

  #deviceOf(source: XRInputSource): number {
    const known = this.#devices.get(source);
    if (known !== undefined) return known;
    this.#deviceCount += 1;
    this.#devices.set(source, this.#deviceCount);
    return this.#deviceCount;
  }
}

/** The sticks of a session's controllers: one push to the side is one turn, and one press is one press. */
class Sticks {
  #pushed = false;
  #wanted: -1 | 0 | 1 = 0;
  #down = false;
  #pressed = false;

  watch(sources: XRInputSourceArray): void {
    let furthest = 0;
    let down = false;
    for (const { gamepad } of sources) {
      down ||= gamepad?.buttons[stickButton]?.pressed ?? false;
      const sideways = gamepad?.axes[2] ?? 0;
      if (Math.abs(sideways) > Math.abs(furthest)) furthest = sideways;
    }
    if (down && !this.#down) this.#pressed = true;
    this.#down = down;
    if (Math.abs(furthest) < stickBack) this.#pushed = false;
    else if (Math.abs(furthest) > stickPushed && !this.#pushed) {
      this.#pushed = true;
      this.#wanted = furthest > 0 ? -1 : 1;
    }
  }

  /** A stick that is pushed now turns only after it was back. */
  waitForRelease(): void {
    this.#pushed = true;
    this.#down = true;
  }

  takePress(): boolean {
    const pressed = this.#pressed;
    this.#pressed = false;
    return pressed;
  }

  take(): -1 | 0 | 1 {
    const wanted = this.#wanted;
    this.#wanted = 0;
    return wanted;
  }
}
