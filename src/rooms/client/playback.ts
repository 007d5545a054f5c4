import { clamp, smoothingFactor, smoothstep } from 'threepoint/math';
import { packetSecondsBetween } from '../protocol/packet-time';
import type { PosePacket } from '../protocol/pose-packet';
import { PathFit, type PathSample } from './path-fit';
import { PoseBuffer } from './pose-buffer';
import { TransitWindow } from './transit-window';

/** Measurements of one player's playback. */
export interface PlaybackReport {
  /** The playout offset [s]: how far the drawn pose lies behind the newest one. */
  readonly playoutOffset: number;
  /** The drawn time of the sender's clock [s, unwrapped]; NaN: nothing is drawn. */
  readonly shownTime: number;
  /** The number of stalls of more than 250 ms, and their total [s]. */
  readonly freezes: number;
  readonly frozenSeconds: number;
}

/**
 * The first, shortest and longest playout offset [s]; between the limits the network's jitter decides. At 30 packets a
 * second without jitter it is 45 ms: the next packet has just arrived when playback reaches the one before.
 */
export const initialPlayoutOffset = 0.1;
const shortestDelay = 0.04;
const longestDelay = 0.2;
/** The longest extrapolation beyond the newest packet [s]. */
export const longestExtrapolation = 0.1;
/** Silence after which a player is a ghost, and after which they are hidden [s]. */
const ghostAfter = 1;
const hideAfter = 3;
const ghostOpacity = 0.35;
const fadeSeconds = 0.3;
/** After a stall the pose is blended to the new path over this time [s]. */
const rejoinSeconds = 0.2;
/** After an extrapolation playback catches up at most this fast [times real time]. */
const fastestPlayback = 1.5;
/** A stall longer than this [s] counts as a freeze. */
const freezeSeconds = 0.25;
/** Packets further apart than this [s] are not interpolated. */
const longestGap = 0.5;
/** The most packets that are stored while a hidden page draws no frames. */
const maxSamples = 256;
/** Half-life of the playout offset's adaptation [s]. */
const delayHalfLife = 0.5;
/** Window of the transit times [s]: clocks drift, routes change. */
const transitMemory = 5;
/** Margin of the playout offset above the jitter [s]. */
const spare = 0.0115;
/** Rate of the packets that pages send, and the most missing ones in a row that count as delayed. */
const posesPerSecond = 30;
const maxMissing = 15;

/** Returns the mean interval of the packets [s]. */
function intervalOf(samples: readonly PathSample[]): number {
  const first = samples[0];
  const last = samples[samples.length - 1];
  return first && last && samples.length > 1 ? (last.time - first.time) / (samples.length - 1) : 1 / 30;
}

/** Returns whether the path is continuous from this sample to the next. */
function isContinuous(samples: readonly PathSample[], i: number): boolean {
  const next = samples[i + 1];
  return next !== undefined && !next.packet.jump && next.time - samples[i]!.time <= longestGap;
}

/** Returns whether a time lies in a gap, after which the next packet starts another path: the pose stays until then. */
function isBetweenPaths(samples: readonly PathSample[], time: number): boolean {
  for (let i = 1; i < samples.length; i++) {
    const { time: at, packet } = samples[i]!;
    const before = samples[i - 1]!.time;
    if (!packet.jump && at - before > longestGap && before <= time && time < at) return true;
  }
  return false;
}

/** Returns whether the player's space was re-anchored just before this time; no path leads across that. */
function isAcrossJump(samples: readonly PathSample[], time: number): boolean {
  for (const { time: at, packet } of samples) if (packet.jump && at <= time && time - at < rejoinSeconds) return true;
  return false;
}

function opacityAfter(silence: number): number {
  const ghost = 1 - (1 - ghostOpacity) * smoothstep(ghostAfter, ghostAfter + fadeSeconds, silence);
  return ghost * (1 - smoothstep(hideAfter - fadeSeconds, hideAfter, silence));
}

/**
 * Plays one player's packets back through a jitter buffer. Unknown times are NaN, so that the fields stay unboxed
 * numbers.
 */
export class Playback {
  private samples: PathSample[] = [];
  private readonly transits = new TransitWindow(transitMemory);
  private receivedAt = 0;
  /** Whether the next packet starts playback over. */
  private resumed = false;
  /** The page's clock minus the drawn time of the sender's clock [s]. */
  private clockOffset = Number.NaN;
  private delay = initialPlayoutOffset;
  private followedAt = Number.NaN;
  /** The drawn pose; the same object in every frame. */
  readonly shown = new PoseBuffer();
  private readonly fit = new PathFit();
  private isShown = false;
  private shownTime = Number.NaN;
  /** The pose at the last stall, and the time at which playback resumed. */
  private readonly rejoinFrom = new PoseBuffer();
  private rejoinAt = Number.NaN;
  private stalledAt = Number.NaN;
  private freezes = 0;
  private frozenSeconds = 0;

  /** Starts over with the next packet. The pose is drawn until then. */
  resume(): void {
    this.resumed = true;
  }

