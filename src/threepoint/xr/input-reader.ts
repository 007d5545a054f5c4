import type { GripOffsets, HandleFit } from '../core/body/calibration';
import { type HandShape, handShapeFromClosing, makeHandShape } from '../core/body/hand-shape';
import { allReleased, type HandButtons } from '../core/input/button-presses';
import type { TrackedPose } from '../core/math/pose';
import { type Side, sides } from '../core/math/side';
import { ControllerFingers, squeezeButton, triggerButton } from './controller-fingers';
import { adjustedFit, bareHandFit, handleFit, wristFromGrip } from './grip-offsets';
import { HandReader } from './hand-reader';
import type { InputFrame, Pointing, PointingHand } from './pointing';
import { SourceChoice } from './source-choice';
import { toTrackedPose } from './tracked-pose';

const pressedButtons = (gamepad: Gamepad | undefined): HandButtons => ({
  ...allReleased,
  trigger: gamepad?.buttons[triggerButton]?.value ?? 0,
  grip: gamepad?.buttons[squeezeButton]?.value ?? 0,
});

/** Returns the presses of a source. A bare hand has only its pinch, which its gamepad reports not before its end. */
function pressesOf({ isBare, pinch }: PointingHand, { gamepad }: XRInputSource): HandButtons {
  if (!isBare) return pressedButtons(gamepad);
  return Number.isNaN(pinch) ? allReleased : { ...allReleased, pinch };
}

/** The fingers of a hand without joints that does not pinch. */
const openHand = { thumb: 0, index: 0, rest: 0 };

const maximumOf = (a: HandButtons, b: HandButtons): HandButtons => ({
  trigger: Math.max(a.trigger, b.trigger),
  grip: Math.max(a.grip, b.grip),
  pinch: Math.max(a.pinch, b.pinch),
  ...((a.taken || b.taken) && { taken: true }),
});

/** The input that tracks a side. */
export type InputKind = 'controller' | 'hand' | 'none';

const hasJoints = ({ hand }: XRInputSource): boolean => hand?.get('wrist') !== undefined;

/** Returns how a source holds its grip; a hand without joints has the fit of a bare hand, whatever its profiles. */
const fitOf = ({ hand, profiles }: XRInputSource) => (hand ? bareHandFit : handleFit(profiles));

function kindOf(source: XRInputSource): InputKind {
  if (hasJoints(source)) return 'hand';
  if (!source.gripSpace) return 'none';
  return fitOf(source) === bareHandFit ? 'hand' : 'controller';
}

/**
 * Reads wrists, fingers and buttons of a session by handedness, never by index: swapped and returning devices keep
 * their sides.
 */
export class InputReader {
  /** The input that tracked each side in the newest frame. */
  readonly kinds: Record<Side, InputKind> = { left: 'none', right: 'none' };
  /** The button presses of each side in the newest frame; a bare hand has only a pinch. */
  readonly buttons: Record<Side, HandButtons> = { left: allReleased, right: allReleased };
  /** The finger bends of the newest frame, in memory that the next one overwrites. */
  readonly fingers: Record<Side, HandShape | null> = { left: null, right: null };
  /** Reads what the sources point at and press; null: it is not read. */
  readonly pointing: Pointing | null;
  /** The user's offsets, and the fits with them; other offsets are another object. */
  #offsets: GripOffsets = {};
  #fits = new WeakMap<XRInputSource, HandleFit>();
  readonly #session: XRSession;
  readonly #held = { controller: false, hand: false };
  readonly #handReaders = { left: new HandReader('left'), right: new HandReader('right') };
  readonly #controllerFingers = { left: new ControllerFingers(), right: new ControllerFingers() };
  /** The fingers of hands without joints, which pinch or are open. */
  readonly #plainFingers = { left: makeHandShape(), right: makeHandShape() };
  readonly #choices = { left: new SourceChoice(), right: new SourceChoice() };
  /** The sources that select now: the pinches of hands without joints and without a gamepad. */
  readonly #selecting = new WeakSet<XRInputSource>();
  /** The hand of the source that is read, so that a frame makes no object for each. */
  readonly #hand: PointingHand = { wrist: null, isBare: false, pinch: 0, tip: null };
  /** Input sources, numbered in the order in which they appeared. */
  readonly #devices = new WeakMap<XRInputSource, number>();
  #deviceCount = 0;

