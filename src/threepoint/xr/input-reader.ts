import type { HandShape } from '../core/body/hand-shape';
import { allReleased, type HandButtons } from '../core/input/button-presses';
import type { TrackedPose } from '../core/math/pose';
import { type Side, sides } from '../core/math/side';
import { ControllerFingers, squeezeButton, triggerButton } from './controller-fingers';
import { handleFit, wristFromGrip } from './grip-offsets';
import { HandReader } from './hand-reader';
import { toTrackedPose } from './tracked-pose';

const pressedButtons = (gamepad: Gamepad | undefined): HandButtons => ({
  ...allReleased,
  trigger: gamepad?.buttons[triggerButton]?.value ?? 0,
  grip: gamepad?.buttons[squeezeButton]?.value ?? 0,
});

const maximumOf = (a: HandButtons, b: HandButtons): HandButtons => ({
  trigger: Math.max(a.trigger, b.trigger),
  grip: Math.max(a.grip, b.grip),
  pinch: Math.max(a.pinch, b.pinch),
});

/** How a side is tracked. */
export type InputKind = 'controller' | 'hand' | 'none';

const kindOf = ({ hand, gripSpace }: XRInputSource): InputKind =>
  hand?.get('wrist') ? 'hand' : gripSpace ? 'controller' : 'none';

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
  /** Input sources, numbered in the order in which they appeared. */
  readonly #devices = new WeakMap<XRInputSource, number>();
  #deviceCount = 0;

  constructor(session: XRSession) {
    this.#session = session;
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
    }
    if (suspended) return hands;
    for (const source of this.#session.inputSources) {
      const side = source.handedness;
      if (side === 'none' || this.#repeatsHand(source)) continue;
      const pose = this.#readHand(frame, space, source, time);
      // A device may list a controller on the table as well as the hand that left it: the source that is seen wins.
      const wins = pose !== null && (hands[side] === null || pose.tracking === 'tracked');
      if (wins) {
        hands[side] = pose;
        fingers[side] = this.#shapeOf(source, side, time);
      }
      const kind = wins || kinds[side] === 'none' ? kindOf(source) : kinds[side];
      const device = wins ? this.#deviceOf(source) : (buttons[side].device ?? this.#deviceOf(source));
      kinds[side] = kind;
      buttons[side] = { ...maximumOf(buttons[side], this.#pressedBy(source, side)), device };
    }
    for (const side of sides) {
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
    if (source.hand?.get('wrist')) return this.#handReaders[side].read(frame, source.hand, space, time);
    if (!source.gripSpace) return null;
    const grip = frame.getPose(source.gripSpace, space);
    if (!grip) return null;
    const tracked = toTrackedPose(grip);
    return tracked && { ...wristFromGrip(tracked, side, handleFit(source.profiles)), tracking: tracked.tracking };
  }

  /**
   * Returns the buttons of a source that was just read; a bare hand has its pinch, which its gamepad reports only at
   * its end.
   */
  #pressedBy(source: XRInputSource, side: Side): HandButtons {
    if (!source.hand) return pressedButtons(source.gamepad);
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
