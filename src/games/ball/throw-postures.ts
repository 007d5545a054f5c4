import { sideSign } from 'threepoint/core';
import {
  add,
  addScaled,
  copyVec3,
  distance,
  type MutableVec3,
  makePose,
  normalise,
  type Side,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { ballInPalm, wristAround } from '../fist';
import { ballRadius } from './flight';
import { type MutablePosture, makePosture, type PlayerPostures } from './player-postures';

export const setPalmAhead = (outward: -1 | 1, target: MutableVec3): MutableVec3 =>
  normalise(setVec3(target, outward, 0.35, 0), undefined, target);

// Scratch of one call.
const shoulder = vec3(0, 0, 0);
const offset = vec3(0, 0, 0);
const wrist = makePose<'floor'>();

/** The postures of a thrower that faces −Z; floor frame. */
export class ThrowPostures {
  readonly #postures: PlayerPostures;
  readonly #release: Readonly<Record<Side, Vec3>>;

  constructor(postures: PlayerPostures) {
    this.#postures = postures;
    const { arm, eyes } = postures;
    const releaseOf = (side: Side): Vec3 => add(postures.shoulder(side, eyes), vec3(0, 0.06 * arm, -0.72 * arm));
    this.#release = { left: releaseOf('left'), right: releaseOf('right') };
  }

  /** Returns the posture with arms down and eyes on a point. */
  resting(at: Vec3, target: MutablePosture = makePosture()): MutablePosture {
    return this.#rest(this.#postures.eyes, at, target);
  }

  /** Returns the posture with the fist at a ball of the rack; the body leans as far as the arm is too short. */
  reaching(side: Side, ball: Vec3, target: MutablePosture = makePosture()): MutablePosture {
    const { arm, eyes } = this.#postures;
    const longest = 0.97 * arm + 0.05;
    this.#postures.shoulder(side, eyes, shoulder);
    const missing = Math.max(0, distance(shoulder, ball) - longest);
    const towards = normalise(subtract(ball, shoulder, offset), undefined, offset);
    addScaled(eyes, towards, missing, target.eyes);
    this.#rest(target.eyes, ball, target);
    const hand = target[side];
    copyVec3(ball, hand.fist);
    subtract(ball, this.#postures.shoulder(side, target.eyes, shoulder), offset);
    add(normalise(offset, undefined, offset), setVec3(shoulder, 0, -0.15, -0.4), offset);
    normalise(offset, undefined, hand.knuckles);
    setVec3(hand.thumb, -sideSign(side), 0.25, 0);
    return target;
  }

  /** Returns the posture with the ball before the chest and eyes on a point. */
  carrying(side: Side, at: Vec3, target: MutablePosture = makePosture()): MutablePosture {
    const { arm, eyes } = this.#postures;
    const outward = sideSign(side);
    this.resting(at, target);
    const hand = target[side];
    this.#postures.shoulder(side, eyes, hand.fist);
    add(hand.fist, setVec3(offset, -0.05 * outward * arm, -0.42 * arm, -0.62 * arm), hand.fist);
    normalise(setVec3(offset, -0.1 * outward, 0.15, -1), undefined, hand.knuckles);
    normalise(setVec3(offset, 0.7 * outward, 0.7, 0), undefined, hand.thumb);
    return target;
  }

  /** Returns the position of the fist at the release. */
  release(side: Side): Vec3 {
    return this.#release[side];
  }

  /** Writes the position at which a ball leaves the palm in this unit direction. */
  leaving(side: Side, way: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
    wristAround(side, this.#release[side], way, setPalmAhead(sideSign(side), offset), wrist);
    return ballInPalm(wrist, ballRadius, target);
  }

  #rest(eyes: Vec3, at: Vec3, target: MutablePosture): MutablePosture {
    copyVec3(eyes, target.eyes);
    this.#postures.gazeAt(eyes, at, target.gaze);
    this.#postures.hang('left', eyes, target.left);
    this.#postures.hang('right', eyes, target.right);
    return target;
  }
}
