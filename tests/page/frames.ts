import type { TrackingFrame } from 'threepoint/core';
import { identity, type TrackedPose, vec3 } from 'threepoint/math';

/** A tracked head or hand at this place of the floor [m] that points ahead. */
export const trackedAt = (x: number, y: number, z: number): TrackedPose => ({
  position: vec3(x, y, z),
  orientation: identity,
  tracking: 'tracked',
});

/** A frame of a user whose eyes are this high [m] and look ahead, without hands. */
export const headFrame = (time: number, eyeHeight: number): TrackingFrame => ({
  time,
  head: trackedAt(0, eyeHeight, 0),
  leftHand: null,
  rightHand: null,
});
