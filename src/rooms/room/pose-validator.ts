import { copyVec3, distance, setVec3, vec3 } from 'threepoint/math';
import { packetSecondsBetween } from '../protocol/packet-time';
import type { PointsPacket } from '../protocol/pose-packet';
import { TokenBucket } from './token-bucket';

/** A player's pose is deleted this long after it was sent [s], because movements identify people: 2 s less a tick. */
export const poseRetentionSeconds = 1.9;
/** A head moves at most this fast [m/s], unless the packet says that its space was re-anchored. */
export const maxHeadSpeed = 20;
/** A head may be moved this far [m] by rounding and by a hiccup of its device. */
const headTolerance = 0.1;
/** The most packets of a seat that wait to be forwarded: more arrive together only after the host was blocked. */
const maxWaitingPackets = 16;
/** After this long without an accepted pose [s] any position is accepted: a device has found its position again. */
const speedCheckSeconds = 1;
/** A packet's time may lie this far ahead of the room clock [s]: a sender knows that clock to half a round trip. */
const maxLeadSeconds = 0.25;
/**
 * How often a space may be re-anchored, per second on average and at once: snap turns, recentring, change of devices.
 */
const jumpsPerSecond = 1;
const jumpsAtOnce = 4;

/** Checks the pose packets of one seat, and stores those that are not forwarded yet. Times are the room clock's [s]. */
export class PoseValidator {
  #lastSeenAt: number;
  /** The newest packet's own time. */
  #packetTime: number | null = null;
  /** The arrival of the newest pose that is stored, here or in the match; null: none is. */
  #posedAt: number | null = null;
  /** The newest head position, as long as the pose is stored. */
  readonly #head = vec3(0, 0, 0);
  #isHeadKnown = false;
  #fresh: Uint8Array[] = [];
  readonly #jumps = new TokenBucket(jumpsPerSecond, jumpsAtOnce);

  constructor(time: number) {
    this.#lastSeenAt = time;
  }

  /** When the newest pose was accepted, or the player showed another sign of life. */
  get lastSeenAt(): number {
    return this.#lastSeenAt;
  }

  /** The newest pose's time by the sender's clock, limited to `maxLeadSeconds`; NaN before the first. */
  get packetTime(): number {
    return this.#packetTime ?? Number.NaN;
  }

  /** Records a sign of life other than a pose. */
  markSeen(time: number): void {
    this.#lastSeenAt = time;
  }

  /** Starts over on another connection: its poses are not compared with those of the old one. */
  reconnected(time: number): void {
    this.#lastSeenAt = time;
    this.#packetTime = null;
    this.#isHeadKnown = false;
  }

  /**
   * Accepts a packet and stores its bytes for forwarding. It rejects a packet that is older than the newest one, or in
   * which the head has moved faster than a person can.
   */
  accept(packet: PointsPacket, bytes: Uint8Array, time: number): 'accepted' | 'old' | 'too-fast' {
    // A time in the future would permit a jump later.
    const packetTime = time + Math.min(packetSecondsBetween(time * 1000, packet.timeMs), maxLeadSeconds);
    const { position } = packet.pose.head;
    if (time - this.#lastSeenAt <= speedCheckSeconds && this.#packetTime !== null) {
      const elapsed = packetTime - this.#packetTime;
      if (elapsed <= 0) return 'old';
      const reachable = headTolerance + maxHeadSpeed * elapsed;
      const leaps = this.#isHeadKnown && distance(position, this.#head) > reachable;
      if (leaps && !(packet.jump && this.#jumps.take(time))) return 'too-fast';
    }
    this.#packetTime = packetTime;
    copyVec3(position, this.#head);
    this.#isHeadKnown = true;
    this.#lastSeenAt = time;
    this.#posedAt = time;
    this.#fresh.push(bytes);
    if (this.#fresh.length > maxWaitingPackets) this.#fresh.shift();
    return 'accepted';
  }

  /** Removes and returns the packets to forward, oldest first. */
  takeFresh(): readonly Uint8Array[] {
    const fresh = this.#fresh;
    if (fresh.length > 0) this.#fresh = [];
    return fresh;
  }

  /** Whether a pose of the player is stored, here or in the match. */
  get hasPose(): boolean {
    return this.#posedAt !== null;
  }

  /** Deletes a pose that is older than `poseRetentionSeconds`; returns whether it did. */
  forgetExpired(time: number): boolean {
    if (this.#posedAt === null || time - this.#posedAt <= poseRetentionSeconds) return false;
    this.#posedAt = null;
    this.#isHeadKnown = false;
    setVec3(this.#head, 0, 0, 0);
    return true;
  }
}
