import type { Transform } from '../math/pose';
import type { AvatarPose } from './avatar-pose';
import type { AvatarRef } from './avatar-ref';
import type { Calibration } from './calibration';

/** An avatar for one person alone, by what their page sent; equal ones are one object. */
export interface PersonalAvatar {
  readonly person: string;
  /** A stranger's text; null: the page sent none. */
  readonly reference: string | null;
}

/** Another person to draw in this frame. Rooms yield the same object in every frame: copy what you keep. */
export interface RemotePerson<Wanted = AvatarRef, Id = number> {
  /** The number or name of the person, in a room the number of the seat; the same one is the same body. */
  readonly id: Id;
  readonly calibration: Calibration;
  readonly avatar: Wanted;
  /** The palette of a built-in body; null: its own colours. */
  readonly palette: string | null;
  /** The pose in the frame of the person's own floor, with the fingers. */
  readonly pose: AvatarPose;
  /** The person's floor in the floor frame of this page. */
  readonly placement: Transform<'floor', 'floor'>;
  /** 1: live. Less: a ghost, because no packet has arrived for a while. */
  readonly opacity: number;
}
