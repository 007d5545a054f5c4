import {
  type AvatarPose,
  averageSkeleton,
  type Calibration,
  createJointPoses,
  forwardKinematics,
  type JointPoses,
  type Skeleton,
  sameMeasures,
} from 'threepoint/core';
import { emit, TypedEvents } from 'threepoint/internal';
import { Playback, type PlaybackReport } from '../client/playback';
import { decodePose } from '../protocol/pose-codec';
import type { FloorPlacement } from '../protocol/pose-packet';
import { TokenBucket } from '../room/token-bucket';
import type { PeerPacket, PeerProfile } from './peer-packet';
import { readPeerPacket } from './read-peer-packet';

/** Another person in one frame. The next `update` overwrites the object: copy what you keep. */
export interface RemotePose {
  readonly peer: string;
  readonly name: string;
  /** The reference to the avatar that the person sent; null: none. It is a stranger's text: check it before use. */
  readonly avatar: string | null;
  readonly calibration: Calibration;
  /** Head, hands, body and fingers in the sender's floor frame [m]. */
  readonly pose: AvatarPose;
  /** Every joint in the sender's floor frame [m]; null: the pose has no body (hands only). */
  readonly joints: JointPoses | null;
  /** The opening of the mouth, 0 to 1. */
  readonly mouth: number;
  /** The place of the sender's floor in the scene; null: at its origin. */
  readonly placement: FloorPlacement | null;
  /** 1: live. Less: a ghost, because no packet has arrived for over a second. */
  readonly opacity: number;
}

/** The events of remote people with their fields. */
export interface RemoteEvents {
  /**
   * A packet was refused. `preventDefault` suppresses the warning on the console, which reports the first one of each
   * peer.
   */
  readonly refused: { readonly peer: string; readonly reason: string };
  /** The peer was removed because it sent nothing for 30 s. */
  readonly peertimeout: { readonly peer: string };
}

/** Receives an event of remote people. */
export type RemoteListener<Name extends keyof RemoteEvents> = (event: Event & RemoteEvents[Name]) => void;

export interface RemotePosesOptions {
  /** The maximum number of peers; packets of further ones are refused. Default: 64. */
  readonly maxPeers?: number;
}

/** The limit of packets of a peer: three times the rate of a `PoseSender` of 30 Hz, and a second of them at once. */
const packetsPerSecond = 90;
/** A peer that sends nothing for this long [s] is removed. */
const forgetAfter = 30;

/**
 * Decodes the packets of other people and plays their poses back without jitter. It needs no three.js.
 *
 * @example
 * const poses = new RemotePoses();
 * channel.onmessage = ({ data }) => poses.receive(performance.now(), peer, data);
 * for (const { name, joints } of poses.update(performance.now())) drawStickFigure(name, joints);
 */
export class RemotePoses {
  readonly #peers = new Map<string, Peer>();
  readonly #drawn: RemotePose[] = [];
  readonly #events = new TypedEvents<RemoteEvents>();
  readonly #maxPeers: number;
  readonly #warned = new Set<string>();

  constructor({ maxPeers = 64 }: RemotePosesOptions = {}) {
    this.#maxPeers = maxPeers;
  }

  addEventListener<Name extends keyof RemoteEvents>(type: Name, listener: RemoteListener<Name>): void {
    this.#events.addEventListener(type, listener);
  }

  removeEventListener<Name extends keyof RemoteEvents>(type: Name, listener: RemoteListener<Name>): void {
    this.#events.removeEventListener(type, listener);
  }

