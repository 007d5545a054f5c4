import { conjugate, multiply, type Quat, rotate } from './quat';
import { add, scale, type Vec3 } from './vec3';

/**
 * The coordinate frames of the project, all right-handed, +Y up, −Z forward, metres (docs/frames.md).
 * floor: WebXR `local-floor`. heading: origin on the floor under the headset, yaw of the head. body: origin on the
 * floor under the head joint, yaw of the body (tracking/body-heading). arena: shared by players.
 */
export type Frame = 'floor' | 'heading' | 'body' | 'arena';

declare const frame: unique symbol;

/** Position [m] and orientation of something in frame F; F exists only in the type. */
export interface Pose<F extends Frame> {
  readonly position: Vec3;
  readonly orientation: Quat;
  readonly [frame]?: F;
}

declare const transformFrames: unique symbol;

/** The rigid transform that takes coordinates in From to coordinates in To; named toFromFrom: `headingFromFloor`. */
export interface Transform<To extends Frame, From extends Frame> {
  readonly position: Vec3;
  readonly orientation: Quat;
  readonly [transformFrames]?: readonly [To, From];
}

/** A point's coordinates in To. */
export const transformPoint = <To extends Frame, From extends Frame>(t: Transform<To, From>, point: Vec3): Vec3 =>
  add(t.position, rotate(t.orientation, point));

/** A pose in To. */
export const transformPose = <To extends Frame, From extends Frame>(
  t: Transform<To, From>,
  pose: Pose<From>,
): Pose<To> => ({
  position: transformPoint(t, pose.position),
  orientation: multiply(t.orientation, pose.orientation),
});

/** From From to To by way of Via. */
export const composeTransforms = <To extends Frame, Via extends Frame, From extends Frame>(
  toFromVia: Transform<To, Via>,
  viaFromFrom: Transform<Via, From>,
): Transform<To, From> => ({
  position: transformPoint(toFromVia, viaFromFrom.position),
  orientation: multiply(toFromVia.orientation, viaFromFrom.orientation),
});

export const invertTransform = <To extends Frame, From extends Frame>(t: Transform<To, From>): Transform<From, To> => {
  const orientation = conjugate(t.orientation);
  return { position: scale(rotate(orientation, t.position), -1), orientation };
};
