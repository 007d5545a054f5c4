import { copyVec3, distance, setVec3, vec3 } from 'threepoint/core/math/vec3';
import { packetSecondsBetween } from '../protocol/packet-time';
import type { PointsPacket } from '../protocol/pose-packet';
import { TokenBucket } from './token-bucket';

/** A player's pose is forgotten this long after it was sent [s]: movements identify people. With a tick to spare of 2 s. */
export const poseMemory = 1.9;
/** No head moves faster [m/s] without saying that its space was re-anchored. */
export const fastestHead = 20;
/** A head may be moved this far [m] by rounding and by a hiccup of its device. */
const headTolerance = 0.1;
/** Packets of a seat that wait to be passed on, at most: more come together only after the host stood still. */
const mostFresh = 16;
/** What was refused for its speed is believed after this [s]: a device that lost its place has found it again. */
const speedCheckSeconds = 1;
/** A packet may give itself a time this far ahead of the room's clock [s]: the sender knows that clock up to half a round trip. */
const mostAhead = 0.25;
/** How often a space may be re-anchored, on average a second and at once: by snap turns, recentring and a change of devices. */
const jumpsPerSecond = 1;
const jumpsAtOnce = 4;

/** What one seat claims of its poses, and what of that is believed. Times are the room clock's [s]. */
export class PoseValidator {
  #lastSeenAt: number;
  /** The time that the newest packet gives itself. */
  #packetTime: number | null = null;
  /** Of the newest pose that is remembered, here or in the match; null: none is. */
  #posedAt: number | null = null;
  /** Where the head was; known as long as the pose is remembered. */
  readonly #head = vec3(0, 0, 0);
  #isHeadKnown = false;
  #fresh: Uint8Array[] = [];
  readonly #jumps = new TokenBucket(jumpsPerSecond, jumpsAtOnce);

  constructor(time: number) {
    this.#lastSeenAt = time;
  }

  /** When the newest pose was believed, or another sign of life was given. */
  get lastSeenAt(): number {
    return this.#lastSeenAt;
  }

  /** When the newest pose was, by the sender's clock as far as it is believed; NaN before the first. */
  get packetTime(): number {
    return this.#packetTime ?? Number.NaN;
  }

  /** The player gave a sign of life other than a pose. */
  markSeen(time: number): void {
    this.#lastSeenAt = time;
  }

  /** The player is back on another connection: nothing is compared with what the old one claimed. */
  reconnected(time: number): void {
    this.#lastSeenAt = time;
    this.#packetTime = null;
    this.#isHeadKnown = false;
  }

  /** Takes a packet in, and keeps its bytes until they are passed on, unless it is older than the newest one or its head is further from there than a person gets. */
  accept(packet: PointsPacket, bytes: Uint8Array, time: number): 'believed' | 'old' | 'too-fast' {
    // A time from the future would be credit for a leap.
    const packetTime = time + Math.min(packetSecondsBetween(time * 1000, packet.timeMs), mostAhead);
    const { position } = packet.pose.head;
    if (time - this.#lastSeenAt <= speedCheckSeconds && this.#packetTime !== null) {
      const elapsed = packetTime - this.#packetTime;
      if (elapsed <= 0) return 'old';
      const reachable = headTolerance + fastestHead * elapsed;
      const leaps = this.#isHeadKnown && distance(position, this.#head) > reachable;
      if (leaps && !(packet.jump && this.#jumps.take(time))) return 'too-fast';
    }
    this.#packetTime = packetTime;
    copyVec3(position, this.#head);
    this.#isHeadKnown = true;
    this.#lastSeenAt = time;
    this.#posedAt = time;
    this.#fresh.push(bytes);
    if (this.#fresh.length > mostFresh) this.#fresh.shift();
    return 'believed';
  }

  /** The packets that have not been passed on yet, oldest first, once. */
  takeFresh(): readonly Uint8Array[] {
    const fresh = this.#fresh;
    if (fresh.length > 0) this.#fresh = [];
    return fresh;
  }

  /** A pose of the player is remembered, here or in the match. */
  get hasPose(): boolean {
    return this.#posedAt !== null;
  }

  /** Forgets a pose that is older than `poseMemory`; true: it did so now. */
  forgetExpired(time: number): boolean {
    if (this.#posedAt === null || time - this.#posedAt <= poseMemory) return false;
    this.#posedAt = null;
    this.#isHeadKnown = false;
    setVec3(this.#head, 0, 0, 0);
    return true;
  }
}