  /**
   * Handles a packet of a peer that arrives at this time [ms] on the clock of `update`. `peer` identifies the sender
   * and must come from the transport, not from the packet. Returns whether the packet was accepted; a malformed one,
   * one too many or one of another version is refused. Never throws.
   */
  receive(timeMs: number, peer: string, bytes: Uint8Array | ArrayBuffer): boolean {
    const known = this.#peers.get(peer);
    if (!known && this.#peers.size >= this.#maxPeers) {
      return this.#reject(peer, `there are ${this.#maxPeers} peers, as many as may be`);
    }
    const person = known ?? new Peer(peer, timeMs / 1000);
    // Added even if its first packet is refused, so that invalid packets count towards the limit.
    this.#peers.set(peer, person);
    if (!person.acceptsPacket(timeMs / 1000)) return this.#reject(peer, 'it sends too many packets');
    const packet = readPeerPacket(bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes));
    if (typeof packet === 'string') return this.#reject(peer, packet);
    const rejection = person.receive(packet, timeMs / 1000);
    return rejection === null || this.#reject(peer, rejection);
  }

  /**
   * Returns the people to draw at this time [ms] on the page's clock, without those who have no pose. The array is
   * reused in every frame.
   */
  update(timeMs: number): readonly RemotePose[] {
    const time = timeMs / 1000;
    this.#drawn.length = 0;
    for (const peer of this.#peers.values()) {
      if (peer.isTimedOut(time)) {
        this.remove(peer.peer);
        emit(this.#events, 'peertimeout', { peer: peer.peer });
      } else if (peer.follow(time)) this.#drawn.push(peer);
    }
    return this.#drawn;
  }

  /** Removes a peer who has left. A later packet of that peer adds it again. */
  remove(peer: string): void {
    this.#peers.delete(peer);
    this.#warned.delete(peer);
  }

  /** Returns measurements of a peer's playback; null: an unknown peer. */
  report(peer: string): PlaybackReport | null {
    return this.#peers.get(peer)?.report() ?? null;
  }

  #reject(peer: string, reason: string): false {
    if (!emit(this.#events, 'refused', { peer, reason })) this.#warnOnce(peer, reason);
    return false;
  }

  #warnOnce(peer: string, reason: string): void {
    // Bounded, because senders choose names.
    if (this.#warned.has(peer) || this.#warned.size >= this.#maxPeers) return;
    this.#warned.add(peer);
    console.warn(`threepoint-rooms: a packet of ${JSON.stringify(peer)} was refused: ${reason}.`);
  }
}

/** Another person: the profile, the playback of the poses, and the current pose. */
class Peer implements RemotePose {
  readonly #bucket = new TokenBucket(packetsPerSecond);
  readonly #playback = new Playback();
  readonly pose: AvatarPose = this.#playback.shown.pose;
  readonly #joints = createJointPoses();
  #profile: PeerProfile | null = null;
  #skeleton: Skeleton | null = null;
  #lastPacketAt: number;
  #hasPose = false;
  mouth = 0;
  opacity = 1;

  constructor(
    readonly peer: string,
    firstPacketAt: number,
  ) {
    this.#lastPacketAt = firstPacketAt;
  }

  get name(): string {
    return this.#profile?.name ?? '';
  }

  get avatar(): string | null {
    return this.#profile?.avatar ?? null;
  }

  get calibration(): Calibration {
    return this.#profile!.calibration;
  }

  get placement(): FloorPlacement | null {
    return this.#playback.shown.placement;
  }

  get joints(): JointPoses | null {
    const { body } = this.pose;
    return body && forwardKinematics(this.#skeleton!, body, this.#joints);
  }

  acceptsPacket(time: number): boolean {
    return this.#bucket.take(time);
  }

  isTimedOut(time: number): boolean {
    return time - this.#lastPacketAt > forgetAfter;
  }

  /** Handles a packet; returns why it is refused, or null. */
  receive(packet: PeerPacket, time: number): string | null {
    if (packet.kind === 'profile') {
      this.#setProfile(packet.profile);
    } else {
      // Poses are relative to the sender's measures: they cannot be decoded before the profile has arrived.
      if (!this.#skeleton) return null;
      const pose = decodePose(packet.pose, this.#skeleton);
      if (!pose) return 'its pose is malformed';
      this.#playback.receive({ ...pose, placement: packet.placement }, time);
      this.mouth = packet.mouth;
      this.#hasPose = true;
    }
    this.#lastPacketAt = time;
    return null;
  }

  /** Writes the pose of this time [s]; returns whether there is one to draw. */
  follow(time: number): boolean {
    if (!this.#hasPose) return false;
    const opacity = this.#playback.advance(time);
    this.opacity = opacity ?? 0;
    return opacity !== null;
  }

  report(): PlaybackReport {
    return this.#playback.report();
  }

  #setProfile(profile: PeerProfile): void {
    if (!this.#profile || !sameMeasures(profile.calibration, this.#profile.calibration)) {
      this.#skeleton = averageSkeleton(profile.calibration);
    }
    this.#profile = profile;
    if (!profile.visible) this.#hasPose = false;
  }
}
