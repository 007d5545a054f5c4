import { type HandShape, makeHandShape, shapeOfClosing } from '../core/body/hand-shape';
import { allReleased, type HandButtons } from '../core/input/button-presses';
import type { TrackedPose } from '../core/math/pose';
import { type Side, sides } from '../core/math/side';
import { ControllerFingers, squeezeButton, triggerButton } from './controller-fingers';
import { bareHandFit, handleFit, wristFromGrip } from './grip-offsets';
import { HandReader } from './hand-reader';
import { SourceChoice } from './source-choice';
import { toTrackedPose } from './tracked-pose';

const pressedButtons = (gamepad: Gamepad | undefined): HandButtons => ({
  ...allReleased,
  trigger: gamepad?.buttons[triggerButton]?.value ?? 0,
  grip: gamepad?.buttons[squeezeButton]?.value ?? 0,
});

/** The fingers of a hand without joints that does not pinch. */
const openHand = { thumb: 0, index: 0, rest: 0 };

const maximumOf = (a: HandButtons, b: HandButtons): HandButtons => ({
  trigger: Math.max(a.trigger, b.trigger),
  grip: Math.max(a.grip, b.grip),
  pinch: Math.max(a.pinch, b.pinch),
});

/** How a side is tracked. */
export type InputKind = 'controller' | 'hand' | 'none';

const hasJoints = ({ hand }: XRInputSource): boolean => hand?.get('wrist') !== undefined;

/** Returns how a source holds its grip; a hand without joints has the fit of a bare hand, whatever its profiles. */
const fitOf = ({ hand, profiles }: XRInputSource) => (hand ? bareHandFit : handleFit(profiles));

function kindOf(source: XRInputSource): InputKind {
  if (hasJoints(source)) return 'hand';
  if (!source.gripSpace) return 'none';
  return fitOf(source) === bareHandFit ? 'hand' : 'controller';
}

/** A stick pushed this far to the side turns, and may turn again once it is back below the second. */
const stickPushed = 0.7;
const stickBack = 0.35;
/** The index of a stick's button in an “xr-standard” gamepad. */
const stickButton = 3;

/**
 * Reads wrists, fingers and buttons of a session by handedness, never by index: swapped and returning devices keep
 * their sides.
 */
export class InputReader {
  /** How each side was tracked in the newest frame. */
  readonly kinds: Record<Side, InputKind> = { left: 'none', right: 'none' };
  /** How far the buttons of each side were pressed in the newest frame; a bare hand has a pinch and nothing else. */
  readonly buttons: Record<Side, HandButtons> = { left: allReleased, right: allReleased };
  /** The finger bends of the newest frame, in memory that the next one overwrites. */
  readonly fingers: Record<Side, HandShape | null> = { left: null, right: null };
  readonly #session: XRSession;
  readonly #held = { controller: false, hand: false };
  readonly #sticks = new Sticks();
  readonly #handReaders = { left: new HandReader('left'), right: new HandReader('right') };
  readonly #controllerFingers = { left: new ControllerFingers(), right: new ControllerFingers() };
  /** The fingers of hands without joints, which pinch or are open. */
  readonly #plainFingers = { left: makeHandShape(), right: makeHandShape() };
  readonly #choices = { left: new SourceChoice(), right: new SourceChoice() };
  /** The sources that select now: the pinches of hands without joints and without a gamepad. */
  readonly #selecting = new WeakSet<XRInputSource>();
  /** Input sources, numbered in the order in which they appeared. */
  readonly #devices = new WeakMap<XRInputSource, number>();
  #deviceCount = 0;

  constructor(session: XRSession) {
    this.#session = session;
    session.addEventListener('selectstart', ({ inputSource }) => this.#selecting.add(inputSource));
    session.addEventListener('selectend', ({ inputSource }) => this.#selecting.delete(inputSource));
  }

  /** The inputs used since the session began: 'mixed' where they changed or differed between the sides. */
  get input(): 'controllers' | 'hands' | 'mixed' {
    const { controller, hand } = this.#held;
    if (controller && hand) return 'mixed';
    return hand ? 'hands' : 'controllers';
  }

  /** Returns −1 or 1 once for each push of a stick to the right or left; else 0. */
  takeTurn(): -1 | 0 | 1 {
    return this.#sticks.take();
  }

  /** Returns whether a stick was pressed down since the last call. */
  takePress(): boolean {
    return this.#sticks.takePress();
  }

  /**
   * Returns the wrists of this frame in the space, and updates kinds, buttons and fingers; null: not seen. While the
   * session is `suspended` behind a menu of the device, no hand is read: it is busy there.
   */
  read(
    frame: XRFrame,
    space: XRReferenceSpace,
    time: number,
    suspended: boolean,
  ): Readonly<Record<Side, TrackedPose | null>> {
    const { kinds, buttons, fingers } = this;
    if (suspended) this.#sticks.waitForRelease();
    else this.#sticks.watch(this.#session.inputSources);
    const hands: Record<Side, TrackedPose | null> = { left: null, right: null };
    for (const side of sides) {
      kinds[side] = 'none';
      buttons[side] = allReleased;
      fingers[side] = null;
      this.#choices[side].begin(time);
    }
    if (suspended) return hands;
    for (const source of this.#session.inputSources) {
      const side = source.handedness;
      if (side === 'none' || this.#repeatsHand(source)) continue;
      const pose = this.#readHand(frame, space, source, time);
      const kind = kindOf(source);
      if (pose) this.#choices[side].offer({ source, pose, isHand: kind === 'hand' });
      if (kinds[side] === 'none') kinds[side] = kind;
      const device = buttons[side].device ?? this.#deviceOf(source);
      buttons[side] = { ...maximumOf(buttons[side], this.#pressedBy(source, side)), device };
    }
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
    return tracked && { ...wristFromGrip(tracked, side, fitOf(source)), tracking: tracked.tracking };
  }

  /**
   * Returns the buttons of a source that was just read; a bare hand has its pinch, which its gamepad reports only at
   * its end.
   */
  #pressedBy(source: XRInputSource, side: Side): HandButtons {
    if (kindOf(source) !== 'hand') return pressedButtons(source.gamepad);
    const pinch = hasJoints(source) ? this.#handReaders[side].pinch : this.#selected(source);
    return Number.isNaN(pinch) ? allReleased : { ...allReleased, pinch };
  }

  #selected(source: XRInputSource): number {
    return this.#selecting.has(source) ? 1 : pressedButtons(source.gamepad).trigger;
  }

  #shapeOf(source: XRInputSource, side: Side, time: number): HandShape {
    if (hasJoints(source)) return this.#handReaders[side].shape;
    if (kindOf(source) === 'controller') return this.#controllerFingers[side].read(source.gamepad, time);
    return shapeOfClosing({ ...openHand, pinch: this.#selected(source) }, this.#plainFingers[side]);
  }

  #deviceOf(source: XRInputSource): number {
    const known = this.#devices.get(source);
    if (known !== undefined) return known;
    this.#deviceCount += 1;
    this.#devices.set(source, this.#deviceCount);
    return this.#deviceCount;
  }
}

/** Detects pushes to the side and presses of the controllers' sticks. */
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

  /** Ignores sticks that are pushed or pressed now until they were released. */
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
