import fc from 'fast-check';
import {
  type AvatarPose,
  actorFrame,
  type Calibration,
  createEstimator,
  forwardKinematics,
  type PoseEstimator,
  type Skeleton,
  skeletonFromCalibration,
  type TrackingFrame,
  unknownFingers,
} from 'threepoint/core';
import { add, fromAxisAngle, multiply, type TrackedPose, up, vec3 } from 'threepoint/math';
import { pinning } from 'threepoint/trackers';
import { packetMs } from '../../../src/rooms/protocol/packet-time';
import { encodePose } from '../../../src/rooms/protocol/pose-codec';
import type { PosePacket } from '../../../src/rooms/protocol/pose-packet';
import { evenly, rotation, standpoint, vector } from '../../threepoint/core/arbitraries';
import { type Joints, poseOf, showAll } from '../../threepoint/core/estimation/drawn';
import { movingPerson, transformFrame, withHand } from '../../threepoint/core/estimation/moving-person';
import { type TrueJoints, trackersOn, withOffsets } from '../../threepoint/core/estimation/tracked-body';
import { fromEulerYxz } from '../../threepoint/core/euler-angles';

export const calibrationOf = fc
  .tuple(evenly(0.95, 2.1), evenly(0.82, 1.05))
  .map(([eyeHeight, ratio]): Calibration => ({ eyeHeight, armSpan: eyeHeight * ratio }));

/** What happens to a hand on the way to the frame that is sent. */
type Fate = 'seen' | 'lost' | 'emulated' | 'returning' | 'too far' | 'wrung';

const fate = fc.constantFrom<Fate>('seen', 'seen', 'seen', 'lost', 'emulated', 'returning', 'too far', 'wrung');

const rate = 1 / 60;
/** Frames before the one that is sent: an arm is on its way to rest, or back. */
const framesBefore = 18;

const bend = fc.record({
  knuckle: evenly(-0.3, 1.6),
  spread: evenly(-0.3, 0.9),
  middle: evenly(-0.1, 1.9),
  end: evenly(-0.1, 1.2),
});
const hand = fc.option(
  fc.record({ thumb: bend, index: bend, middle: bend, ring: bend, little: bend, pinch: evenly(0, 1) }),
  { nil: null },
);

/**
 * A person of any size anywhere, turned anyhow, in the middle of an actor's or a random movement, both hands with a
 * fate.
 */
export const senders = fc.record({
  calibration: calibrationOf,
  motion: fc.integer({ min: 1 }),
  actor: fc.boolean(),
  standpoint,
  start: evenly(0, 100),
  fates: fc.record({ left: fate, right: fate }),
  away: vector(0.9),
  turned: rotation,
  jump: fc.boolean(),
  headEmulated: fc.boolean(),
  fingers: fc.record({ left: hand, right: hand }),
});

export type Sender = typeof senders extends fc.Arbitrary<infer T> ? T : never;

/** The frames up to the one that is sent. */
export function framesOf(sender: Sender): readonly TrackingFrame[] {
  const { calibration, motion, actor, standpoint: at, start, fates, away, turned } = sender;
  const person = movingPerson(motion, calibration, at);
  const place = { position: vec3(at.x, 0, at.z), orientation: fromAxisAngle(up, at.yaw) };
  const frameAt = (time: number): TrackingFrame =>
    actor ? transformFrame(place, actorFrame(time, calibration)) : person(time);
  return Array.from({ length: framesBefore + 1 }, (_, i) => {
    let frame = frameAt(start + i * rate);
    for (const side of ['left', 'right'] as const) {
      const hand = frame[`${side}Hand`] as TrackedPose;
      const changed = {
        seen: hand,
        lost: i > 4 ? null : hand,
        emulated: i > 4 ? { ...hand, tracking: 'emulated' as const } : hand,
        returning: i > 1 && i < framesBefore - 5 ? null : hand,
        'too far': {
          ...hand,
          position: vec3(hand.position.x + away.x, hand.position.y + away.y, hand.position.z + away.z),
        },
        wrung: { ...hand, orientation: multiply(hand.orientation, turned) },
      }[fates[side]];
      frame = withHand(frame, side, changed);
    }
    return sender.headEmulated ? { ...frame, head: { ...frame.head, tracking: 'emulated' as const } } : frame;
  });
}

export interface SentPacket {
  readonly packet: PosePacket;
  readonly skeleton: Skeleton;
}

const sentPacket = ({ start, jump, fingers, calibration }: Sender, pose: AvatarPose): SentPacket => ({
  packet: { timeMs: packetMs(start * 1000), jump, pose, fingers },
  skeleton: skeletonFromCalibration(calibration),
});

