import type { AvatarPose, UpperBodyPose } from '../core/body/avatar-pose';
import { type JointName, jointNames, type Side } from '../core/body/joints';
import { clamp, dampedShare, smoothstep } from '../core/math/damper';
import { type Quat, slerp } from '../core/math/quat';
import { lerp } from '../core/math/vec3';
import type { FingerCurl, PosePacket } from '../core/protocol/pose-codec';
import type { TrackedPose } from '../core/tracking/tracking-frame';
import type { ArrivedPose } from './connection';

/** Somebody else as they are to be drawn now. */
export interface RemotePlayer {
  readonly seat: number;
  /** Floor frame of their seat. */
  readonly pose: AvatarPose;
  readonly grips: PosePacket['grips'];
  readonly curls: PosePacket['curls'];
  /** 1: live. Less: a ghost, because nothing was heard of them for a while. */
  readonly opacity: number;
}

/** How playback of one player goes. */
export interface PlaybackReport {
  /** How far behind the newest that could be shown it is [s]. */
  readonly delay: number;
  /** Times it stood still for more than 250 ms, and all of them together [s]. */
  readonly freezes: number;
  readonly frozenSeconds: number;
}

/** The newest packets of the other players, played back a moment late so that frames come evenly. */
export interface RemotePlayers {
  receive(arrived: ArrivedPose): void;
  /** Whoever is to be drawn at this time of the page's clock [s]; silent for 3 s: not drawn. */
  follow(time: number): readonly RemotePlayer[];
  /** Somebody else sits there now. */
  forget(seat: number): void;
  /** null: nobody has been heard from this seat. */
  report(seat: number): PlaybackReport | null;
}

/** Playback is this far behind [s], at first and at the ends of what the network's unevenness may make of it. */
export const firstDelay = 0.1;
export const shortestDelay = 0.066;
export const longestDelay = 0.2;
/** Nobody is drawn further ahead of their newest packet [s]. */
export const longestExtrapolation = 0.1;
/** Silence after which a player is a ghost, and after which they are hidden [s]. */
export const ghostAfter = 1;
export const hideAfter = 3;
const ghostOpacity = 0.35;
const fadeSeconds = 0.3;
/** The way from where playback stood still to where it goes on takes this long [s]. */
const rejoinSeconds = 0.2;
/** Standing still for longer than this [s] is a freeze. */
const freezeSeconds = 0.25;
/** Packets this far apart [s] are no path. */
const longestGap = 0.5;
/** The delay follows the network in this half-life [s]. */
const delayHalfLife = 0.5;
/** Transit times are judged over this long [s]: clocks drift, routes change. */
const transitMemory = 5;
const spare = 0.01;
/** As pages send them; and how many in a row a way holds up that is worth waiting for. */
const posesPerSecond = 30;
const mostMissing = 15;

interface Sample {
  /** By the sender's clock, unwrapped [s]. */
  readonly time: number;
  readonly packet: PosePacket;
}

type Shown = Omit<PosePacket, 'timeMs' | 'jump'>;

interface Player {
  samples: Sample[];
  /** Arrival minus sender's time of the last packets. */
  transits: { readonly at: number; readonly transit: number }[];
  heardAt: number;
  /** Page's clock minus the sender's clock of what is drawn. */
  behind: number | null;
  delay: number;
  followedAt: number | null;
  shown: Shown | null;
  /** Where playback stood still, and when it went on. */
  rejoin: { readonly from: Shown; readonly at: number } | null;
  stalledAt: number | null;
  freezes: number;
  frozenSeconds: number;
}

const mixHand = (a: TrackedPose | null, b: TrackedPose | null, t: number): TrackedPose | null => {
  // A lost hand is nowhere, so there is no way from it or to it: it stays what it was until the packet that says otherwise.
  if (!a || !b) return t < 1 ? a : b;
  return {
    position: lerp(a.position, b.position, t),
    orientation: slerp(a.orientation, b.orientation, t),
    tracking: t < 1 ? a.tracking : b.tracking,
  };
};

const mixBody = (a: UpperBodyPose | null, b: UpperBodyPose | null, t: number): UpperBodyPose | null => {
  if (!a || !b) return t < 1 ? a : b;
  const localRotations = {} as Record<JointName, Quat>;
  for (const name of jointNames) localRotations[name] = slerp(a.localRotations[name], b.localRotations[name], t);
  return { hipsPosition: lerp(a.hipsPosition, b.hipsPosition, t), localRotations };
};

