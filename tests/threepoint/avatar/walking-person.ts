import { fromAxisAngle, identity, up, vec3 } from 'threepoint/math';
import { LegPosture, type LegProportions } from '../../../src/threepoint/avatar/legs/leg-posture';
import { Gait } from '../../../src/threepoint/core/estimation/gait/gait';
import type { GaitPoints } from '../../../src/threepoint/core/estimation/gait/gait-features';
import { shippedGait } from '../../../src/threepoint/core/estimation/gait/shipped-gait';

export const eyeHeight = 1.6;
export const proportions: LegProportions = {
  hipOffset: vec3(0.09, -0.06, -0.04),
  upper: 0.42,
  lower: 0.42,
  ankleHeight: 0.08,
  hipsFraction: 1,
};

/** Returns the legs that the page draws for a person of these measures. */
export const createLegs = (of = proportions): LegPosture => new LegPosture(of, eyeHeight, new Gait(shippedGait));

/** A person 1.6 m high at the eyes who stands at the origin, hands hanging, and leans and sways a little. */
export function standing(time: number): GaitPoints {
  const sway = 0.015 * Math.sin(1.7 * time);
  return {
    hips: { position: vec3(0.5 * sway, 0.97, 0.05), orientation: identity },
    head: { position: vec3(sway, eyeHeight, -0.08), orientation: identity },
    leftHand: vec3(-0.25 + sway, 0.8, 0),
    rightHand: vec3(0.25 + sway, 0.8, 0),
  };
}

/** Returns the person walking on the spot of a moving floor: head and hips bob, arms swing, 1 m/s towards −Z. */
export function walking(time: number): GaitPoints {
  const phase = 2 * Math.PI * 0.9 * time;
  const z = -time;
  const bob = 0.02 * Math.cos(2 * phase);
  const side = 0.02 * Math.sin(phase);
  return {
    hips: { position: vec3(side, 0.96 + bob, z + 0.05), orientation: fromAxisAngle(up, 0.08 * Math.cos(phase)) },
    head: { position: vec3(side, eyeHeight - 0.02 + bob, z - 0.1), orientation: identity },
    leftHand: vec3(-0.27, 0.85, z - 0.2 * Math.sin(phase)),
    rightHand: vec3(0.27, 0.85, z + 0.2 * Math.sin(phase)),
  };
}
