import {
  type AvatarPose,
  actorFrame,
  defaultCalibration,
  forwardKinematics,
  skeletonFromCalibration,
  type TrackingFrame,
  unknownFingers,
} from 'threepoint/core';
import {
  clamp,
  createNormalRandom,
  createRandom,
  distance,
  lerp,
  median,
  type TrackedPose,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { RemotePlayers } from '../../src/rooms/client/remote-players';
import { packetMs } from '../../src/rooms/protocol/packet-time';
import { decodePose, encodePose } from '../../src/rooms/protocol/pose-codec';
import type { PosePacket } from '../../src/rooms/protocol/pose-packet';
import { createIk } from '../../src/threepoint/core/estimation/estimators';
import { quantile } from '../../src/threepoint/core/math/statistics';
import { thirdDifference } from '../evaluate/measures';

/** A way from one page over the relay to another. */
export interface Way {
  /** The round-trip time between the two pages [s]. */
  readonly roundTrip: number;
  /** A packet takes up to so much longer or shorter [s]. */
  readonly jitter: number;
  /** Share of the packets that are lost, and sent again. */
  readonly loss: number;
}

/** What a person sees of another. */
export interface Seen {
  readonly way: Way;
  /** From the frame of the other's headset to the picture in which it is shown [ms]. */
  readonly p50Ms: number;
  readonly p95Ms: number;
  /** Standstills of more than 250 ms, a minute. */
  readonly freezes: number;
  /** Mean jerk of head, hands and elbows as they are drawn, to that in the other's own mirror. */
  readonly jerkRatio: number;
  /**
   * How far from where the other's mirror had them at the time that is shown these joints are drawn [mm]: 95 of 100 are
   * nearer.
   */
  readonly offP95Mm: number;
}

/** The standard deviation of a headset's positions, along each axis [m]: an assumption, which jerk depends on. */
const tremor = 3e-5;
const displayHz = 72;
const posesPerSecond = 30;
/** The first seconds are not counted: clocks and delays are found out in them. */
const settling = 6;
const joints = ['head', 'leftHand', 'rightHand', 'leftLowerArm', 'rightLowerArm'] as const;

const skeleton = skeletonFromCalibration(defaultCalibration);

/** Returns the positions of a body's joints [m]. */
function placesOf(pose: AvatarPose): readonly Vec3[] {
  if (!pose.body) throw new Error('bench/relay: the actor has no body');
  const places = forwardKinematics(skeleton, pose.body);
  return joints.map((name) => places[name].position);
}

/** Returns interpolated positions in the other user's mirror between two frames [m]. */
function placesAt(frames: readonly SentFrame[], time: number): readonly Vec3[] {
  const after = clamp(Math.ceil(time * displayHz), 1, frames.length - 1);
  const [a, b] = [frames[after - 1]!.places, frames[after]!.places];
  return a.map((place, i) => lerp(place, b[i]!, clamp(time * displayHz - (after - 1), 0, 1)));
}

const distancesBetween = (a: readonly Vec3[], b: readonly Vec3[]): readonly number[] =>
  a.map((place, i) => distance(place, b[i]!));

/** Sums of the third differences of places at the display's rate. */
class Jerk {
  readonly #last: (readonly Vec3[])[] = [];
  sum = 0;

  add(places: readonly Vec3[]): void {
    this.#last.push(places.map(({ x, y, z }) => ({ x, y, z })));
    if (this.#last.length > 4) this.#last.shift();
    const [a, b, c, d] = this.#last;
    if (!a || !b || !c || !d) return;
    for (let i = 0; i < joints.length; i++) {
      this.sum += thirdDifference(a[i]!, b[i]!, c[i]!, d[i]!);
    }
  }
}

/**
 * When each packet arrives [s], by when it leaves: over TCP, so in order, and what is lost holds up all behind it until
 * it is sent again.
 */
function arrivals(leaving: readonly number[], { roundTrip, jitter, loss }: Way, seed: number): readonly number[] {
  const chance = createRandom(seed);
  let last = 0;
  return leaving.map((time) => {
    // Three later packets reveal a loss; then half a round trip to the sender, and half a one back.
    const again = chance() < loss ? roundTrip + 3 / posesPerSecond : 0;
    last = Math.max(last, time + Math.max(0, roundTrip / 2 + jitter * (2 * chance() - 1)) + again);
    return last;
  });
}

/** Adds tracker noise to the positions of a frame. */
function trembling(frame: TrackingFrame, noise: () => number): TrackingFrame {
  const moved = (pose: TrackedPose): TrackedPose => {
    const { x, y, z } = pose.position;
    return { ...pose, position: vec3(x + tremor * noise(), y + tremor * noise(), z + tremor * noise()) };
  };
  const { head, leftHand, rightHand } = frame;
  return {
    ...frame,
    head: moved(head),
    leftHand: leftHand && moved(leftHand),
    rightHand: rightHand && moved(rightHand),
  };
}

interface SentFrame {
  readonly time: number;
  readonly pose: AvatarPose;
  readonly places: readonly Vec3[];
}

/** The performances by their seconds: they are the same over every way. */
const performances = new Map<number, readonly SentFrame[]>();

/** What the other's mirror shows, picture by picture. */
function performed(seconds: number): readonly SentFrame[] {
  const before = performances.get(seconds);
  if (before) return before;
  const ik = createIk(defaultCalibration);
  const noise = createNormalRandom(1);
  const frames = Array.from({ length: Math.floor(seconds * displayHz) }, (_, i) => {
    const time = i / displayHz;
    const { pose } = ik.update(trembling(actorFrame(time, defaultCalibration), noise));
    return { time, pose: structuredClone(pose), places: placesOf(pose).map(({ x, y, z }) => vec3(x, y, z)) };
  });
  performances.set(seconds, frames);
  return frames;
}

/** Thirty of them a second, as a page sends them. */
function sentOf(frames: readonly SentFrame[]): readonly SentFrame[] {
  let due = 0;
  return frames.filter(({ time }) => {
    if (time < due) return false;
    due = Math.max(due + 1 / posesPerSecond, time + 0.5 / posesPerSecond);
    return true;
  });
}

/** Encodes and decodes a pose, as the network does. */
function packetOf({ time, pose }: SentFrame): PosePacket {
  const timeMs = packetMs(time * 1000);
  const bytes = encodePose({ timeMs, jump: false, pose, fingers: unknownFingers }, skeleton);
  const packet = bytes && decodePose(bytes, skeleton);
  if (!packet) throw new Error('bench/relay: the actor has no pose');
  return packet;
}

/** Simulates one person seen by another through the page's codec and playback; `seed`: of the network. */
export function seenOver(way: Way, seconds: number, seed: number): Seen {
  const frames = performed(seconds);
  const sent = sentOf(frames);
  const arrived = arrivals(
    sent.map(({ time }) => time),
    way,
    seed,
  );
  const players = new RemotePlayers();
  const ages: number[] = [];
  const off: number[] = [];
  const [own, drawn] = [new Jerk(), new Jerk()];
  let next = 0;
  for (const { time, places } of frames) {
    for (; next < sent.length && arrived[next]! <= time; next++) {
      players.receive({ seat: 1, packet: packetOf(sent[next]!), arrivedAt: arrived[next]! });
    }
    const [remote] = players.follow(time);
    if (!remote || time < settling) continue;
    const seen = placesOf(remote.pose);
    own.add(places);
    drawn.add(seen);
    const { shownTime } = players.report(1)!;
    ages.push(time - shownTime);
    off.push(...distancesBetween(placesAt(frames, shownTime), seen));
  }
  return {
    way,
    p50Ms: 1000 * median(ages),
    p95Ms: 1000 * quantile(ages, 0.95),
    freezes: (60 * players.report(1)!.freezes) / seconds,
    jerkRatio: drawn.sum / own.sum,
    offP95Mm: 1000 * quantile(off, 0.95),
  };
}

/** From calm to uneven ones that lose, in one house, one country and between continents. */
export const ways: readonly Way[] = [0, 0.05, 0.15].flatMap((roundTrip) => [
  { roundTrip, jitter: 0, loss: 0 },
  { roundTrip, jitter: 0.005, loss: 0 },
  { roundTrip, jitter: 0.02, loss: 0.02 },
]);
