import type { TrackedFeet } from '../../core/body/avatar-pose';
import type { GaitPoints } from '../../core/estimation/gait/gait-features';
import { type Side, sides } from '../../core/math/side';
import { vec3 } from '../../core/math/vec3';
import { LegHelperJoints } from '../rig/leg-helpers';
import { type AvatarJoint, legJoints, type Rig } from '../rig/rig';
import type { SpreadLimb } from '../rig/spread-limb-weights';
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
};

const averageEyeHeight = 1.6;

/** Returns the rig's own proportions below hips at this height [m], on a rig scaled by `rigScale`. */
export function legProportionsOf(rig: Rig, hipsHeight: number, rigScale: number): LegProportions {
  const hip = rig.rest('leftUpperLeg');
  const knee = rig.rest('leftLowerLeg');
  const ankle = rig.rest('leftFoot');
  const hips = rig.rest('hips');
  if (!hip || !knee || !ankle || !hips) return averageLegs;
  const downScale = hipsHeight / hips.y;
  return {
    // The rig faces +Z, poses face −Z.
    hipOffset: vec3(Math.abs(hip.x - hips.x) * rigScale, (hip.y - hips.y) * downScale, -(hip.z - hips.z) * rigScale),
    upper: hip.distanceTo(knee) * downScale,
    // The ankle keeps the foot's own size; the rest of the difference goes to the shank.
    lower: knee.distanceTo(ankle) * downScale + ankle.y * (downScale - rigScale),
    ankleHeight: ankle.y * rigScale,
  };
}

/** The legs of an avatar: a leg posture on the bones of its rig. */
export class Legs {
  private readonly posture = new LegPosture(averageLegs, averageEyeHeight);
  /** null: the rig lacks a bone of a leg. */
  private readonly helpers: LegHelperJoints | null;

  constructor(private readonly rig: Rig) {
    this.helpers = legJoints.every((name) => rig.bones.has(name)) ? new LegHelperJoints(rig) : null;
  }

  /** Returns the joints among which the skin of the legs is to be shared. */
  limbs(): readonly SpreadLimb[] {
    return this.helpers?.limbs() ?? [];
  }

  /**
   * Fits the legs to a person with eyes and hips at these heights [m], on a rig scaled by `rigScale`; returns the
   * lengths of its bones.
   */
  fit(eyeHeight: number, hipsHeight: number, rigScale: number): { readonly upper: number; readonly lower: number } {
    const proportions = legProportionsOf(this.rig, hipsHeight, rigScale);
    this.posture.fit(proportions, eyeHeight);
    return proportions;
  }

  /** Advances by one frame under the hips of a body, floor frame. feet: the ankles that trackers pin. */
  apply(points: GaitPoints, deltaSeconds: number, feet?: TrackedFeet): void {
    if (!this.helpers) return;
    this.posture.update(points, deltaSeconds, feet);
    for (const side of sides) {
      const leg = this.posture.legs[side];
      const { hip, knee, ankle, thigh, shank, foot } = leg;
      const bones = bonesOf[side];
      this.rig.place(bones.thigh, hip, thigh);
      this.rig.place(bones.shank, knee, shank);
      this.rig.place(bones.foot, ankle, foot);
      this.helpers.place(side, points.hips, leg);
    }
  }
}
