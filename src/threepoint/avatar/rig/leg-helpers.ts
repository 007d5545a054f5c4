import type { Pose } from '../../core/math/pose';
import { type Quat, quat, slerp } from '../../core/math/quat';
import { type Side, sides } from '../../core/math/side';
import type { LegPose } from '../legs/leg-posture';
import type { HelperJoint, Rig } from './rig';
import { type SpreadLimb, spreadLimbOf } from './spread-limb-weights';

/** One leg's joints that its file lacks: each half of the way between the bones that meet there. */
interface LegHelpers {
  readonly hip: HelperJoint;
  readonly knee: HelperJoint;
  readonly ankle: HelperJoint;
}

const half = quat(0, 0, 0, 1);
const between = (before: Quat, after: Quat): Quat => slerp(before, after, 0.5, half);

/** Joints between those of a leg, so that hip, knee and ankle bend in two steps and keep their girth. */
export class LegHelperJoints {
  readonly #rig: Rig;
  readonly #legs: Readonly<Record<Side, LegHelpers>>;

  /** The rig must have both legs with their feet. */
  constructor(rig: Rig) {
    this.#rig = rig;
    const helpersOf = (side: Side): LegHelpers => ({
      hip: rig.addHelper(`${side}UpperLeg`, 'half'),
      knee: rig.addHelper(`${side}LowerLeg`, 'half'),
      ankle: rig.addHelper(`${side}Foot`, 'half'),
    });
    this.#legs = { left: helpersOf('left'), right: helpersOf('right') };
  }

  /** Returns the joints among which the skin is to be shared. */
  limbs(): readonly SpreadLimb[] {
    return sides.map((side) => {
      const { hip, knee, ankle } = this.#legs[side];
      return spreadLimbOf([hip, knee, ankle]);
    });
  }

  /** Puts the joints between where the bones of a leg are, which were placed before. */
  place(side: Side, hips: Pose<'floor'>, { hip, knee, ankle, thigh, shank, foot }: LegPose): void {
    const helpers = this.#legs[side];
    this.#rig.placeHelper(helpers.hip, hip, between(hips.orientation, thigh));
    this.#rig.placeHelper(helpers.knee, knee, between(thigh, shank));
    this.#rig.placeHelper(helpers.ankle, ankle, between(shank, foot));
  }
}