const mixNumber = (a: number, b: number, t: number): number => a + (b - a) * t;

const mixCurl = (a: FingerCurl | null, b: FingerCurl | null, t: number): FingerCurl | null => {
  if (!a || !b) return t < 1 ? a : b;
  return a.map((finger, i) => clamp(mixNumber(finger, b[i] ?? finger, t), 0, 1)) as unknown as FingerCurl;
};

/** From a (t = 0) to b (t = 1), and on beyond b. */
function mix(a: Shown, b: Shown, t: number): Shown {
  const within = Math.min(t, 1);
  const both = <T>(of: (side: Side) => T): Record<Side, T> => ({ left: of('left'), right: of('right') });
  return {
    pose: {
      head: {
        position: lerp(a.pose.head.position, b.pose.head.position, t),
        orientation: slerp(a.pose.head.orientation, b.pose.head.orientation, t),
        tracking: t < 1 ? a.pose.head.tracking : b.pose.head.tracking,
      },
      leftHand: mixHand(a.pose.leftHand, b.pose.leftHand, t),
      rightHand: mixHand(a.pose.rightHand, b.pose.rightHand, t),
      body: mixBody(a.pose.body, b.pose.body, t),
    },
    grips: both((side) => mixNumber(a.grips[side], b.grips[side], within)),
    curls: both((side) => mixCurl(a.curls[side], b.curls[side], within)),
  };
}

/** How evenly the newest packets came: how much later than the fastest of them all but one in twenty were [s]. */
function lateness(transits: Player['transits']): { readonly least: number; readonly late: number } {
  const sorted = transits.map(({ transit }) => transit).sort((a, b) => a - b);
  const least = sorted[0] ?? 0;
  return { least, late: (sorted[Math.floor(sorted.length * 0.95)] ?? least) - least };
}

/** Seconds between two packets, as they mostly are. */
function intervalOf(samples: readonly Sample[]): number {
  const first = samples[0];
  const last = samples[samples.length - 1];
  return first && last && samples.length > 1 ? (last.time - first.time) / (samples.length - 1) : 1 / 30;
}

const unwrapAfter = (timeMs: number, last: Sample): number => {
  const step = (((timeMs - last.packet.timeMs + 32768) % 65536) + 65536) % 65536;
  return last.time + (step - 32768) / 1000;
};

/** What is drawn of a player at a time of the sender's clock [s]; before the first packet: as that has it. */
function sampleAt(samples: readonly Sample[], time: number): Shown | null {
  const last = samples[samples.length - 1];
  const first = samples[0];
  if (!last || !first) return null;
  if (time <= first.time) return first.packet;
  for (let i = samples.length - 2; i >= 0; i--) {
    const a = samples[i]!;
    const b = samples[i + 1]!;
    if (time < a.time && i > 0) continue;
    const span = b.time - a.time;
    const path = !b.packet.jump && span <= longestGap;
    if (time < b.time) return path ? mix(a.packet, b.packet, (time - a.time) / span) : a.packet;
    if (!path) return b.packet;
    // Beyond the newest: on as it went, slower and slower, as it is ever less likely.
    const beyond = Math.min(time - b.time, 10);
    const ahead = longestExtrapolation * (1 - Math.exp(-beyond / longestExtrapolation));
    return mix(a.packet, b.packet, 1 + ahead / span);
  }
  return last.packet;
}

function opacityAfter(silence: number): number {
  const ghost = 1 - (1 - ghostOpacity) * smoothstep(ghostAfter, ghostAfter + fadeSeconds, silence);
  return ghost * (1 - smoothstep(hideAfter - fadeSeconds, hideAfter, silence));
}

const newPlayer = (): Player => ({
  samples: [],
  transits: [],
  heardAt: 0,
  behind: null,
  delay: firstDelay,
  followedAt: null,
  shown: null,
  rejoin: null,
  stalledAt: null,
  freezes: 0,
  frozenSeconds: 0,
});