/** Returns the packet of a person with a body that this estimator solves (default: IK). */
export const packetOf = async (
  sender: Sender,
  create: (calibration: Calibration) => PoseEstimator = (calibration) => createEstimator('ik', calibration),
): Promise<SentPacket> => sentPacket(sender, await showAll(create(sender.calibration), framesOf(sender)));

/** Writes the time of its frame [ms] into a pose packet, from its bit 13 on (`writePacket`). */
export function setTime(bytes: Uint8Array, timeMs: number): void {
  for (let bit = 0; bit < 14; bit++) {
    const at = 13 + bit;
    if (at >> 3 >= bytes.length) return;
    const mask = 0x80 >> (at & 7);
    if ((packetMs(timeMs) >> (13 - bit)) & 1) bytes[at >> 3]! |= mask;
    else bytes[at >> 3]! &= ~mask;
  }
}

/** The way from a drawn joint to where its tracker is: a few centimetres aside, and turned. */
const beside = fc.option(
  fc.record({
    to: vector(0.05),
    about: fc.record({ x: evenly(-0.3, 0.3), y: evenly(-0.5, 0.5), z: evenly(-0.3, 0.3) }),
  }),
  { nil: null },
);
/** An ankle by its way from the floor under the hips: raised by half a metre at most. */
const ankle = fc.option(
  fc.record({ x: evenly(-0.5, 0.5), y: evenly(0.05, 0.6), z: evenly(-0.5, 0.5), turned: rotation }),
  {
    nil: null,
  },
);

/** A person with trackers: seen in all frames, lost on the way, or found just before the frame that is sent. */
export const pinnedSenders = fc.record({
  sender: senders,
  hips: beside,
  chest: beside,
  leftFoot: ankle,
  rightFoot: ankle,
  seen: fc.constantFrom('always', 'always', 'lost', 'found'),
});

export type PinnedSender = typeof pinnedSenders extends fc.Arbitrary<infer T> ? T : never;

/** Returns the joints that the trackers of a frame report. */
function pinnedJoints({ hips, chest, leftFoot, rightFoot }: PinnedSender, free: Joints): TrueJoints {
  const trunk = (name: 'hips' | 'chest', way: typeof hips): TrueJoints => {
    if (!way) return {};
    const { position, orientation } = free[name];
    return { [name]: { position: add(position, way.to), orientation: multiply(orientation, fromEulerYxz(way.about)) } };
  };
  const foot = (name: 'leftFoot' | 'rightFoot', at: typeof leftFoot): TrueJoints => {
    if (!at) return {};
    const { x, z } = free.hips.position;
    return { [name]: { position: vec3(x + at.x, at.y, z + at.z), orientation: at.turned } };
  };
  return {
    ...trunk('hips', hips),
    ...trunk('chest', chest),
    ...foot('leftFoot', leftFoot),
    ...foot('rightFoot', rightFoot),
  };
}

/** Returns the packet of a person with trackers, whose body IK solves. */
export async function pinnedPacketOf(pinned: PinnedSender): Promise<SentPacket> {
  const { sender, seen } = pinned;
  const [plain, estimator] = [
    createEstimator('ik', sender.calibration),
    createEstimator('ik', withOffsets(sender.calibration), null, { pinning }),
  ];
  const frames = framesOf(sender).map((frame, i): TrackingFrame => {
    const free = forwardKinematics(skeletonFromCalibration(sender.calibration), poseOf(plain, frame).body!);
    const isSeen = { always: true, lost: i < framesBefore - 5, found: i > framesBefore - 5 }[seen];
    return isSeen ? { ...frame, trackers: trackersOn(pinnedJoints(pinned, free)) } : frame;
  });
  return sentPacket(sender, await showAll(estimator, frames));
}

/** Returns the packets of so many people without and with trackers: each whole, without a body, and without fingers. */
export async function validPackets(seed: number, people: number, pinned: number): Promise<readonly Uint8Array[]> {
  const sent: SentPacket[] = [];
  for (const sender of fc.sample(senders, { seed, numRuns: people })) sent.push(await packetOf(sender));
  for (const sender of fc.sample(pinnedSenders, { seed, numRuns: pinned })) sent.push(await pinnedPacketOf(sender));
  return sent.flatMap(({ packet, skeleton }) => {
    const bodiless = { ...packet, pose: { ...packet.pose, body: null } };
    return [packet, bodiless, { ...bodiless, fingers: unknownFingers }].map((one) => encodePose(one, skeleton)!);
  });
}
