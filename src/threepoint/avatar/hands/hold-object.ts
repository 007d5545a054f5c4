import { closeAround, distanceToBall, distanceToRod, type Surface } from '../../core/body/grasp';
import { averageHand, type HandGeometry, mirrorPoint } from '../../core/body/hand-geometry';
import { copyHandShape, type FingerName, type MutableHandShape, makeHandShape } from '../../core/body/hand-shape';
import type { Pose } from '../../core/math/pose';
import { rotateInverse } from '../../core/math/quat';
import type { Side } from '../../core/math/side';
import { copyVec3, distance, dot, type MutableVec3, subtract, type Vec3, vec3 } from '../../core/math/vec3';

type Kind = 'nothing' | 'rod' | 'ball' | 'rim';

/** An object in one hand, in the frame of a left wrist; the fingers close again when it has moved. */
interface HeldObject {
  kind: Kind;
  readonly middle: MutableVec3;
  readonly axis: MutableVec3;
  radius: number;
  tube: number;
  readonly shape: MutableHandShape;
  /** Returns the distance [m] of a point from the object's surface. */
  readonly surface: Surface;
}

function makeHeld(): HeldObject {
  const held: HeldObject = {
    kind: 'nothing',
    middle: vec3(0, 0, 0),
    axis: vec3(0, 0, 0),
    radius: 0,
    tube: 0,
    shape: makeHandShape(),
    surface: (point, finger) => distanceTo(held, point, finger),
  };
  return held;
}

/** The motion of an object in its hand below which the fingers stay as they are [m; of the unit axis]. */
const still = 4e-4;
const stillAxis = 0.004;

interface Ball {
  readonly at: Vec3;
  readonly radius: number;
}

interface Rod extends Ball {
  readonly axis: Vec3;
}

interface Rim extends Ball {
  readonly normal: Vec3;
  readonly tube: number;
}

/** Closes hands around the objects that they hold. All poses are in one frame. */
export class ObjectHolds {
  readonly #held = { left: makeHeld(), right: makeHeld() };
  readonly #middle = vec3(0, 0, 0);
  readonly #axis = vec3(0, 0, 0);
  #average: HandGeometry = averageHand(1.59);
  #eyeHeight = 1.59;
  readonly #hands: Record<Side, HandGeometry> = { left: this.#average, right: this.#average };

  /**
   * Sets the geometry of the drawn hand [m]; null: a rig without fingers, for which the average hand of this eye height
   * is used.
   */
  fitTo(side: Side, hand: HandGeometry | null, eyeHeight: number): void {
    if (eyeHeight !== this.#eyeHeight) {
      this.#eyeHeight = eyeHeight;
      this.#average = averageHand(eyeHeight);
    }
    const fitted = hand ?? this.#average;
    if (fitted === this.#hands[side]) return;
    this.#hands[side] = fitted;
    this.#held[side].kind = 'nothing';
  }

  /** Writes the shape of a hand around a rod along a unit axis. */
  rod(side: Side, wrist: Pose<'floor'>, { at, axis, radius }: Rod, target: MutableHandShape): void {
    this.#put(side, wrist, at, axis);
    this.#close(side, 'rod', radius, 0, target);
  }

  ball(side: Side, wrist: Pose<'floor'>, { at, radius }: Ball, target: MutableHandShape): void {
    this.#put(side, wrist, at, noAxis);
    this.#close(side, 'ball', radius, 0, target);
  }

  /**
   * Writes the shape of a hand at the rim of a basket: the fingers lie on the wall from outside, the thumb lies over
   * the tube.
   */
  rim(side: Side, wrist: Pose<'floor'>, { at, normal, radius, tube }: Rim, target: MutableHandShape): void {
    this.#put(side, wrist, at, normal);
    this.#close(side, 'rim', radius, tube, target);
  }

  /** Moves the object into the frame of a left wrist. */
  #put(side: Side, wrist: Pose<'floor'>, at: Vec3, axis: Vec3): void {
    const middle = rotateInverse(wrist.orientation, subtract(at, wrist.position, this.#middle), this.#middle);
    const along = rotateInverse(wrist.orientation, axis, this.#axis);
    if (side === 'left') return;
    mirrorPoint(middle, middle);
    mirrorPoint(along, along);
  }

  #close(side: Side, kind: Kind, radius: number, tube: number, target: MutableHandShape): void {
    const held = this.#held[side];
    const same = held.kind === kind && held.radius === radius && held.tube === tube;
    if (!same || distance(this.#middle, held.middle) > still || distance(this.#axis, held.axis) > stillAxis) {
      held.kind = kind;
      held.radius = radius;
      held.tube = tube;
      copyVec3(this.#middle, held.middle);
      copyVec3(this.#axis, held.axis);
      closeAround(held.surface, this.#hands[side], held.shape);
    }
    copyHandShape(held.shape, target);
  }
}

const noAxis = vec3(0, 0, 0);
const fromMiddle = vec3(0, 0, 0);

/** Returns the distance [m] of a point on a finger from a held object. */
function distanceTo({ kind, middle, axis, radius, tube }: HeldObject, point: Vec3, finger: FingerName): number {
  if (kind === 'rod') return distanceToRod(point, middle, axis, radius);
  if (kind === 'ball') return distanceToBall(point, middle, radius);
  const fromWall = distanceToRod(point, middle, axis, radius);
  if (finger !== 'thumb') return fromWall - tube;
  const above = dot(subtract(point, middle, fromMiddle), axis);
  return Math.sqrt(fromWall * fromWall + above * above) - tube;
}
