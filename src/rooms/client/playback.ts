import { clamp, smoothingFactor, smoothstep } from 'threepoint/core/math/damper';
import { packetSecondsBetween } from '../protocol/packet-time';
import type { PosePacket } from '../protocol/pose-packet';
import { PathFit, type PathSample } from './path-fit';
import { ShownPlayer } from './shown-player';
import { TransitWindow } from './transit-window';

/** How playback of one player goes. */
export interface PlaybackReport {
  /** How far behind the newest that could be shown it is [s]. */
  readonly delay: number;
  /** The time of the sender's clock that is drawn [s, as packets tell it, unwrapped]; NaN: nothing is. Behind it nothing stands still. */
  readonly shownTime: number;
  /** Times it stood still for more than 250 ms, and all of them together [s]. */
  readonly freezes: number;
  readonly frozenSeconds: number;
}

/**
 * Playback is this far behind [s], at first and at the ends of what the network's unevenness may make of it. At thirty packets a second an
 * even network makes 45 ms of it: the next packet has just come when the picture leaves the one before.
 */
export const firstDelay = 0.1;
export const shortestDelay = 0.04;
export const longestDelay = 0.2;
/** No one is drawn further ahead of their newest packet [s]. */
export const longestExtrapolation = 0.1;
/** Silence after which a player is a ghost, and after which they are hidden [s]. */
export const ghostAfter = 1;
export const hideAfter = 3;
const ghostOpacity = 0.35;
const fadeSeconds = 0.3;
/** The way from where playback stood still to where it goes on takes this long [s]. */
const rejoinSeconds = 0.2;
/** What was run ahead of slower and slower is caught up with at this many times the speed of life. */
const fastestPlayback = 1.5;
/** Standing still for longer than this [s] is a freeze. */
const freezeSeconds = 0.25;
/** Packets this far apart [s] are no path. */
const longestGap = 0.5;
/** The delay follows the network in this half-life [s]. */
const delayHalfLife = 0.5;
/** Transit times are judged over this long [s]: clocks drift, routes change. */
const transitMemory = 5;
/** Added to what the network's unevenness asks for [s]. */
const spare = 0.0115;
/** As pages send them; and how many in a row a way holds up that is worth waiting for. */
const posesPerSecond = 30;
const mostMissing = 15;

/** Seconds between two packets, as they mostly are. */
function intervalOf(samples: readonly PathSample[]): number {
  const first = samples[0];
  const last = samples[samples.length - 1];
  return first && last && samples.length > 1 ? (last.time - first.time) / (samples.length - 1) : 1 / 30;
}

/** Whether something leads from this sample to the next. */
function leadsOn(samples: readonly PathSample[], i: number): boolean {
  const next = samples[i + 1];
  return next !== undefined && !next.packet.jump && next.time - samples[i]!.time <= longestGap;
}

/** After a long silence nothing says how they got to where the next packet has them: they stand until they are there. */
function isBetweenPaths(samples: readonly PathSample[], time: number): boolean {
  for (let i = 1; i < samples.length; i++) {
    const { time: at, packet } = samples[i]!;
    const before = samples[i - 1]!.time;
    if (!packet.jump && at - before > longestGap && before <= time && time < at) return true;
  }
  return false;
}

/** A player whose space was re-anchored is elsewhere: nothing leads there. */
function isAcrossJump(samples: readonly PathSample[], time: number): boolean {
  for (const { time: at, packet } of samples) if (packet.jump && at <= time && time - at < rejoinSeconds) return true;
  return false;
}

function opacityAfter(silence: number): number {
  const ghost = 1 - (1 - ghostOpacity) * smoothstep(ghostAfter, ghostAfter + fadeSeconds, silence);
  return ghost * (1 - smoothstep(hideAfter - fadeSeconds, hideAfter, silence));
}

/** Plays one player's packets back a moment late. Times that are not known are NaN: a number and nothing else stays unboxed. */
export class Playback {
  private samples: PathSample[] = [];
  private readonly transits = new TransitWindow(transitMemory);
  private receivedAt = 0;
  /** Page's clock minus the sender's clock of what is drawn. */
  private clockOffset = Number.NaN;
  private delay = firstDelay;
  private followedAt = Number.NaN;
  /** What is drawn; the same object in every frame. */
  readonly shown = new ShownPlayer();
  private readonly fit = new PathFit();
  private isShown = false;
  private shownTime = Number.NaN;
  /** Where playback stood still, and when it went on. */
  private readonly rejoinFrom = new ShownPlayer();
  private rejoinAt = Number.NaN;
  private stalledAt = Number.NaN;
  private freezes = 0;
  private frozenSeconds = 0;

