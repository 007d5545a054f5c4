import {
  distance,
  dot,
  type MutableVec3,
  makePose,
  type Pose,
  type Side,
  smoothingFactor,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { bowDirection, bowInHand, nockingPointOf, turnBow } from './bow-pose';
import { slerpDirection } from './slerp-direction';

/** A press takes the bow out of the other hand within this distance of the fist from its grip [m]. */
const takeReach = 0.1;
/** Half-life of the bow's return to the hand's orientation after a shot [s]. */
const settleHalfLife = 0.08;
/** After this long without its hand [s] the bow is no longer held, and a drawn arrow returns to the quiver. */
export const holdSeconds = 0.5;

/** Cosine of the angle at which the bow has returned: a quarter of a degree. */
const settled = Math.cos(Math.PI / 720);

// Scratch of one call.
const ahead = vec3(0, 0, 0);
const string = vec3(0, 0, 0);

/** The bow of one archer: the hand that holds it, its pose, and its return after a shot; floor frame. */
export class HeldBow {
  /** The hand that holds the bow. */
  side: Side = 'left';
  /** The bow's last pose in the hand, without an arrow. */
  readonly inHand = makePose<'floor'>();
  /** The time of that pose [s]; null: no hand holds the bow. */
  #heldAt: number | null = null;
  /** The direction of the bow while it returns after a shot, unit; null: that of the hand. */
  #settling: MutableVec3 | null = null;
  readonly #turned = makePose<'floor'>();

  get isHeld(): boolean {
    return this.#heldAt !== null;
  }

  moveToHand(side: Side): void {
    this.side = side;
    this.#heldAt = null;
    this.#settling = null;
  }

  /**
   * Returns whether a fist can take the bow from the other hand: it is within reach, and nearer to the grip than to the
   * string.
   */
  isInHandAt(fist: Vec3, side: Side, giver: Pose<'floor'>): boolean {
    const bow = bowInHand(side, giver, this.#turned);
    const toGrip = distance(fist, bow.position);
    return toGrip <= takeReach && toGrip <= distance(fist, nockingPointOf(bow, string));
  }

  /**
   * Moves the bow with its hand. Without a tracked hand it stays: while an arrow is nocked, otherwise for
   * `holdSeconds`.
   */
  follow(side: Side, hand: Pose<'floor'> | null, time: number, nocked: boolean): void {
    if (hand) {
      bowInHand(side, hand, this.inHand);
      this.#heldAt = time;
    } else if (this.#heldAt !== null && !nocked && time - this.#heldAt > holdSeconds) this.#heldAt = null;
  }

  /** Keeps the bow as it is while the session is suspended. */
  wait(time: number): void {
    if (this.#heldAt !== null) this.#heldAt = time;
  }

  /** Starts the return after a shot, from the arrow's direction; the bow takes over this vector. */
  settleFrom(direction: MutableVec3): void {
    this.#settling = direction;
  }

  /** Announces that the floor frame jumps: the return ends at once. */
  discontinuity(): void {
    this.#settling = null;
  }

  /** Continues the return by `delta` seconds. */
  settle(delta: number): void {
    if (!this.#settling) return;
    bowDirection(this.inHand, ahead);
    slerpDirection(this.#settling, ahead, smoothingFactor(settleHalfLife, delta), this.#settling);
    if (dot(this.#settling, ahead) > settled) this.#settling = null;
  }

  /** Returns the bow without an arrow; the next call overwrites it. */
  empty(): Pose<'floor'> {
    return this.#settling ? turnBow(this.inHand, this.#settling, this.#turned) : this.inHand;
  }
}