  constructor(session: XRSession, pointing: Pointing | null = null) {
    this.#session = session;
    this.pointing = pointing;
    session.addEventListener('selectstart', ({ inputSource }) => this.#selecting.add(inputSource));
    session.addEventListener('selectend', ({ inputSource }) => this.#selecting.delete(inputSource));
  }

  /** The inputs used since the session began: 'mixed' where they changed or differed between the sides. */
  get input(): 'controllers' | 'hands' | 'mixed' {
    const { controller, hand } = this.#held;
    if (controller && hand) return 'mixed';
    return hand ? 'hands' : 'controllers';
  }

  /**
   * Returns the wrists of this frame in the space, and updates kinds, buttons, fingers and pointers; null: not seen.
   * While the session is `suspended` behind a menu of the device, no hand is read: it is busy there. `head`: in the
   * space; null: not seen.
   */
  read(now: InputFrame, suspended: boolean): Readonly<Record<Side, TrackedPose | null>> {
    const { kinds, buttons, fingers, pointing } = this;
    const { time } = now;
    pointing?.begin(this.#session.inputSources, suspended);
    const hands: Record<Side, TrackedPose | null> = { left: null, right: null };
    for (const side of sides) {
      kinds[side] = 'none';
      buttons[side] = allReleased;
      fingers[side] = null;
      this.#choices[side].begin(time);
    }
    if (!suspended) for (const source of this.#session.inputSources) this.#readSource(source, now);
    pointing?.finish(suspended);
    if (suspended) return hands;
    for (const side of sides) {
      const chosen = this.#choices[side].best;
      if (chosen) {
        hands[side] = chosen.pose;
        kinds[side] = kindOf(chosen.source);
        fingers[side] = this.#shapeOf(chosen.source, side, time);
        buttons[side] = { ...buttons[side], device: this.#deviceOf(chosen.source) };
      }
      const kind = kinds[side];
      if (kind === 'none') continue;
      this.#held[kind] = true;
      buttons[side] = { ...buttons[side], kind };
    }
    return hands;
  }

  #readSource(source: XRInputSource, now: InputFrame): void {
    const { kinds, buttons, pointing } = this;
    const { frame, space, time } = now;
    const side = source.handedness;
    if (side === 'none' || this.#repeatsHand(source)) {
      pointing?.read(source, now);
      return;
    }
    const pose = this.#readHand(frame, space, source, time);
    const kind = kindOf(source);
    if (pose) this.#choices[side].offer({ source, pose, isHand: kind === 'hand' });
    if (kinds[side] === 'none') kinds[side] = kind;
    const device = buttons[side].device ?? this.#deviceOf(source);
    const hand = this.#hand;
    hand.wrist = pose;
    hand.isBare = kind === 'hand';
    hand.pinch = hand.isBare ? this.#pinchOf(source, side) : 0;
    hand.tip = hasJoints(source) && pose ? this.#handReaders[side].indexTip : null;
    const taken = pointing?.readHand(source, now, hand);
    buttons[side] = {
      ...maximumOf(buttons[side], taken ? { ...allReleased, taken } : pressesOf(hand, source)),
      device,
    };
  }

  /**
   * Returns whether a source is the transient pointer of a pinch whose hand the device reports as well: the hand has
   * all of it.
   */
  #repeatsHand({ targetRayMode, handedness }: XRInputSource): boolean {
    if (targetRayMode !== 'transient-pointer') return false;
    for (const other of this.#session.inputSources) {
      if (other.handedness === handedness && other.targetRayMode !== 'transient-pointer') return true;
    }
    return false;
  }

  #readHand(frame: XRFrame, space: XRReferenceSpace, source: XRInputSource, time: number): TrackedPose | null {
    const side = source.handedness as Side;
    if (source.hand && hasJoints(source)) return this.#handReaders[side].read(frame, source.hand, space, time);
    if (!source.gripSpace) return null;
    const grip = frame.getPose(source.gripSpace, space);
    if (!grip) return null;
    const tracked = toTrackedPose(grip);
    return tracked && { ...wristFromGrip(tracked, side, this.#fitOf(source, side)), tracking: tracked.tracking };
  }

  /** Sets the user's offsets of controllers. */
  setGripOffsets(offsets: GripOffsets): void {
    if (offsets === this.#offsets) return;
    this.#offsets = offsets;
    this.#fits = new WeakMap();
  }

  #fitOf(source: XRInputSource, side: Side): HandleFit {
    const known = this.#fits.get(source);
    if (known) return known;
    const base = fitOf(source);
    const fit = base === bareHandFit ? base : adjustedFit(base, source.profiles, side, this.#offsets);
    this.#fits.set(source, fit);
    return fit;
  }

  /** Returns the pinch of a bare hand, 0 to 1; NaN: its fingers are not seen. */
  #pinchOf(source: XRInputSource, side: Side): number {
    return hasJoints(source) ? this.#handReaders[side].pinch : this.#selected(source);
  }

  #selected(source: XRInputSource): number {
    return this.#selecting.has(source) ? 1 : pressedButtons(source.gamepad).trigger;
  }

  #shapeOf(source: XRInputSource, side: Side, time: number): HandShape {
    if (hasJoints(source)) return this.#handReaders[side].shape;
    if (kindOf(source) === 'controller') return this.#controllerFingers[side].read(source.gamepad, time);
    return handShapeFromClosing({ ...openHand, pinch: this.#selected(source) }, this.#plainFingers[side]);
  }

  #deviceOf(source: XRInputSource): number {
    const known = this.#devices.get(source);
    if (known !== undefined) return known;
    this.#deviceCount += 1;
    this.#devices.set(source, this.#deviceCount);
    return this.#deviceCount;
  }
}
