import type { Transform } from '../math/pose';
import type { AvatarPose } from './avatar-pose';
import type { AvatarRef } from './avatar-ref';
import type { Calibration } from './calibration';
import type { Fingers } from './hand-shape';

/** Another person to draw in this frame. Rooms yield the same object in every frame: copy what you keep. */
export interface RemotePerson {
  /** The number of the person, in a room that of the seat; the same number is the same body. */
  readonly id: number;
  readonly calibration: Calibration;
  readonly avatar: AvatarRef;
  /** The palette of a built-in body; null: its own colours. */
  readonly palette: string | null;
  /** The pose in the frame of the person's own floor. */
  readonly pose: AvatarPose;
  readonly fingers: Fingers;
  /** The person's floor in the floor frame of this page. */
  readonly placement: Transform<'floor', 'floor'>;
  /** 1: live. Less: a ghost, because no packet has arrived for a while. */
  readonly opacity: number;
}