  receive(packet: PosePacket, arrivedAt: number): void {
    const last = this.samples[this.samples.length - 1];
    let time = last ? last.time + packetSecondsBetween(last.packet.timeMs, packet.timeMs) : packet.timeMs / 1000;
    const silent = arrivedAt - this.receivedAt > hideAfter;
    if (last && time <= last.time && !silent) return;
    if (last && silent) {
      // A player who was hidden comes back as they are now, even if their clock has been set back.
      this.samples = [];
      this.transits.clear();
      this.clockOffset = Number.NaN;
      time = packet.timeMs / 1000;
    }
    // Of packets that came to the relay at once only the newest is here: those between were as late as they are missing.
    const before = this.samples[this.samples.length - 1];
    if (before) {
      const missing = Math.min(Math.round((time - before.time) * posesPerSecond) - 1, mostMissing);
      for (let i = missing; i > 0; i--) this.transits.add(arrivedAt, arrivedAt - time + i / posesPerSecond);
    }
    this.samples.push({ time, arrivedAt, packet });
    this.receivedAt = arrivedAt;
    this.transits.add(arrivedAt, arrivedAt - time);
  }

  /** Writes into `shown` what is drawn at this time of the page's clock [s] and returns how solid it is; null: nothing is drawn. */
  follow(time: number): number | null {
    const { samples } = this;
    const silence = time - this.receivedAt;
    if (silence >= hideAfter) {
      // No pose is kept for longer than it is shown.
      if (samples.length > 1) samples.splice(0, samples.length - 1);
      this.isShown = false;
      this.stalledAt = Number.NaN;
      this.followedAt = time;
      return null;
    }
    const at = this.playhead(time);
    // One packet from before the playhead is where the path begins.
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
    return { delay: this.delay, shownTime: this.shownTime, freezes: this.freezes, frozenSeconds: this.frozenSeconds };
  }

  /** The time of the sender's clock that is drawn now; never goes back. */
  private playhead(time: number): number {
    const { transits } = this;
    const wanted = clamp(transits.late + intervalOf(this.samples) + spare, shortestDelay, longestDelay);
    const passed = Number.isNaN(this.followedAt) ? 0 : time - this.followedAt;
    this.delay += (wanted - this.delay) * smoothingFactor(delayHalfLife, passed);
    const goal = transits.least + this.delay;
    // A clock that was set afresh is another timeline; else the playhead hurries or dawdles by a tenth at most.
    if (Number.isNaN(this.clockOffset) || Math.abs(goal - this.clockOffset) > 0.5) this.clockOffset = goal;
    else this.clockOffset += clamp(goal - this.clockOffset, -0.1 * passed, 0.1 * passed);
    return time - this.clockOffset;
  }

  /** Writes what is drawn `at` this time of the sender's clock [s]; before the first packet: as that has it. */
  private sampleAt(at: number, time: number): void {
    const { samples, shown, fit } = this;
    let i = samples.length - 1;
    while (i > 0 && samples[i]!.time > at) i -= 1;
    // The path that leads through here: no one is drawn between two spaces, or on a way out of a silence.
    let from = i;
    let to = i;
    while (from > 0 && leadsOn(samples, from - 1)) from -= 1;
    while (leadsOn(samples, to)) to += 1;
    const a = samples[i]!;
    if (from === to || at <= a.time) {
      shown.copy(a.packet);
      this.shownTime = at;
      return;
    }
    this.shownTime = this.timeOnPath(at, samples[to]!.time, time);
    fit.solve(samples, from, to, this.shownTime, time);
    const b = i < to ? samples[i + 1]! : null;
    if (b) shown.follow(samples, fit, a.packet, b.packet, (at - a.time) / (b.time - a.time));
    else shown.follow(samples, fit, a.packet, a.packet, 1);
  }

  /** Beyond the last packet: on as it went, slower and slower, as it is ever less likely; and no leap when another comes after all. */
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
    const stood = time - this.stalledAt;
    if (stood > freezeSeconds) {
      this.freezes += 1;
      this.frozenSeconds += stood;
    }
    this.stalledAt = Number.NaN;
    if (!this.isShown) return;
    this.rejoinFrom.copy(this.shown);
    this.rejoinAt = time;
  }

  /** After a standstill they go from where they stood to where they are in a fifth of a second. */
  private rejoin(time: number, at: number): void {
    if (Number.isNaN(this.rejoinAt)) return;
    const share = smoothstep(0, rejoinSeconds, time - this.rejoinAt);
    if (share >= 1 || isAcrossJump(this.samples, at)) this.rejoinAt = Number.NaN;
    else this.shown.mix(this.rejoinFrom, this.shown, share);
  }
}