export function createRemotePlayers(): RemotePlayers {
  const players = new Map<number, Player>();

  function receive({ seat, packet, arrivedAt }: ArrivedPose): void {
    const player = players.get(seat) ?? newPlayer();
    players.set(seat, player);
    const last = player.samples[player.samples.length - 1];
    let time = last ? unwrapAfter(packet.timeMs, last) : packet.timeMs / 1000;
    const silent = arrivedAt - player.heardAt > hideAfter;
    if (last && time <= last.time && !silent) return;
    if (last && silent) {
      // Whoever was hidden comes back as they are now, whatever their clock says.
      player.samples = [];
      player.transits = [];
      player.behind = null;
      time = packet.timeMs / 1000;
    }
    // Of packets that came to the relay at once only the newest is here: those between were as late as they are missing.
    const before = player.samples[player.samples.length - 1];
    if (before) {
      const missing = Math.min(Math.round((time - before.time) * posesPerSecond) - 1, mostMissing);
      for (let i = missing; i > 0; i--) {
        player.transits.push({ at: arrivedAt, transit: arrivedAt - time + i / posesPerSecond });
      }
    }
    player.samples.push({ time, packet });
    player.heardAt = arrivedAt;
    player.transits.push({ at: arrivedAt, transit: arrivedAt - time });
    while (player.transits[0] && arrivedAt - player.transits[0].at > transitMemory) player.transits.shift();
  }

  /** The time of the sender's clock that is drawn now; never goes back. */
  function playhead(player: Player, time: number): number {
    const { least, late } = lateness(player.transits);
    const wanted = clamp(late + intervalOf(player.samples) + spare, shortestDelay, longestDelay);
    const passed = player.followedAt === null ? 0 : time - player.followedAt;
    player.delay += (wanted - player.delay) * dampedShare(delayHalfLife, passed);
    const goal = least + player.delay;
    // A clock that was set afresh is another timeline; else the playhead hurries or dawdles by a tenth at most.
    if (player.behind === null || Math.abs(goal - player.behind) > 0.5) player.behind = goal;
    else player.behind += clamp(goal - player.behind, -0.1 * passed, 0.1 * passed);
    return time - player.behind;
  }

  function watchStall(player: Player, stalled: boolean, time: number): void {
    if (stalled) {
      player.stalledAt ??= time;
    } else if (player.stalledAt !== null) {
      const stood = time - player.stalledAt;
      if (stood > freezeSeconds) {
        player.freezes += 1;
        player.frozenSeconds += stood;
      }
      player.stalledAt = null;
      if (player.shown) player.rejoin = { from: player.shown, at: time };
    }
  }

  function followPlayer(seat: number, player: Player, time: number): RemotePlayer | null {
    const silence = time - player.heardAt;
    if (silence >= hideAfter) {
      // Nobody's pose is kept for longer than it is shown.
      if (player.samples.length > 1) player.samples = player.samples.slice(-1);
      player.shown = null;
      player.stalledAt = null;
      player.followedAt = time;
      return null;
    }
    const at = playhead(player, time);
    player.followedAt = time;
    // One packet from before the playhead is where the path begins.
    while (player.samples.length > 2 && player.samples[1]!.time <= at - longestGap) player.samples.shift();
    const last = player.samples[player.samples.length - 1]!;
    const nowhere = isBetweenPaths(player.samples, at);
    watchStall(player, nowhere || at > last.time + longestExtrapolation, time);
    let shown = (nowhere && player.shown) || sampleAt(player.samples, at);
    if (!shown) return null;
    if (player.rejoin) {
      const share = smoothstep(0, rejoinSeconds, time - player.rejoin.at);
      if (share >= 1 || isAcrossJump(player.samples, at)) player.rejoin = null;
      else shown = mix(player.rejoin.from, shown, share);
    }
    player.shown = shown;
    return { seat, pose: shown.pose, grips: shown.grips, curls: shown.curls, opacity: opacityAfter(silence) };
  }

  return {
    receive,
    follow(time) {
      const drawn: RemotePlayer[] = [];
      for (const [seat, player] of players) {
        const remote = followPlayer(seat, player, time);
        if (remote) drawn.push(remote);
      }
      return drawn;
    },
    forget(seat) {
      players.delete(seat);
    },
    report(seat) {
      const player = players.get(seat);
      return player ? { delay: player.delay, freezes: player.freezes, frozenSeconds: player.frozenSeconds } : null;
    },
  };
}

/** After a long silence nothing says how they got to where the next packet has them: they stand until they are there. */
function isBetweenPaths(samples: readonly Sample[], time: number): boolean {
  return samples.some(({ time: at, packet }, i) => {
    const before = samples[i - 1];
    return before !== undefined && !packet.jump && at - before.time > longestGap && before.time <= time && time < at;
  });
}

/** Somebody whose space was re-anchored is elsewhere: nothing leads there. */
function isAcrossJump(samples: readonly Sample[], time: number): boolean {
  return samples.some(({ time: at, packet }) => packet.jump && at <= time && time - at < rejoinSeconds);
}
