import type { SkeletonJoint } from 'threepoint/core';

/** A place on the picture [px], from its upper left corner. */
export interface Point {
  readonly x: number;
  readonly y: number;
}

/** The side of the picture [px]. */
export const pictureSize = 300;
const margin = 18;
/** The distance from the edge within which a zoomed picture moves towards a joint [px]. */
const edge = 50;

/** The greatest distance of a tap from the joint that it chooses [px]. */
const tapRadius = 28;
/** Joints whose distances from a tap differ by less are too close to each other to choose one [px]. */
const ambiguity = 7;
const zoomStep = 3;
const maxZoom = 81;
/** Joints that stay closer to each other at the greatest zoom lie in one place [px]. */
const samePlace = 1;

type Axis = 'x' | 'y' | 'z';
const axes: readonly Axis[] = ['x', 'y', 'z'];

const distance = (a: Point, b: Point): number => Math.hypot(a.x - b.x, a.y - b.y);

/**
 * Projects joints along the axis of their least extent. Y is up, or Z if Y has the least extent. `leftAndRight`: joints
 * of opposite sides, which orient the picture: it shows the front, with the body's left on the right.
 */
function projected(
  joints: readonly SkeletonJoint[],
  leftAndRight: readonly (readonly [number, number])[],
): readonly Point[] {
  const extentOf = (axis: Axis): number => {
    const values = joints.map(({ position }) => position[axis]);
    return values.reduce((a, b) => Math.max(a, b), -Infinity) - values.reduce((a, b) => Math.min(a, b), Infinity);
  };
  const depth = axes.reduce((a, b) => (extentOf(b) < extentOf(a) ? b : a));
  const up: Axis = depth === 'y' ? 'z' : 'y';
  const across = axes.find((axis) => axis !== depth && axis !== up)!;
  const lean = leftAndRight.reduce(
    (sum, [left, right]) => sum + joints[left]!.position[across] - joints[right]!.position[across],
    0,
  );
  const sign = lean < 0 ? -1 : 1;
  return joints.map(({ position }) => ({ x: sign * position[across], y: -position[up] }));
}

/** Lays out a skeleton on a picture that can be zoomed, and finds the joint that a tap chooses. */
export class SkeletonView {
  readonly #places: readonly Point[];
  readonly #whole: Point;
  readonly #scale: number;
  #zoom = 1;
  #centre: Point;

  constructor(joints: readonly SkeletonJoint[], leftAndRight: readonly (readonly [number, number])[] = []) {
    this.#places = projected(joints, leftAndRight);
    const [xs, ys] = [this.#places.map(({ x }) => x), this.#places.map(({ y }) => y)];
    const least = { x: Math.min(...xs), y: Math.min(...ys) };
    const most = { x: Math.max(...xs), y: Math.max(...ys) };
    this.#whole = { x: (least.x + most.x) / 2, y: (least.y + most.y) / 2 };
    this.#centre = this.#whole;
    this.#scale = (pictureSize - 2 * margin) / (Math.max(most.x - least.x, most.y - least.y) || 1);
  }

  get isZoomed(): boolean {
    return this.#zoom > 1;
  }

  /** Returns the place at which a joint is drawn. */
  place(joint: number): Point {
    const { x, y } = this.#places[joint]!;
    const scale = this.#scale * this.#zoom;
    const middle = pictureSize / 2;
    return { x: middle + (x - this.#centre.x) * scale, y: middle + (y - this.#centre.y) * scale };
  }

  showWhole(): void {
    this.#zoom = 1;
    this.#centre = this.#whole;
  }

  /** Centres a zoomed picture on a joint that lies near its edge or outside it. */
  reveal(joint: number): void {
    const { x, y } = this.place(joint);
    const isInside = Math.min(x, y) > edge && Math.max(x, y) < pictureSize - edge;
    if (this.isZoomed && !isInside) this.#centre = this.#places[joint]!;
  }

  /**
   * Returns the joint that a tap chooses; null: there is none. A tap among joints that are too close to each other
   * zooms in on them and chooses none. Of joints in one place it chooses the one after `chosen`.
   */
  pick(tap: Point, among: readonly number[], chosen: number | null): number | null {
    const near = among
      .map((joint) => ({ joint, away: distance(this.place(joint), tap) }))
      .filter(({ away }) => away < tapRadius)
      .sort((a, b) => a.away - b.away);
    const [nearest] = near;
    if (!nearest) return null;
    const crowd = near.filter(({ away }) => away < nearest.away + ambiguity).map(({ joint }) => joint);
    const left = maxZoom / this.#zoom;
    const here = this.place(nearest.joint);
    const together = crowd.filter((joint) => distance(this.place(joint), here) * left < samePlace);
    if (together.length < crowd.length && left > 1) {
      this.#centre = this.#places[nearest.joint]!;
      this.#zoom *= zoomStep;
      return null;
    }
    const after = chosen === null ? -1 : together.indexOf(chosen);
    return together[(after + 1) % together.length]!;
  }
}
