import { angleBetween, between, identity, multiply, type Quat, slerp } from '../math/quat';
import { addScaled, dot, lerp, normalise, reject, type Vec3 } from '../math/vec3';

/** A way on a sphere from one direction to another, by way of a third. */
export interface DirectionArc {
  readonly first: Quat;
  readonly second: Quat;
  /** The whole way [rad]. */
  readonly angle: number;
  /** The first leg's share of it. */
  readonly share: number;
}

/** Directions further apart than this [rad] are joined by way of `outside`: the shortest way may lead through the body. */
const farApart = 2.1;

/** From the unit direction `from` to `to`; `outside` is where an arm passes that swings all the way round. */
export function directionArc(from: Vec3, to: Vec3, outside: Vec3): DirectionArc {
  const apart = Math.acos(Math.max(-1, Math.min(1, dot(from, to))));
  const via =
    apart <= farApart
      ? normalise(lerp(from, to, 0.5), from)
      : normalise(addScaled(lerp(from, to, 0.5), normalise(reject(outside, from), outside), 0.5), outside);
  const first = between(from, via);
  const second = between(via, to);
  const [a, b] = [angleBetween(identity, first), angleBetween(identity, second)];
  return { first, second, angle: a + b, share: a + b > 0 ? a / (a + b) : 1 };
}

/** The rotation from the arc's start to `progress` in [0, 1] of its way. */
export function alongArc({ first, second, share }: DirectionArc, progress: number): Quat {
  if (progress <= share) return share > 0 ? slerp(identity, first, progress / share) : identity;
  return multiply(slerp(identity, second, (progress - share) / (1 - share)), first);
}