  receive(packet: PosePacket, arrivedAt: number): void {
    const last = this.samples[this.samples.length - 1];
    let time = last ? last.time + packetSecondsBetween(last.packet.timeMs, packet.timeMs) : packet.timeMs / 1000;
    const silent = this.resumed || arrivedAt - this.receivedAt > hideAfter;
    this.resumed = false;
    if (last && time <= last.time && !silent) return;
    if (last && silent) {
      // After a long silence playback starts over, even if the sender's clock was set back.
      this.samples = [];
      this.transits.clear();
      this.clockOffset = Number.NaN;
      time = packet.timeMs / 1000;
    }
    // The relay may forward only the newest of several packets: the missing ones were late by as much.
    const before = this.samples[this.samples.length - 1];
    if (before) {
      const missing = Math.min(Math.round((time - before.time) * posesPerSecond) - 1, maxMissing);
      for (let i = missing; i > 0; i--) this.transits.add(arrivedAt, arrivedAt - time + i / posesPerSecond);
    }
    this.samples.push({ time, arrivedAt, packet });
    if (this.samples.length > maxSamples) this.samples.shift();
    this.receivedAt = arrivedAt;
    this.transits.add(arrivedAt, arrivedAt - time);
  }

  /**
   * Writes the pose at this time of the page's clock [s] into `shown` and returns its opacity; null: nothing is drawn.
   */
  advance(time: number): number | null {
    const { samples } = this;
    const silence = time - this.receivedAt;
    if (silence >= hideAfter) {
      // Poses are deleted when they are no longer shown.
      if (samples.length > 1) samples.splice(0, samples.length - 1);
      this.isShown = false;
      this.stalledAt = Number.NaN;
      this.followedAt = time;
      return null;
    }
    const at = this.playhead(time);
    // The path begins with one packet before the playhead.
    while (samples.length > 2 && samples[1]!.time <= at - longestGap) samples.shift();
    const last = samples[samples.length - 1]!;
    const nowhere = isBetweenPaths(samples, at);
    this.watchStall(nowhere || at > last.time + longestExtrapolation, time);
    if (!nowhere || !this.isShown) this.sampleAt(at, time);
    this.isShown = true;
    this.rejoin(time, at);
    this.followedAt = time;
    return opacityAfter(silence);
  }

  report(): PlaybackReport {
    return {
      playoutOffset: this.delay,
      shownTime: this.shownTime,
      freezes: this.freezes,
      frozenSeconds: this.frozenSeconds,
    };
  }

  /** Returns the time of the sender's clock to draw now; it never goes back. */
  private playhead(time: number): number {
    const { transits } = this;
    const wanted = clamp(transits.jitter + intervalOf(this.samples) + spare, shortestDelay, longestDelay);
    const passed = Number.isNaN(this.followedAt) ? 0 : time - this.followedAt;
    this.delay += (wanted - this.delay) * smoothingFactor(delayHalfLife, passed);
    const goal = transits.minimum + this.delay;
    // A larger difference means that a clock was set; otherwise the rate changes by a tenth at most.
    if (Number.isNaN(this.clockOffset) || Math.abs(goal - this.clockOffset) > 0.5) this.clockOffset = goal;
    else this.clockOffset += clamp(goal - this.clockOffset, -0.1 * passed, 0.1 * passed);
    return time - this.clockOffset;
  }

  /**
   * Writes the pose `at` this time of the sender's clock [s] into `shown`; before the first packet that packet's pose.
   */
  private sampleAt(at: number, time: number): void {
    const { samples, shown, fit } = this;
    let i = samples.length - 1;
    while (i > 0 && samples[i]!.time > at) i -= 1;
    // The samples of one path: nothing is interpolated across a re-anchored space or a gap.
    let from = i;
    let to = i;
    while (from > 0 && isContinuous(samples, from - 1)) from -= 1;
    while (isContinuous(samples, to)) to += 1;
    const a = samples[i]!;
    if (from === to || at <= a.time) {
      shown.copy(a.packet);
      this.shownTime = at;
      return;
    }
    this.shownTime = this.timeOnPath(at, samples[to]!.time, time);
    fit.solve(samples, from, to, this.shownTime, time);
    const b = i < to ? samples[i + 1]! : null;
    if (b) shown.writeFitted(samples, fit, a.packet, b.packet, (at - a.time) / (b.time - a.time));
    else shown.writeFitted(samples, fit, a.packet, a.packet, 1);
  }

  /**
   * Returns the time on the path: beyond the last packet it slows down, and after a late packet it catches up without a
   * jump.
   */
  private timeOnPath(at: number, last: number, time: number): number {
    const beyond = clamp(at - last, 0, 10);
    const goal = Math.min(at, last) + longestExtrapolation * (1 - Math.exp(-beyond / longestExtrapolation));
    const missed = goal - this.shownTime;
    if (!(missed > 0 && missed < longestExtrapolation)) return goal;
    return this.shownTime + Math.min(missed, fastestPlayback * (time - this.followedAt));
  }

  private watchStall(stalled: boolean, time: number): void {
    if (stalled) {
      if (Number.isNaN(this.stalledAt)) this.stalledAt = time;
      return;
    }
    if (Number.isNaN(this.stalledAt)) return;
    const stalledSeconds = time - this.stalledAt;
    if (stalledSeconds > freezeSeconds) {
      this.freezes += 1;
      this.frozenSeconds += stalledSeconds;
    }
    this.stalledAt = Number.NaN;
    if (!this.isShown) return;
    this.rejoinFrom.copy(this.shown);
    this.rejoinAt = time;
  }

  /** Blends from the pose at the stall to the current one over `rejoinSeconds`. */
  private rejoin(time: number, at: number): void {
    if (Number.isNaN(this.rejoinAt)) return;
    const fraction = smoothstep(0, rejoinSeconds, time - this.rejoinAt);
    if (fraction >= 1 || isAcrossJump(this.samples, at)) this.rejoinAt = Number.NaN;
    else this.shown.interpolate(this.rejoinFrom, this.shown, fraction);
  }
}
