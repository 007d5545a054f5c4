import type { Button } from 'threepoint/core/input/button-presses';
import { clamp, damp, smoothingFactor, smoothstep } from 'threepoint/core/math/damper';
import { makePose, type Pose } from 'threepoint/core/math/pose';
import type { Side } from 'threepoint/core/math/side';
import {
  addScaled,
  copyVec3,
  dot,
  length,
  type MutableVec3,
  normalise,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/core/math/vec3';
import type { BowView } from './archery-state';
import { braceHeight, maximumDraw } from './bow';
import { arrowRestOf, forwardOf, turnBow, turnTowards } from './bow-hand';

/** The direction of a drawn arrow goes half the way to where the hands point in this time [s]. */
export const aimHalfLife = 0.05;
/** The same for one hand, which trembles more [s]. */
export const oneHandedAimHalfLife = 0.08;
/** One-handed: growth of the draw [m/s] and where it ends [m]. */
export const oneHandedDrawSpeed = 0.5;
export const oneHandedDraw = 0.6;

/** Below the first the bow's hand aims, above the second both hands do, between them some of each [m of draw]. */
const handAims = 0.03;
const lineAims = 0.15;
/** The string leaves the stage `nocked` at this draw [m]. */
const drawingFrom = 0.05;
/** Anchored: at least this draw [m], changing more slowly than this [m/s] for this long [s]; until it changes by this much [m]. */
const anchorDraw = 0.25;
const anchorSpeed = 0.12;
const anchorSeconds = 0.15;
const anchorSlack = 0.05;
const drawSpeedHalfLife = 0.03;
/** The string hand feels every centimetre and a half; the bow creaks every six [m]. */
const hapticNotch = 0.015;
const creakNotch = 0.06;

// Memory of one call: a frame makes no garbage.
const held = vec3(0, 0, 0);
const line = vec3(0, 0, 0);
const goal = vec3(0, 0, 0);
const rest = vec3(0, 0, 0);
const turned = makePose<'floor'>();

/** An arrow on the string, from the press that nocks it to its release; floor frame. `inHand`: the bow as the hand holds it. */
export class NockedArrow {
  stage: Exclude<BowView['stage'], 'empty'> = 'nocked';
  /** Beyond brace height [m]. */
  draw = 0;
  /** Unit: where the arrow points. */
  readonly direction: MutableVec3;
  /** Time of the first frame that missed a hand [s]; null: both seen. */
  lostAt: number | null = null;
  /** An opened pinch counts with the next frame that sees the hand: fingers also seem to open when a camera loses them. */
  opened = false;
  /** `direction` is one of a floor that lay elsewhere. */
  #jumped = false;
  #drawSpeed = 0;
  /** Seconds for which the draw has been steady, and the draw at which it anchored. */
  #steady = 0;
  #anchoredAt = 0;
  #feltDraw = 0;
  #creakedDraw = 0;

  constructor(
    /** What holds it, and of which hand. */
    readonly button: Button,
    readonly side: Side,
    direction: Vec3,
  ) {
    this.direction = copyVec3(direction);
  }

  /** The string goes where the fist of the string hand is. true: with this frame the draw is anchored. */
  drawWithHand(inHand: Pose<'floor'>, fist: Vec3, delta: number): boolean {
    const { direction } = this;
    this.#leap(forwardOf(inHand, held));
    const reference = this.draw < drawingFrom ? held : direction;
    // The arrow rest lies above the fist at right angles to the arrow, whichever way the knuckles point.
    normalise(subtract(arrowRestOf(inHand, rest), fist, line), reference, line);
    subtract(arrowRestOf(turnBow(inHand, line, turned), rest), fist, line);
    const behind = dot(line, reference) > 0;
    const draw = behind ? clamp(length(line) - braceHeight, 0, maximumDraw) : 0;
    const share = smoothstep(handAims, lineAims, draw);
    if (behind) turnTowards(held, normalise(line, undefined, line), share, goal);
    else copyVec3(held, goal);
    turnTowards(direction, goal, this.#smoothing(aimHalfLife * share, delta), direction);
    if (delta > 0) this.#drawSpeed = damp(this.#drawSpeed, (draw - this.draw) / delta, drawSpeedHalfLife, delta);
    this.draw = draw;
    return this.#settle(delta);
  }

  /** The draw grows while the button is held, and the bow's hand aims. true: with this frame the draw is anchored. */
  drawWithButton(inHand: Pose<'floor'>, delta: number): boolean {
    this.#leap(forwardOf(inHand, held));
    turnTowards(this.direction, held, this.#smoothing(oneHandedAimHalfLife, delta), this.direction);
    this.draw = Math.min(oneHandedDraw, this.draw + oneHandedDrawSpeed * delta);
    if (this.draw < oneHandedDraw) this.stage = this.#stageOfDraw();
    else if (this.stage !== 'anchored') return this.#anchor();
    return false;
  }

  /** The floor lies elsewhere from the next frame on: the arrow is there at once where the hands point. */
  jumped(): void {
    this.#jumped = true;
  }

  /** The hand that was lost is back. */
  resume(): void {
    this.lostAt = null;
    this.stage = this.#stageOfDraw();
  }

  /** Where the nock is: behind the arrow rest, so that the arrow always passes the bow where it lies on it. */
  nock(inHand: Pose<'floor'>, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
    arrowRestOf(turnBow(inHand, this.direction, turned), target);
    return addScaled(target, this.direction, -braceHeight - this.draw, target);
  }

  /** Whether the draw has changed by another notch that the string hand feels. */
  passesHapticNotch(): boolean {
    if (!(Math.abs(this.draw - this.#feltDraw) >= hapticNotch)) return false;
    this.#feltDraw = this.draw;
    return true;
  }

  /** Whether the draw has grown by another notch at which the bow creaks. */
  passesCreakNotch(): boolean {
    const further = this.draw - this.#creakedDraw >= creakNotch;
    if (further || this.draw < this.#creakedDraw) this.#creakedDraw = this.draw;
    return further;
  }

  /** After a jump of the floor the arrow points as the bow's hand does. */
  #leap(held: Vec3): void {
    if (this.#jumped) copyVec3(held, this.direction);
  }

  /** The share of the way to where the hands point that this frame goes. */
  #smoothing(halfLife: number, delta: number): number {
    const share = this.#jumped ? 1 : smoothingFactor(halfLife, delta);
    this.#jumped = false;
    return share;
  }

  #settle(delta: number): boolean {
    const steady = this.draw >= anchorDraw && Math.abs(this.#drawSpeed) < anchorSpeed;
    this.#steady = steady ? this.#steady + delta : 0;
    if (this.stage === 'anchored' && Math.abs(this.draw - this.#anchoredAt) <= anchorSlack) return false;
    if (this.#steady >= anchorSeconds) return this.#anchor();
    this.stage = this.#stageOfDraw();
    return false;
  }

  #anchor(): true {
    this.stage = 'anchored';
    this.#anchoredAt = this.draw;
    return true;
  }

  #stageOfDraw(): 'drawing' | 'nocked' {
    return this.draw > drawingFrom ? 'drawing' : 'nocked';
  }
}
