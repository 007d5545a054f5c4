import type { Patch } from '../../src/page/studio/room/light-map';
import { groups, type Opening, room, type Side, sides } from '../../src/page/studio/room/room-plan';

/** A colour of light, linear. */
export type Light = [red: number, green: number, blue: number];

/** The end of a ray. `patch`: −1 if nothing drawn was hit; `s`, `t`: the position on it, 0 to 1. */
export interface Hit {
  patch: number;
  s: number;
  t: number;
}

/** A ray leaves a surface by so much [m]. */
export const leave = 1e-4;

/** A number in [0, 1) for three integers: the same for the same integers. */
export function scatter(a: number, b: number, c: number): number {
  let mixed = Math.imul(a, 0x27d4eb2d) ^ Math.imul(b, 0x165667b1) ^ Math.imul(c, 0x9e3779b9);
  mixed = Math.imul(mixed ^ (mixed >>> 15), 0x85ebca6b);
  mixed = Math.imul(mixed ^ (mixed >>> 13), 0xc2b2ae35);
  return ((mixed ^ (mixed >>> 16)) >>> 0) / 2 ** 32;
}

/** Writes the light of the sky in a direction, or of the lawn; unit vector. */
export function skyLight(y: number, out: Light): void {
  const up = Math.min(1, Math.max(0, y));
  out[0] = y < 0 ? 0.34 : 1.25 - 0.5 * up;
  out[1] = y < 0 ? 0.38 : 1.3 - 0.35 * up;
  out[2] = y < 0 ? 0.2 : 1.34 - 0.14 * up;
}

const boxes = groups.flat();

/** The entry of a ray into a box [multiples of its direction], and the axis of the side it enters by. */
const entry = { at: 0, axis: 0 };

/** The room as rays meet it. */
export class TracedRoom {
  readonly #patches: readonly Patch[];
  readonly #through = boxes.map(({ lightThrough = 0 }) => lightThrough);
  /** Lowest and highest corners: of boxes, of groups of boxes. */
  readonly #bounds = new Float64Array(boxes.flatMap(({ from, to }) => [...from, ...to]));
  readonly #groupBounds = new Float64Array(
    groups.flatMap((group) => [
      ...[0, 1, 2].map((axis) => Math.min(...group.map(({ from }) => from[axis]!))),
      ...[0, 1, 2].map((axis) => Math.max(...group.map(({ to }) => to[axis]!))),
    ]),
  );
  /** The patch of each box's six sides, and of each side of the room; −1: none. */
  readonly #ofBox = new Int32Array(boxes.length * 6).fill(-1);
  readonly #ofSide: readonly number[];
  readonly #hit: Hit = { patch: -1, s: 0, t: 0 };
  readonly #inverse = new Float64Array(3);

  constructor(patches: readonly Patch[]) {
    this.#patches = patches;
    this.#ofSide = sides.map((side) => patches.findIndex((patch) => patch.side === side));
    patches.forEach(({ box, normal }, index) => {
      if (!box) return;
      const axis = normal.findIndex((value) => value !== 0);
      this.#ofBox[6 * boxes.indexOf(box) + 2 * axis + (normal[axis]! > 0 ? 1 : 0)] = index;
    });
  }

  /**
   * Follows a ray, and returns what it met, in an object that the next call overwrites; null: the sky or the lawn.
   * `chance`: decides whether light comes through leaves.
   */
  meet(origin: Float64Array, direction: Float64Array, chance: number): Hit | null {
    for (let axis = 0; axis < 3; axis++) this.#inverse[axis] = 1 / direction[axis]!;
    let nearest = Number.POSITIVE_INFINITY;
    let patch = -1;
    for (let side = 0; side < sides.length; side++) {
      const distance = this.#meetSide(sides[side]!, origin, direction);
      if (distance >= nearest) continue;
      nearest = distance;
      patch = this.#ofSide[side]!;
    }
    let index = 0;
    for (let group = 0; group < groups.length; group++) {
      const end = index + groups[group]!.length;
      if (!this.#enters(this.#groupBounds, group, origin, nearest, false)) index = end;
      for (; index < end; index++) {
        if (!this.#enters(this.#bounds, index, origin, nearest, true)) continue;
        const through = this.#through[index]!;
        if (through > 0 && scatter(index, Math.floor(chance * 65536), 5) < through) continue;
        nearest = entry.at;
        patch = this.#ofBox[6 * index + 2 * entry.axis + (direction[entry.axis]! > 0 ? 0 : 1)]!;
      }
    }
    return nearest === Number.POSITIVE_INFINITY ? null : this.#hitAt(origin, direction, nearest, patch);
  }

  /** Returns whether the ray passes a box before `nearest`; `outside`: and begins outside of it. */
  #enters(bounds: Float64Array, index: number, origin: Float64Array, nearest: number, outside: boolean): boolean {
    let near = Number.NEGATIVE_INFINITY;
    let far = nearest;
    for (let axis = 0; axis < 3; axis++) {
      const low = (bounds[6 * index + axis]! - origin[axis]!) * this.#inverse[axis]!;
      const high = (bounds[6 * index + 3 + axis]! - origin[axis]!) * this.#inverse[axis]!;
      const into = Math.min(low, high);
      if (into > near) {
        near = into;
        entry.axis = axis;
      }
      far = Math.min(far, Math.max(low, high));
    }
    entry.at = near;
    return near < far && (outside ? near > leave : far > leave);
  }

  /** Returns the distance to a side of the room; infinity: it is missed, or passed by an opening. */
  #meetSide({ axis, facing, openings }: Side, origin: Float64Array, direction: Float64Array): number {
    const plane = facing > 0 ? room.from[axis] : room.to[axis];
    const distance = (plane - origin[axis]!) * this.#inverse[axis]!;
    if (!(distance > leave)) return Number.POSITIVE_INFINITY;
    const [first, second] = [(axis + 1) % 3, (axis + 2) % 3];
    const x = origin[first]! + distance * direction[first]!;
    const y = origin[second]! + distance * direction[second]!;
    const within = ({ from, to }: Opening) =>
      x > from[first]! && x < to[first]! && y > from[second]! && y < to[second]!;
    if (!within(room)) return Number.POSITIVE_INFINITY;
    for (const opening of openings) if (within(opening)) return Number.POSITIVE_INFINITY;
    return distance;
  }

  #hitAt(origin: Float64Array, direction: Float64Array, distance: number, patch: number): Hit {
    const hit = this.#hit;
    hit.patch = patch;
    if (patch < 0) return hit;
    const { origin: corner, u, v } = this.#patches[patch]!;
    let [s, t, uu, vv] = [0, 0, 0, 0];
    for (let i = 0; i < 3; i++) {
      const from = origin[i]! + distance * direction[i]! - corner[i]!;
      s += from * u[i]!;
      t += from * v[i]!;
      uu += u[i]! * u[i]!;
      vv += v[i]! * v[i]!;
    }
    hit.s = Math.min(1, Math.max(0, s / uu));
    hit.t = Math.min(1, Math.max(0, t / vv));
    return hit;
  }
}
