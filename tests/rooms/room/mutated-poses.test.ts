import { averageSkeleton, type Calibration, forwardKinematics } from 'threepoint/core';
import { createRandom, distance } from 'threepoint/math';
import { expect, test } from 'vitest';
import { decodePose } from '../../../src/rooms/protocol/pose-codec';
import { decodeFrame } from '../../../src/rooms/protocol/pose-frame';
import { maxPosePacketBytes } from '../../../src/rooms/protocol/pose-packet';
import { isNightly } from '../../nightly';
import { reportFigures } from '../../reliability/report-figures';
import { seed } from '../../threepoint/core/arbitraries';
import { numbersIn } from '../../threepoint/core/numbers-in';
import { setTime, validPackets } from '../protocol/sent-bodies';
import { createTestRoom } from './test-room';

/** Bodies of the least and greatest measures that a message may carry. */
const extremes: readonly Calibration[] = [
  { eyeHeight: 0.5, armSpan: 0.5 },
  { eyeHeight: 0.5, armSpan: 3, forearm: 1 },
  { eyeHeight: 3, armSpan: 0.5, forearm: 0.05 },
  { eyeHeight: 3, armSpan: 3, forearm: 1 },
];
const clients = ['ann', 'ben', 'cal'];

/** The longest way from the head to a joint of a body [m]; NaN where a number of the packet is none. */
function reachOf(bytes: Uint8Array, calibration: Calibration): number {
  const skeleton = averageSkeleton(calibration);
  const packet = decodePose(bytes, skeleton);
  if (!packet || !numbersIn(packet).every(Number.isFinite)) return Number.NaN;
  const { head, body, feet } = packet.pose;
  if (!body) return 0;
  const ankles = [feet?.left ?? null, feet?.right ?? null].filter((foot) => foot !== null);
  const joints = [...Object.values(forwardKinematics(skeleton, body)), ...ankles];
  return Math.max(...joints.map(({ position }) => distance(position, head.position)));
}

/** Valid packets of bodies in all situations, and the ways to change them. */
async function mutations(chance: () => number) {
  const below = (end: number) => Math.floor(chance() * end);
  const valid = await validPackets(seed, 120, 60);
  const some = () => Uint8Array.from(valid[below(valid.length)]!);
  const ways: readonly (() => Uint8Array)[] = [
    // A bit to four, anywhere; in the head of the packet, which says how long it is; bytes; cut off; put together from
    // two.
    () => flipped(some(), () => below(40 * 8)),
    () => flipped(some(), () => below(31)),
    () => some().map((byte) => (chance() < 0.05 ? below(256) : byte)),
    () => some().slice(0, below(maxPosePacketBytes + 1)),
    () => Uint8Array.from([...some(), ...some().slice(0, below(40))]).slice(0, maxPosePacketBytes),
  ];
  function flipped(bytes: Uint8Array, bit: () => number): Uint8Array {
    for (let flips = 1 + below(4); flips > 0; flips--) {
      const at = bit();
      bytes[(at >> 3) % bytes.length]! ^= 0x80 >> (at & 7);
    }
    return bytes;
  }
  return { next: () => ways[below(ways.length)]!(), below };
}

test('valid pose packets, changed, reach others whole or not at all, as bodies of finite size', {
  tags: ['full'],
  timeout: 1_800_000,
}, async () => {
  const packets = isNightly ? 1_000_000 : 50_000;
  const chance = createRandom(20261126);
  const { next, below } = await mutations(chance);
  const testRoom = createTestRoom();
  testRoom.begin();
  testRoom.frames.length = 0;
  const counts = { taken: 0, ignored: 0, bad: 0 };
  let seen = 0;
  let furthest = 0;
  const readFrames = () => {
    for (const frame of testRoom.frames.splice(0)) {
      const poses = decodeFrame(frame);
      if (!poses) throw new Error(`no page can read the frame ${frame}`);
      seen += poses.length;
      for (const pose of poses) {
        for (const calibration of extremes) furthest = Math.max(furthest, reachOf(pose.bytes, calibration));
        if (Number.isNaN(furthest)) throw new Error(`a body that is no number, from ${pose.bytes}`);
      }
    }
  };
  for (let i = 0; i < packets; i++) {
    const bytes = next();
    // Its age is not what keeps a packet from the room.
    setTime(bytes, testRoom.time * 1000);
    counts[testRoom.send(clients[below(3)]!, bytes)] += 1;
    // Nothing is compared with a pose from more than a second ago: most packets would be leaps otherwise.
    if (i % 3 === 2) testRoom.tick(1.05);
    if (i % 300 < 3) testRoom.pass(1 / 60);
    readFrames();
    testRoom.sent.length = 0;
    testRoom.refusals.length = 0;
    testRoom.log.length = 0;
  }
  testRoom.tick();
  readFrames();
  expect(seen).toBe(counts.taken);
  expect(numbersIn(testRoom.room.match).every(Number.isFinite)).toBe(true);
  reportFigures('mutated-poses', {
    packets,
    'read as poses': counts.taken + counts.ignored,
    'passed on': seen,
    'frames that no page can read': 0,
    'furthest joint from its head, for the greatest measures [m]': furthest,
  });
  expect(counts.taken).toBeGreaterThan(packets / 20);
  expect(furthest).toBeLessThan(8);
});
