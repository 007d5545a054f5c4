import {
  type AvatarPose,
  assertCalibration,
  averageSkeleton,
  type Calibration,
  type Skeleton,
  sameMeasures,
  unknownFingers,
} from 'threepoint/core';
import { encodePose } from '../protocol/pose-codec';
import type { FloorPlacement } from '../protocol/pose-packet';
import { toMillimetres } from '../protocol/sent-measures';
import { encodePeerPose, encodeProfile } from './peer-packet';

/** The source of the poses to send: a `BodyTracker` or `Body` of threepoint, for example. */
export interface PoseSource {
  /** The pose of the newest frame with its fingers, floor frame [m]; null: there is none, and others hide the body. */
  readonly pose: AvatarPose | null;
  readonly calibration: Calibration;
}

/** Optional data of a pose packet. */
export interface PoseSendOptions {
  /** The opening of the mouth, 0 to 1. Default: 0. */
  readonly mouth?: number;
  /** The pose of the floor in the scene. Default: the scene's origin. */
  readonly placement?: FloorPlacement | null;
}

export interface PoseSenderOptions {
  /** The name that the others see; at most 20 characters of it. */
  readonly name: string;
  /**
   * A reference by which the other pages load the avatar, at most 200 characters. Default: null, for which they choose
   * one.
   */
  readonly avatar?: string | null;
  /** Poses a second, 1 to 60. Default: 30. */
  readonly rateHz?: number;
}

/** The profile is sent again this often [ms], for peers that have joined since or have missed it. */
const profileMs = 1000;

/**
 * Encodes one person's body as packets for any transport: a WebSocket, a data channel, or another multiplayer
 * framework. Packets may be lost or reordered. None is longer than `maxPeerPacketBytes`; most have 70 bytes or less.
 *
 * @example
 * const sender = new PoseSender((bytes) => channel.send(bytes), { name: 'Ada' });
 * renderer.setAnimationLoop((timeMs, frame) => {
 *   tracker.update(timeMs, frame);
 *   sender.update(timeMs, tracker);
 * });
 */
export class PoseSender {
  readonly #send: (bytes: Uint8Array<ArrayBuffer>) => void;
  readonly #intervalMs: number;
  #name: string;
  #avatar: string | null;
  #calibration: Calibration | null = null;
  #skeleton: Skeleton | null = null;
  #visible = false;
  #nextPoseMs = Number.NEGATIVE_INFINITY;
  #nextProfileMs = Number.NEGATIVE_INFINITY;
  #jump = false;

  /**
   * `send` sends the bytes of a packet and may keep the array. Throws a RangeError for a rate outside 1 to 60, or an
   * avatar reference that is too long.
   */
  constructor(send: (bytes: Uint8Array<ArrayBuffer>) => void, { name, avatar = null, rateHz = 30 }: PoseSenderOptions) {
    if (!(rateHz >= 1 && rateHz <= 60)) throw new RangeError(`A rate of ${rateHz} poses a second is outside 1 to 60.`);
    this.#send = send;
    this.#intervalMs = 1000 / rateHz;
    this.#name = name;
    this.#avatar = avatar;
    // Checked here, so that the first frame does not throw.
    assertAvatarReference(avatar);
  }

  /**
   * Sends the packets that are due. Call it in every frame with its time [ms] on any monotonic clock. Without a pose it
   * sends once a second that the person is not visible. Throws a RangeError for measures that no person has.
   */
  update(timeMs: number, { pose, calibration }: PoseSource, frame: PoseSendOptions = {}): void {
    this.#setCalibration(calibration);
    if (this.#visible !== (pose !== null)) this.sendProfile();
    this.#visible = pose !== null;
    if (timeMs >= this.#nextProfileMs) this.#transmitProfile(timeMs);
    if (!pose || (timeMs < this.#nextPoseMs && !this.#jump)) return;
    // Frames have their own rate; this keeps the average.
    this.#nextPoseMs = Math.max(this.#nextPoseMs + this.#intervalMs, timeMs + this.#intervalMs / 2);
    const bytes = encodePose(
      { timeMs, jump: this.#jump, pose, fingers: pose.fingers ?? unknownFingers },
      this.#skeleton!,
    );
    if (!bytes) return;
    this.#jump = false;
    this.#send(encodePeerPose(bytes, frame.mouth ?? 0, frame.placement ?? null));
  }

  /** Sends the profile with the next `update`, for a peer who has just joined; otherwise that takes up to a second. */
  sendProfile(): void {
    this.#nextProfileMs = Number.NEGATIVE_INFINITY;
  }

  /**
   * Marks the next pose as a jump, because the space was re-anchored or the user teleported: others do not interpolate
   * to it.
   */
  discontinuity(): void {
    this.#jump = true;
  }

  /** Changes the name. */
  setName(name: string): void {
    this.#name = name;
    this.sendProfile();
  }

  /** Changes the reference to the avatar. Throws a RangeError if it is too long. */
  setAvatar(avatar: string | null): void {
    assertAvatarReference(avatar);
    this.#avatar = avatar;
    this.sendProfile();
  }

  #setCalibration(calibration: Calibration): void {
    if (this.#calibration && sameMeasures(calibration, this.#calibration)) return;
    assertCalibration(calibration);
    this.#calibration = calibration;
    // The others know the measures rounded to millimetres.
    this.#skeleton = averageSkeleton(toMillimetres(calibration));
    this.sendProfile();
  }

  #transmitProfile(timeMs: number): void {
    this.#nextProfileMs = timeMs + profileMs;
    const profile = { name: this.#name, calibration: this.#calibration!, avatar: this.#avatar, visible: this.#visible };
    this.#send(encodeProfile(profile));
  }
}

/** Throws a RangeError if the reference to an avatar is too long for a profile. */
function assertAvatarReference(avatar: string | null): void {
  encodeProfile({ name: '', avatar, visible: false, calibration: { eyeHeight: 1.6, armSpan: 1.5 } });
}
