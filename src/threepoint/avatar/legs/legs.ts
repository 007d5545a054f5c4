import type { TrackedFeet } from '../../core/body/avatar-pose';
import { Gait, type GaitNetwork } from '../../core/estimation/gait/gait';
import type { GaitPoints } from '../../core/estimation/gait/gait-features';
import { type Quat, quat, slerp } from '../../core/math/quat';
import { type Side, sides } from '../../core/math/side';
import { vec3 } from '../../core/math/vec3';
import { recordOf } from '../../core/records';
import { type AvatarJoint, type HelperJoint, legJoints, type Rig } from '../rig/rig';
import { type SpreadLimb, spreadLimbOf } from '../rig/spread-limb-weights';
import { LegPosture, type LegProportions } from './leg-posture';

const bonesOf = {
  left: { thigh: 'leftUpperLeg', shank: 'leftLowerLeg', foot: 'leftFoot' },
  right: { thigh: 'rightUpperLeg', shank: 'rightLowerLeg', foot: 'rightFoot' },
} as const satisfies Record<Side, Record<string, AvatarJoint>>;

/** The proportions for a rig without legs. */
const averageLegs: LegProportions = {
  hipOffset: vec3(0.09, -0.06, 0),
  upper: 0.42,
  lower: 0.42,
  ankleHeight: 0.08,
  hipsFraction: 1,
};

const averageEyeHeight = 1.6;

/**
 * Returns the rig's own proportions below hips at a fraction of this height [m], on a rig scaled by `rigScale`.
 */
export function legProportionsOf(rig: Rig, hipsHeight: number, rigScale: number, hipsFraction = 1): LegProportions {
  const hip = rig.rest('leftUpperLeg');
  const knee = rig.rest('leftLowerLeg');
  const ankle = rig.rest('leftFoot');
  const hips = rig.rest('hips');
  if (!hip || !knee || !ankle || !hips) return averageLegs;
  const downScale = (hipsHeight * hipsFraction) / hips.y;
  return {
    // The rig faces +Z, poses face −Z.
    hipOffset: vec3(Math.abs(hip.x - hips.x) * rigScale, (hip.y - hips.y) * downScale, -(hip.z - hips.z) * rigScale),
    upper: hip.distanceTo(knee) * downScale,
    // The ankle keeps the foot's own size; the rest of the difference goes to the shank.
    lower: knee.distanceTo(ankle) * downScale + ankle.y * (downScale - rigScale),
    ankleHeight: ankle.y * rigScale,
    hipsFraction,
  };
}

/**
 * The joints that are added to one leg. Each rotates half as far as the bone that begins there, so that hip, knee and
 * ankle bend in two steps and keep their girth.
 */
interface LegHelpers {
  readonly hip: HelperJoint;
  readonly knee: HelperJoint;
  readonly ankle: HelperJoint;
}

const half = quat(0, 0, 0, 1);
const halfway = (before: Quat, after: Quat): Quat => slerp(before, after, 0.5, half);

/** The legs of an avatar: a leg posture on the bones of its rig. */
export class Legs {
  private readonly posture: LegPosture;
  /** null: the rig lacks a bone of a leg. */
  private readonly helpers: Readonly<Record<Side, LegHelpers>> | null;

  constructor(
    private readonly rig: Rig,
    gait: GaitNetwork,
  ) {
    this.posture = new LegPosture(averageLegs, averageEyeHeight, new Gait(gait));
    const helpersOf = (side: Side): LegHelpers => ({
      hip: rig.addHelper(`${side}UpperLeg`, 'half'),
      knee: rig.addHelper(`${side}LowerLeg`, 'half'),
      ankle: rig.addHelper(`${side}Foot`, 'half'),
    });
    this.helpers = legJoints.every((name) => rig.bones.has(name)) ? recordOf(sides, helpersOf) : null;
  }

  /** Returns the joints among which the skin of the legs is to be shared. */
  limbs(): readonly SpreadLimb[] {
    return Object.values(this.helpers ?? {}).map(({ hip, knee, ankle }) => spreadLimbOf([hip, knee, ankle]));
  }

  /**
   * Fits the legs to a person with eyes and hips at these heights [m], on a rig scaled by `rigScale` whose hips are at
   * a fraction of that height; returns the lengths of its bones.
   */
  fit(eyeHeight: number, hipsHeight: number, rigScale: number, hipsFraction: number): LegProportions {
    const proportions = legProportionsOf(this.rig, hipsHeight, rigScale, hipsFraction);
    this.posture.fit(proportions, eyeHeight);
    return proportions;
  }

  /** Advances by one frame under the hips of a body, floor frame. feet: the ankles that trackers pin. */
  apply(points: GaitPoints, deltaSeconds: number, feet?: TrackedFeet): void {
    const { rig, posture, helpers } = this;
    if (!helpers) return;
    posture.update(points, deltaSeconds, feet);
    for (const side of sides) {
      const { hip, knee, ankle, thigh, shank, foot } = posture.legs[side];
      const bones = bonesOf[side];
      rig.place(bones.thigh, hip, thigh);
      rig.place(bones.shank, knee, shank);
      rig.place(bones.foot, ankle, foot);
      rig.placeHelper(helpers[side].hip, hip, halfway(points.hips.orientation, thigh));
      rig.placeHelper(helpers[side].knee, knee, halfway(thigh, shank));
      rig.placeHelper(helpers[side].ankle, ankle, halfway(shank, foot));
    }
  }
}
