import type { Mutable, Pointer } from 'threepoint/core';
import {
  addScaled,
  distance,
  dot,
  forward,
  type Ray,
  subtract,
  transformPoint,
  type Vec3,
  vec3,
  zero,
} from 'threepoint/math';
import { type BallSteering, landsIn } from 'threepoint-games/ball';
import type { ActivityContext } from '../activity/activity-context';
import type { BallFrame } from './match/ball-frame';
import type { BallPlay } from './match/ball-play';

/** The owner of what a pointer holds here. */
const owner = 'ball';
/** A pointer aims at the basket within this distance of its opening [m]. */
const basketReach = 0.8;
/** A gaze that rests at the basket for this time [s] throws, if the ball has not left for the basket before. */
const dwellSeconds = 2.5;

/** The middle of the basket's opening, arena frame [m]. */
const basketOf = ({ opening, state }: BallFrame): Vec3 => opening?.position ?? state.basket.position;

/** The ray before the first pointer. */
const noRay: Ray = { origin: zero, direction: forward };

/** The source that moves the user's body at the court: a person in a headset, a pointer, or a simulated player. */
export class CourtInput {
  readonly #context: Pick<ActivityContext, 'place' | 'settings' | 'headset' | 'pointer'>;
  readonly #play: () => Pick<BallPlay, 'newest' | 'floorFromArena'> | null;
  readonly #basket = vec3(0, 0, 0);
  readonly #steering: Mutable<BallSteering> = { ray: noRay, pressed: false, cancelled: false };

  /** `play`: the match; null before there is one. */
  constructor(
    context: Pick<ActivityContext, 'place' | 'settings' | 'headset' | 'pointer'>,
    play: () => Pick<BallPlay, 'newest' | 'floorFromArena'> | null,
  ) {
    this.#context = context;
    this.#play = play;
  }

  /** A simulated player moves the user's body; no person in a headset and no pointer does. */
  get isActor(): boolean {
    const { place, settings, headset, pointer } = this.#context;
    return place === null && settings.actor && (!headset.worn || headset.emulator !== null) && pointer() === null;
  }

  /**
   * Returns what the pointer asks of the user's player, floor frame of the user; null: no pointer plays. The next call
   * overwrites the result.
   */
  steering(): BallSteering | null {
    const pointer = this.#context.pointer();
    if (!pointer) return null;
    this.#pointAtBasket(pointer);
    const steering = this.#steering;
    steering.ray = pointer;
    // A throw that its user cannot end leaves when it would land in the basket.
    steering.pressed = pointer.isHeldFor(owner) && (pointer.releases || !this.#isOnTarget());
    steering.cancelled = pointer.cancelled;
    return steering;
  }

  /** Reports that the pointer aims at the basket, for a player with a ball in the hand. */
  #pointAtBasket(pointer: Pointer): void {
    const play = this.#play();
    const newest = play?.newest;
    const ball = newest?.held.left ?? newest?.held.right ?? null;
    if (!play || !newest || ball === null) return;
    const basket = transformPoint(play.floorFromArena, basketOf(newest), this.#basket);
    const along = dot(subtract(basket, pointer.origin), pointer.direction);
    if (along <= 0 || distance(addScaled(pointer.origin, pointer.direction, along), basket) > basketReach) return;
    pointer.pointAt({ distance: along, owner, id: `ball ${ball}`, dwellSeconds });
  }

  #isOnTarget(): boolean {
    const newest = this.#play()?.newest;
    return Boolean(newest?.aim && landsIn(newest.aim, basketOf(newest)));
  }
}
