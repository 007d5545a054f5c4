import limbLimits from '../../body/limb-limits.json' with { type: 'json' };
import { armBonesOf, type Skeleton } from '../../body/skeleton';
import { type RestDirections, restDirections } from '../../math/quat';
import { add, length, lerp, right, subtract, type Vec3 } from '../../math/vec3';

/** The measures of a skeleton for `fitTorso`. */
export interface TorsoBones {
  readonly skeleton: Skeleton;
  /**
   * From chest joint to neck, from hips to chest joint, and from the neck to the head, at rest; their side is the
   * body's right.
   */
  readonly thorax: RestDirections;
  readonly thoraxLength: number;
  readonly lowerBack: RestDirections;
  readonly lowerBackLength: number;
  readonly neck: RestDirections;
  readonly neckLength: number;
  /** From the neck to the middle of the shoulders, at rest. */
  readonly shouldersFromNeck: Vec3;
  readonly shoulderWidth: number;
  /** Slightly less than the length of a straight arm [m], so that the elbow has a direction. */
  readonly reach: number;
}

/** Measures a skeleton for `fitTorso`: [m], T-pose facing −Z. Both arms have the length of the right one. */
export function torsoBones(skeleton: Skeleton): TorsoBones {
  const offsets = skeleton.restOffsets;
  const thorax = add(offsets.upperChest, offsets.neck);
  const lowerBack = add(offsets.spine, offsets.chest);
  const left = add(offsets.leftShoulder, offsets.leftUpperArm);
  const rightShoulder = add(offsets.rightShoulder, offsets.rightUpperArm);
  const { upper, lower } = armBonesOf(skeleton, 'right');
  return {
    skeleton,
    thorax: restDirections(thorax, right),
    thoraxLength: length(thorax),
    lowerBack: restDirections(lowerBack, right),
    lowerBackLength: length(lowerBack),
    neck: restDirections(offsets.head, right),
    neckLength: length(offsets.head),
    shouldersFromNeck: subtract(lerp(left, rightShoulder, 0.5), offsets.neck),
    shoulderWidth: 2 * rightShoulder.x,
    reach: (upper + lower) * limbLimits.straightest,
  };
}
