import { smoothingFactor } from 'threepoint/core/math/damper';
import { makePose, type Pose } from 'threepoint/core/math/pose';
import type { Side } from 'threepoint/core/math/side';
import { distance, dot, type MutableVec3, type Vec3, vec3 } from 'threepoint/core/math/vec3';
import { bowInHand, forwardOf, stringAtRest, turnBow, turnTowards } from './bow-hand';

/** A press takes the bow when the fist is this near to its grip in the other hand, or to the bow on its rest [m]. */
export const takeReach = 0.1;
export const restReach = 0.25;
/** Without its arrow the bow turns half the way back to how the hand holds it in this time [s]. */
export const settleHalfLife = 0.08;
/** A hand may be lost for this long [s]; then the bow is no longer held, and a drawn arrow goes back to the quiver. */
export const holdSeconds = 0.5;

/** Cosine of the angle at which a bow that turns back is back: a quarter of a degree. */
const settled = Math.cos(Math.PI / 720);

// Memory of one call: a frame makes no garbage.
const ahead = vec3(0, 0, 0);
const string = vec3(0, 0, 0);

/** The bow of one archer: which hand has it, how it is held, and how it turns back when its arrow has gone; floor frame. */
export class HeldBow {
  /** The hand that has the bow; null: it hangs on its rest. */
  side: Side | null = null;
  /** As the hand held it last, before an arrow turned it. */
  readonly inHand = makePose<'floor'>();
  /** When that was [s]; null: no hand holds it. */
  #heldAt: number | null = null;
  /** Where a bow points that is turning back after its arrow has gone, unit; null: with the hand. */
  #settling: MutableVec3 | null = null;
  readonly #turned = makePose<'floor'>();

  get isHeld(): boolean {
    return this.#heldAt !== null;
  }

  giveTo(side: Side | null): void {
    this.side = side;
    this.#heldAt = null;
    this.#settling = null;
  }

  /** Whether a fist is near enough to the bow on its rest to take it. */
  isOnRestAt(fist: Vec3, rest: Vec3): boolean {
    return distance(fist, rest) <= restReach;
  }

  /** Whether a fist is near enough to take the bow out of the hand that has it, and nearer to its grip than to its string. */
  isInHandAt(fist: Vec3, side: Side, giver: Pose<'floor'>): boolean {
    const bow = bowInHand(side, giver, this.#turned);
    const toGrip = distance(fist, bow.position);
    return toGrip <= takeReach && toGrip <= distance(fist, stringAtRest(bow, string));
  }

  /** The bow goes with its hand. With no hand in sight it stays: as long as an arrow is on the string, else for `holdSeconds`. */
  follow(side: Side, hand: Pose<'floor'> | null, time: number, nocked: boolean): void {
    if (hand) {
      bowInHand(side, hand, this.inHand);
      this.#heldAt = time;
    } else if (this.#heldAt !== null && !nocked && time - this.#heldAt > holdSeconds) this.#heldAt = null;
  }

  /** No hand is looked for: the bow stays as it was. */
  wait(time: number): void {
    if (this.#heldAt !== null) this.#heldAt = time;
  }

  /** The arrow has gone: the bow points where it did, and turns back from there. The direction is the bow's own from now on. */
  settleFrom(direction: MutableVec3): void {
    this.#settling = direction;
  }

  /** The floor lies elsewhere from the next frame on: the bow is there as the hand holds it. */
  jumped(): void {
    this.#settling = null;
  }

  /** Turns back to how the hand holds it. */
  settle(delta: number): void {
    if (!this.#settling) return;
    forwardOf(this.inHand, ahead);
    turnTowards(this.#settling, ahead, smoothingFactor(settleHalfLife, delta), this.#settling);
    if (dot(this.#settling, ahead) > settled) this.#settling = null;
  }

  /** The bow while no arrow is on its string; overwritten by the next call. */
  empty(): Pose<'floor'> {
    return this.#settling ? turnBow(this.inHand, this.#settling, this.#turned) : this.inHand;
  }
}
