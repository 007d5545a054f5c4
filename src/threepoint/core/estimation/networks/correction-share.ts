import { smoothstep } from '../../math/damper';
import type { Pose } from '../../math/pose';
import { rotate } from '../../math/quat';
import { up, vec3 } from '../../math/vec3';
import limits from '../kinematic-limits.json' with { type: 'json' };

const { hipsDoubt, ik } = limits;

const headUp = vec3(0, 0, 0);

/**
 * Returns the share [0, 1] of the network's correction under this head. The doubt is how much higher the hips are if
 * they continue the head's axis than if they hang below the head. Upright, crouching and lying people cause none; under
 * the head of a handstand or a flip, which could be a deep bow, the share is 0.
 */
export function correctionShare({ position, orientation }: Pose<'heading'>, eyeHeight: number): number {
  const height = position.y / eyeHeight;
  const hanging = Math.max(height - hipsDoubt.headsetToHips, ik.lowestHips);
  const continued = height - hipsDoubt.headsetToHips * rotate(orientation, up, headUp).y;
  return 1 - smoothstep(hipsDoubt.none, hipsDoubt.full, continued - hanging);
}
