import type { Button } from 'threepoint/core';
import {
  addScaled,
  clamp,
  copyVec3,
  damp,
  dot,
  length,
  type MutableVec3,
  makePose,
  normalise,
  type Pose,
  type Side,
  smoothingFactor,
  smoothstep,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';
import type { BowView } from './archery-state';
import { braceHeight, maximumDraw } from './bow';
import { arrowRestOf, bowDirection, turnBow } from './bow-pose';
import { slerpDirection } from './slerp-direction';

/** Half-life of a drawn arrow's direction [s]. */
const aimHalfLife = 0.05;
/** Half-life with one hand, which trembles more [s]. */
const oneHandedAimHalfLife = 0.08;
/** Speed of a one-handed draw [m/s], and its end [m]. */
export const oneHandedDrawSpeed = 0.5;
export const oneHandedDraw = 0.6;

/** Up to the first draw [m] the bow hand aims, from the second both hands do; between them the direction is blended. */
const handAims = 0.03;
const lineAims = 0.15;
/** Draw [m] at which the stage `nocked` ends. */
const drawingFrom = 0.05;
/**
 * The draw is anchored from this length [m], if it changes more slowly than this [m/s] for this time [s], until it
 * changes by this much [m].
 */
const anchorDraw = 0.25;
const anchorSpeed = 0.12;
const anchorSeconds = 0.15;
const anchorSlack = 0.05;
const drawSpeedHalfLife = 0.03;
/** Draw between two haptic pulses, and between two creaks [m]. */
const hapticNotch = 0.015;
const creakNotch = 0.06;

// Scratch of one call.
const held = vec3(0, 0, 0);
const line = vec3(0, 0, 0);
const goal = vec3(0, 0, 0);
const rest = vec3(0, 0, 0);
const turned = makePose<'floor'>();

/** An arrow on the string, from nocking to release; floor frame. `inHand` is the bow's pose in the hand. */
export class NockedArrow {
  stage: Exclude<BowView['stage'], 'empty'> = 'nocked';
  /** Draw beyond brace height [m], and the longest so far. */
  draw = 0;
  longestDraw = 0;
  /** Direction of the arrow, unit. */
  readonly direction: MutableVec3;
  /** Time of the first frame without a hand [s]; null: both are tracked. */
  lostAt: number | null = null;
  /**
   * Whether a pinch has opened. It counts in the next frame with a tracked hand, because fingers also seem to open when
   * tracking is lost.
   */
  opened = false;
  /** Whether `direction` dates from before a jump of the floor frame. */
  #discontinuous = false;
  #drawSpeed = 0;
  /** How long the draw has been steady [s], and the draw at the anchor [m]. */
  #steady = 0;
  #anchoredAt = 0;
  #feltDraw = 0;
  #creakedDraw = 0;

  constructor(
    /** The button that holds the arrow, and its hand. */
    readonly button: Button,
    readonly side: Side,
    direction: Vec3,
  ) {
    this.direction = copyVec3(direction);
  }

  /** Draws the string to the fist of the string hand. Returns whether this frame anchors the draw. */
  drawWithHand(inHand: Pose<'floor'>, fist: Vec3, delta: number): boolean {
    const { direction } = this;
    this.#leap(bowDirection(inHand, held));
    const reference = this.draw < drawingFrom ? held : direction;
    // The arrow rest lies above the fist, orthogonal to the arrow, whatever the direction of the knuckles.
    normalise(subtract(arrowRestOf(inHand, rest), fist, line), reference, line);
    subtract(arrowRestOf(turnBow(inHand, line, turned), rest), fist, line);
    const behind = dot(line, reference) > 0;
    const draw = behind ? clamp(length(line) - braceHeight, 0, maximumDraw) : 0;
    const share = smoothstep(handAims, lineAims, draw);
    if (behind) slerpDirection(held, normalise(line, undefined, line), share, goal);
    else copyVec3(held, goal);
    slerpDirection(direction, goal, this.#smoothing(aimHalfLife * share, delta), direction);
    if (delta > 0) this.#drawSpeed = damp(this.#drawSpeed, (draw - this.draw) / delta, drawSpeedHalfLife, delta);
    this.draw = draw;
    return this.#settle(delta);
  }

  /** Draws with the button, while the bow hand aims. Returns whether this frame anchors the draw. */
  drawWithButton(inHand: Pose<'floor'>, delta: number): boolean {
    this.#leap(bowDirection(inHand, held));
    slerpDirection(this.direction, held, this.#smoothing(oneHandedAimHalfLife, delta), this.direction);
    this.draw = Math.min(oneHandedDraw, this.draw + oneHandedDrawSpeed * delta);
    this.longestDraw = this.draw;
    if (this.draw < oneHandedDraw) this.stage = this.#stageOfDraw();
    else if (this.stage !== 'anchored') return this.#anchor();
    return false;
  }

  /** Announces that the floor frame jumps: the next frame sets the direction without a filter. */
  discontinuity(): void {
    this.#discontinuous = true;
  }

  /** Resumes after a lost hand is tracked again. */
  resume(): void {
    this.lostAt = null;
    this.stage = this.#stageOfDraw();
  }

  /** Returns the position of the nock, in line with the arrow rest. */
  nock(inHand: Pose<'floor'>, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
    arrowRestOf(turnBow(inHand, this.direction, turned), target);
    return addScaled(target, this.direction, -braceHeight - this.draw, target);
  }

  passesHapticNotch(): boolean {
    if (!(Math.abs(this.draw - this.#feltDraw) >= hapticNotch)) return false;
    this.#feltDraw = this.draw;
    return true;
  }

  passesCreakNotch(): boolean {
    const further = this.draw - this.#creakedDraw >= creakNotch;
    if (further || this.draw < this.#creakedDraw) this.#creakedDraw = this.draw;
    return further;
  }

  /** Sets the direction to that of the bow hand after a jump of the floor frame. */
  #leap(held: Vec3): void {
    if (this.#discontinuous) copyVec3(held, this.direction);
  }

  /** Returns the filter's share for this frame; 1 after a jump. */
  #smoothing(halfLife: number, delta: number): number {
    const share = this.#discontinuous ? 1 : smoothingFactor(halfLife, delta);
    this.#discontinuous = false;
    return share;
  }

  #settle(delta: number): boolean {
    this.longestDraw = Math.max(this.longestDraw, this.draw);
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
