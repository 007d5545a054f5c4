import type { Quat } from './quat';
import type { Vec3 } from './vec3';

/**
 * The coordinate frames of the project, all right-handed, +Y up, −Z forward, metres (docs/frames.md).
 * floor: WebXR `local-floor`. heading: origin on the floor under the headset, yaw of the head. arena: shared by players.
 */
export type Frame = 'floor' | 'heading' | 'arena';

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
