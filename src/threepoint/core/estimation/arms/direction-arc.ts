import {
  angleBetween,
  copyQuat,
  identity,
  type MutableQuat,
  multiply,
  quat,
  rotationBetween,
  slerp,
} from '../../math/quat';
import type { Side } from '../../math/side';
import { addScaled, dot, lerp, type MutableVec3, normalise, reject, subtract, type Vec3, vec3 } from '../../math/vec3';

/** The path on a sphere from one direction to another, via a third one if they are far apart. */
export interface DirectionArc {
  readonly first: MutableQuat;
  readonly second: MutableQuat;
  /** The length of the first leg as a fraction of the whole path. */
  fraction: number;
  /** Intermediate direction, unit; used only while `roundabout`. */
  readonly via: MutableVec3;
  roundabout: boolean;
}

export const makeDirectionArc = (): DirectionArc => ({
  first: quat(0, 0, 0, 1),
  second: quat(0, 0, 0, 1),
  fraction: Number.NaN,
  via: vec3(0, 0, 0),
  roundabout: false,
});

/**
 * The angle [rad] beyond which directions are joined via `outside`, because the shortest path may lead through the
 * body.
 */
const farApart = 2.1;

/**
 * The direction via which an arm swings to the opposite side, in the axes of the body or the chest: forward, outward
 * and a little down.
 */
export const viaDirection: Readonly<Record<Side, Vec3>> = {
  left: normalise(vec3(-1, -0.2, -1)),
  right: normalise(vec3(1, -0.2, -1)),
};

const across = vec3(0, 0, 0);
const aside = vec3(0, 0, 0);

/**
 * Writes the arc between two unit directions, via `outside` if they are far apart. The via direction is equally far
 * from both ends, so that no path starts backwards.
 */
export function directionArc(
  from: Vec3,
  to: Vec3,
  outside: Vec3,
  target: DirectionArc = makeDirectionArc(),
): DirectionArc {
  const { via } = target;
  target.roundabout = Math.acos(Math.max(-1, Math.min(1, dot(from, to)))) > farApart;
  normalise(subtract(to, from, across), from, across);
  addScaled(lerp(from, to, 0.5, via), normalise(reject(outside, across, aside), outside, aside), 0.5, via);
  normalise(via, outside, via);
  return retargetArc(target, from, to);
}

/** Recomputes both legs from the current direction to a moved end. */
export function retargetArc(arc: DirectionArc, from: Vec3, to: Vec3): DirectionArc {
  const { first, second, via, roundabout } = arc;
  const a = angleBetween(identity, rotationBetween(from, roundabout ? via : to, first));
  const b = roundabout ? angleBetween(identity, rotationBetween(via, to, second)) : 0;
  arc.fraction = a + b > 0 ? a / (a + b) : 1;
  return arc;
}

/** Drops the via point once progress in [0, 1] has passed the first leg. */
export function advanceArc(arc: DirectionArc, progress: number): void {
  if (progress >= arc.fraction) arc.roundabout = false;
}

/** Returns the rotation from the arc's start to `progress` in [0, 1] of its path. */
export function alongArc(arc: DirectionArc, progress: number, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const { first, second, fraction } = arc;
  if (progress <= fraction)
    return fraction > 0 ? slerp(identity, first, Math.min(1, progress / fraction), target) : copyQuat(identity, target);
  return multiply(slerp(identity, second, (progress - fraction) / (1 - fraction), target), first, target);
}
