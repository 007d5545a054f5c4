import type { Frame, Pose } from '../../math/pose';
import { rotate } from '../../math/quat';
import type { Side } from '../../math/side';
import { add, addScaled, length, lerp, normalise, reject, subtract, up, type Vec3, vec3 } from '../../math/vec3';
import { fistOf, thumbOf } from '../fist';
import { basketRadius } from './flight';

/** The opening of a basket: its middle, and the unit normal that looks out of it. */
export interface Opening {
  readonly position: Vec3;
  readonly normal: Vec3;
}

/** Out of the palm, unit. */
const palmOf = (hand: Pose<Frame>): Vec3 => rotate(hand.orientation, vec3(0, -1, 0));

/**
 * A basket held by its rim with both hands, palms inward and thumbs up, or with one, which is enough; hands in the basket's own
 * frame. It opens where the thumbs point. null: no hand is seen.
 */
export function basketInHands(left: Pose<Frame> | null, right: Pose<Frame> | null): Opening | null {
  const held = (side: Side, hand: Pose<Frame>): Opening => {
    const normal = thumbOf(side, hand.orientation);
    const inward = normalise(reject(palmOf(hand), normal), rotate(hand.orientation, vec3(0, 0, -1)));
    return { position: addScaled(fistOf(hand), inward, basketRadius), normal };
  };
  if (!left || !right) return left ? held('left', left) : right && held('right', right);
  const line = subtract(fistOf(right), fistOf(left));
  const thumbs = add(thumbOf('left', left.orientation), thumbOf('right', right.orientation));
  const across = normalise(line, vec3(1, 0, 0));
  const normal = length(line) > 1e-3 ? reject(thumbs, across) : thumbs;
  return {
    position: lerp(fistOf(left), fistOf(right), 0.5),
    // Thumbs that point at each other or apart say nothing: then upward.
    normal: normalise(length(normal) > 1e-3 ? normal : reject(up, across), up),
  };
}
