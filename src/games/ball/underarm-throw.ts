import { sideSign } from 'threepoint/core';
import {
  add,
  addScaled,
  clamp,
  copyVec3,
  length,
  type MutableVec3,
  normalise,
  otherSide,
  type Side,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { type MutablePosture, makePosture, type PlayerPosture, type PlayerPostures } from './player-postures';
import { setPalmAhead, type ThrowPostures } from './throw-postures';

/**
 * Length of the acceleration [m], then a time at constant speed: the window in which a throw is measured, plus a slow
 * frame [s]; then the deceleration [m].
 */
const runUp = 0.24;
const measuredSeconds = 0.095;
const evenSeconds = measuredSeconds + 0.02;
const slowDown = 0.24;

/** An underarm throw with a given velocity, floor frame; `aim` changes it. */
export class UnderarmThrow {
  readonly #postures: PlayerPostures;
  readonly #moves: ThrowPostures;
  readonly #wound = makePosture();
  readonly #thrown = makePosture();
  readonly #back = vec3(0, 0, 0);
  /** Direction of the throw, unit. */
  readonly #way = vec3(0, 0, 0);
  readonly #point = vec3(0, 0, 0);
  #speed = 0;
  #runSeconds = 0;
  #slowSeconds = 0;

  constructor(postures: PlayerPostures, moves: ThrowPostures) {
    this.#postures = postures;
    this.#moves = moves;
  }

  /** The posture with the arm swung back. */
  get wound(): PlayerPosture {
    return this.#wound;
  }

  /** The posture at the end of the throw. */
  get thrown(): PlayerPosture {
    return this.#thrown;
  }

  get seconds(): number {
    return this.#runSeconds + evenSeconds + this.#slowSeconds;
  }

  /** Time of the throw at which the hand opens [s]. */
  get releaseAt(): number {
    return this.#runSeconds + measuredSeconds;
  }

  /** Sets the velocity of the throw [m/s] and the point at which the eyes look. */
  aim(side: Side, velocity: Vec3, at: Vec3): void {
    this.#speed = length(velocity);
    normalise(velocity, undefined, this.#way);
    this.#runSeconds = (2 * runUp) / this.#speed;
    this.#slowSeconds = (2 * slowDown) / this.#speed;
    addScaled(this.#moves.release(side), this.#way, -(runUp + this.#speed * measuredSeconds), this.#back);
    this.#wind(side, at);
    this.#follow(side, at);
  }

  /**
   * Writes the position of the fist after `elapsed` seconds: it accelerates, moves at constant speed until the ball has
   * left, and decelerates.
   */
  swing(elapsed: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
    const running = clamp(elapsed, 0, this.#runSeconds);
    const evenly = clamp(elapsed - this.#runSeconds, 0, evenSeconds);
    const slowing = clamp(elapsed - this.#runSeconds - evenSeconds, 0, this.#slowSeconds);
    const along =
      runUp * (running / this.#runSeconds) ** 2 +
      this.#speed * evenly +
      this.#speed * (slowing - (slowing * slowing) / (2 * this.#slowSeconds));
    return addScaled(this.#back, this.#way, along, target);
  }

  #lean(target: MutablePosture, at: Vec3): void {
    const { eyes } = this.#postures;
    this.#moves.resting(at, target);
    add(eyes, this.#point, target.eyes);
    this.#postures.gazeAt(target.eyes, at, target.gaze);
  }

  /** Computes the posture with the arm swung back: the body leans back, the other arm is ahead. */
  #wind(side: Side, at: Vec3): void {
    const { arm, eyes } = this.#postures;
    const wound = this.#wound;
    const point = this.#point;
    const outward = sideSign(side);
    setVec3(point, 0.03 * outward, -0.01, 0.06);
    this.#lean(wound, at);
    const hand = wound[side];
    copyVec3(this.#back, hand.fist);
    subtract(this.#back, this.#postures.shoulder(side, eyes, point), point);
    normalise(
      add(normalise(point, undefined, point), scale(this.#way, 0.6, hand.knuckles), point),
      undefined,
      hand.knuckles,
    );
    setPalmAhead(outward, hand.thumb);
    const other = wound[otherSide(side)];
    this.#postures.shoulder(otherSide(side), wound.eyes, other.fist);
    add(other.fist, setVec3(point, -0.1 * outward, -0.55 * arm, -0.55 * arm), other.fist);
    normalise(setVec3(point, 0, 0.1, -1), undefined, other.knuckles);
    normalise(setVec3(point, 0.5 * outward, 0.8, 0), undefined, other.thumb);
  }

  /** Computes the posture at the end: the body leans ahead. */
  #follow(side: Side, at: Vec3): void {
    const thrown = this.#thrown;
    const outward = sideSign(side);
    setVec3(this.#point, -0.02 * outward, -0.03, -0.13);
    this.#lean(thrown, at);
    const hand = thrown[side];
    this.swing(this.seconds, hand.fist);
    copyVec3(this.#way, hand.knuckles);
    setPalmAhead(outward, hand.thumb);
  }
}
