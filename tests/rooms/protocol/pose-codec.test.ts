import fc from 'fast-check';
import type { JointName, JointPoses, PoseRegressor } from 'threepoint';
import {
  createEstimator,
  defaultCalibration,
  forwardKinematics,
  jointNames,
  makeHandShape,
  skeletonFromCalibration,
  unknownFingers,
  wristFromHandBone,
} from 'threepoint/core';
import {
  add,
  angleBetween,
  createRandom,
  distance,
  fromAxisAngle,
  identity,
  multiply,
  type Quat,
  right,
  vec3,
} from 'threepoint/math';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { fingerFields } from '../../../src/rooms/protocol/finger-steps';
import { decodePoints, decodePose, encodePose } from '../../../src/rooms/protocol/pose-codec';
import { packetLengthAt } from '../../../src/rooms/protocol/pose-layout';
import { maxPosePacketBytes, type PosePacket, poseVersion } from '../../../src/rooms/protocol/pose-packet';
import { cases, isNightly } from '../../nightly';
import { reportFigures } from '../../reliability/report-figures';
import { seed } from '../../threepoint/core/arbitraries';
import { boneStretch } from '../../threepoint/core/body/bone-stretch';
import { openShippedModel } from '../../threepoint/core/estimation/shipped-models';
import { numbersIn } from '../../threepoint/core/numbers-in';
import { packetOf, pinnedPacketOf, pinnedSenders, type SentPacket, senders, validPackets } from './sent-bodies';

const degrees = 180 / Math.PI;
const sides = ['left', 'right'] as const;

/** The largest of many numbers of each kind. */
function worstOf() {
  const worst = new Map<string, number>();
  return {
    take: (what: string, value: number) => worst.set(what, Math.max(worst.get(what) ?? 0, value)),
    of: (what: string): number => worst.get(what) ?? Number.NaN,
    told: () => [...worst].map(([what, value]) => `${what} ${value.toFixed(2)}`).join(', '),
  };
}

/** Whether a joint is the elbow of an arm whose wrist is so near its shoulder that steps of both turn it far. */
const isFoldedElbow = (joint: JointName, joints: JointPoses): boolean =>
  sides.some(
    (side) =>
      joint === `${side}LowerArm` &&
      distance(joints[`${side}UpperArm`].position, joints[`${side}Hand`].position) < 0.06,
  );

/**
 * What the receiver may be off by, for any person in any movement, hands seen, lost, guessed, coming back, out of reach
 * or wrung.
 */
async function measure<Person>(
  worst: ReturnType<typeof worstOf>,
  people: fc.Arbitrary<Person>,
  packetFrom: (person: Person) => Promise<SentPacket>,
  numRuns: number,
): Promise<void> {
  await fc.assert(
    fc.asyncProperty(people, async (person) => {
      const { packet, skeleton } = await packetFrom(person);
      const bytes = encodePose(packet, skeleton)!;
      worst.take('bytes', bytes.length);
      const back = decodePose(bytes, skeleton)!;
      expect(back.timeMs).toBe(packet.timeMs);
      expect(back.jump).toBe(packet.jump);
      for (const name of ['head', 'leftHand', 'rightHand'] as const) {
        const [sent, shown] = [packet.pose[name], back.pose[name]];
        expect(shown?.tracking).toBe(sent?.tracking);
        if (!sent || !shown) continue;
        worst.take('head and hands [mm]', 1000 * distance(sent.position, shown.position));
        worst.take('head and hands [°]', degrees * angleBetween(sent.orientation, shown.orientation));
      }
      const sent = forwardKinematics(skeleton, packet.pose.body!);
      const shown = forwardKinematics(skeleton, back.pose.body!);
      for (const side of sides) {
        const [bent, shownBent] = [packet.fingers[side], back.fingers[side]];
        const hand = packet.pose[`${side}Hand`];
        const wrist = sent[`${side}Hand`];
        // An arm on its way back stays bent a little: in its last frames it is a millimetre short of its hand.
        const caught = hand !== null && distance(hand.position, wrist.position) < 0.0005;
        const turned = hand && angleBetween(multiply(hand.orientation, wristFromHandBone[side]), wrist.orientation);
        if (caught && turned! < 0.01) {
          worst.take('wrists at their hands [mm]', 1000 * distance(wrist.position, shown[`${side}Hand`].position));
          expect(shownBent === null).toBe(bent === null);
        }
        if (!bent || !shownBent) continue;
        for (const { bits, low, high, read } of fingerFields) {
          const sentBend = Math.max(low, Math.min(high, read(bent)));
          expect(Math.abs(read(shownBent) - sentBend)).toBeLessThanOrEqual((high - low) / 2 / (2 ** bits - 1) + 1e-9);
        }
      }
      for (const joint of jointNames) {
        const what = isFoldedElbow(joint, sent) ? 'elbows of folded arms [mm]' : 'joints [mm]';
        worst.take(what, 1000 * distance(sent[joint].position, shown[joint].position));
        worst.take('joints [°]', degrees * angleBetween(sent[joint].orientation, shown[joint].orientation));
      }
      for (const joint of ['hips', 'chest', 'leftLowerArm', 'rightLowerArm'] as const)
        worst.take(`${joint} [mm]`, 1000 * distance(sent[joint].position, shown[joint].position));
      for (const side of sides) {
        const [foot, shownFoot] = [packet.pose.feet?.[side] ?? null, back.pose.feet?.[side] ?? null];
        expect(shownFoot === null).toBe(foot === null);
        if (!foot || !shownFoot) continue;
        worst.take('feet [mm]', 1000 * distance(foot.position, shownFoot.position));
        worst.take('feet [°]', degrees * angleBetween(foot.orientation, shownFoot.orientation));
      }
    }),
    { seed, numRuns },
  );
}

describe('a body on the wire', () => {
  const learned: { regressor?: PoseRegressor } = {};
  beforeAll(async () => {
    learned.regressor = await openShippedModel('learned');
  });
  afterAll(() => learned.regressor?.dispose());

  test.each([
    ['ik', undefined, cases(500)],
    ['learned', 'learned', cases(100)],
  ] as const)('from %s keeps 1 mm and 0.5° at head and hands, 1 cm elsewhere, 64 bytes', async (_, name, runs) => {
    const worst = worstOf();
    const create =
      name && ((calibration: typeof defaultCalibration) => createEstimator(name, calibration, learned.regressor));
    await measure(worst, senders, (sender) => packetOf(sender, create), runs);
    console.log(`pose codec, ${name ?? 'ik'}, ${runs} bodies, worst: ${worst.told()}`);
    expect(worst.of('bytes')).toBeLessThanOrEqual(64);
    expect(worst.of('head and hands [mm]')).toBeLessThan(1);
    expect(worst.of('head and hands [°]')).toBeLessThan(0.5);
    expect(worst.of('wrists at their hands [mm]')).toBeLessThan(1);
    expect(worst.of('joints [mm]')).toBeLessThan(10);
    expect(worst.of('elbows of folded arms [mm]')).not.toBeGreaterThan(15);
    expect(worst.of('joints [°]')).toBeLessThan(4);
    reportFigures('hand-lost', { 'flags that reach others': 'null, emulated' });
  });

  test('pinned by trackers arrives as exactly, with its feet, in 87 bytes', async () => {
    const worst = worstOf();
    const runs = cases(100);
    await measure(worst, pinnedSenders, pinnedPacketOf, runs);
    console.log(`pose codec, pinned, ${runs} bodies, worst: ${worst.told()}`);
    expect(worst.of('bytes')).toBeLessThanOrEqual(maxPosePacketBytes);
    expect(worst.of('head and hands [mm]')).toBeLessThan(1);
    expect(worst.of('wrists at their hands [mm]')).toBeLessThan(1);
    expect(worst.of('joints [mm]')).toBeLessThan(10);
    expect(worst.of('joints [°]')).toBeLessThan(4);
    expect(worst.of('feet [°]')).toBeLessThan(0.5);
  });

  test('keeps the lengths of its bones', async () => {
    await fc.assert(
      fc.asyncProperty(senders, async (sender) => {
        const { packet, skeleton } = await packetOf(sender);
        const joints = forwardKinematics(skeleton, decodePose(encodePose(packet, skeleton)!, skeleton)!.pose.body!);
        expect(boneStretch(joints, skeleton)).toBeLessThan(1e-9);
      }),
      { seed, numRuns: 100 },
    );
  });

  test('costs 64 bytes with the fingers of both hands and 56 without, while wrists stay whole', async () => {
    let unbroken = 0;
    await fc.assert(
      fc.asyncProperty(senders, async (sender) => {
        const { packet, skeleton } = await packetOf({
          ...sender,
          actor: true,
          fates: { left: 'seen', right: 'seen' },
          fingers: { left: makeHandShape(), right: makeHandShape() },
        });
        const sent = forwardKinematics(skeleton, packet.pose.body!);
        const asHeld = sides.every((side) => {
          const bone = multiply(packet.pose[`${side}Hand`]!.orientation, wristFromHandBone[side]);
          return angleBetween(bone, sent[`${side}Hand`].orientation) < 0.01;
        });
        if (asHeld) unbroken += 1;
        expect(encodePose(packet, skeleton)!.length).toBeLessThanOrEqual(maxPosePacketBytes);
        const fingerless = encodePose({ ...packet, fingers: unknownFingers }, skeleton)!;
        expect(fingerless.length).toBeLessThanOrEqual(asHeld ? 56 : maxPosePacketBytes);
      }),
      { seed, numRuns: 200 },
    );
    expect(unbroken).toBeGreaterThan(160);
  });

  test('arrives within the same bounds when it is sent again as received', async () => {
    await fc.assert(
      fc.asyncProperty(senders, async (sender) => {
        const { packet, skeleton } = await packetOf(sender);
        const once = decodePose(encodePose(packet, skeleton)!, skeleton)!;
        const twice = decodePose(encodePose(once, skeleton)!, skeleton)!;
        expect(distance(once.pose.head.position, twice.pose.head.position)).toBeLessThan(1e-9);
        const sent = forwardKinematics(skeleton, once.pose.body!);
        const shown = forwardKinematics(skeleton, twice.pose.body!);
        for (const joint of jointNames) {
          expect(distance(sent[joint].position, shown[joint].position)).toBeLessThan(0.01);
        }
      }),
      { seed, numRuns: 100 },
    );
  });
});

const skeleton = skeletonFromCalibration(defaultCalibration);

/** A person who shows no body: the head at rest, the left hand lost, the right one guessed. */
const handsOnly: PosePacket = {
  timeMs: 0x1234,
  jump: false,
  pose: {
    head: { position: vec3(0.001, 1.6, -2), orientation: identity, tracking: 'tracked' },
    leftHand: null,
    rightHand: {
      position: vec3(0.201, 1.1, -2.5),
      orientation: { x: 0, y: Math.SQRT1_2, z: 0, w: Math.SQRT1_2 },
      tracking: 'emulated',
    },
    body: null,
  },
  fingers: { left: null, right: { ...makeHandShape(), index: { knuckle: 1.45, spread: 0, middle: 1.75, end: 1.085 } } },
};

const bytesOf = (bits: readonly string[]): number[] =>
  bits
    .join('')
    .padEnd(Math.ceil(bits.join('').length / 8) * 8, '0')
    .match(/.{8}/g)!
    .map((byte) => Number.parseInt(byte, 2));

const binary = (value: number, bits: number): string => value.toString(2).padStart(bits, '0');

describe('bytes', () => {
  test('are those that writePacket documents, bit by bit', () => {
    const expected = bytesOf([
      '0101', // version 5
      '0', // no jump
      '0', // no body
      '1', // head tracked
      '000', // left hand lost, its arm not free
      '100', // right hand emulated, with fingers
      '01001000110100', // 0x1234 ms
      binary(32767 + 4, 16), // head x: 4 quarters of a millimetre
      binary(8191 + (1600 - (-1000 + 8191 / 4)) * 4, 14), // head y from the middle of its range
      binary(32767 - 8000, 16), // head z
      '11', // w is largest
      ...[1023, 1023, 1023].map((zero) => binary(zero, 11)),
      // Right hand from the head: 0.2 m, −0.5 m, −0.5 m, each one of 9999 steps.
      binary(((4999 + 800) * 9999 + (4999 - 2000)) * 9999 + (4999 - 2000), 40),
      '11', // w, which is as large as y
      ...[1023, 2046, 1023].map((part) => binary(part, 11)),
      ...[binary(2, 3), binary(5, 3), binary(1, 3)], // thumb: palmward, spread, bent
      ...[binary(15, 4), binary(15, 4)], // index finger: knuckle and middle joint in the palm
      ...[binary(1, 4), binary(1, 4), binary(1, 4)], // middle, ring and little finger
      binary(0, 4), // no pinch
    ]);
    expect([...encodePose(handsOnly, skeleton)!]).toEqual(expected);
    expect(expected.length).toBe(27);
    const back = decodePose(Uint8Array.from(expected), skeleton)!;
    expect(distance(back.pose.head.position, handsOnly.pose.head.position)).toBeLessThan(1e-9);
    expect(distance(back.pose.rightHand!.position, handsOnly.pose.rightHand!.position)).toBeLessThan(1e-9);
    expect(back.pose.leftHand).toBeNull();
    expect(back.pose.rightHand!.orientation).toBeSameRotationAs(handsOnly.pose.rightHand!.orientation, 1e-4);
    expect(back.pose.body).toBeNull();
    expect(back.fingers.left).toBeNull();
    expect(back.fingers.right!.index.knuckle).toBeCloseTo(1.45, 9);
    expect(back.fingers.right!.middle.middle).toBeLessThan(0.05);
  });

  /** A T-pose, its lower back bent by this angle about +X [rad] and the thorax turned back. */
  function restPose(bend: number): PosePacket {
    const localRotations = {
      ...(Object.fromEntries(jointNames.map((joint) => [joint, identity])) as Record<JointName, Quat>),
      spine: fromAxisAngle(right, bend),
      chest: fromAxisAngle(right, -bend),
    };
    const body = { hipsPosition: skeleton.restOffsets.hips, localRotations };
    const eyes = add(forwardKinematics(skeleton, body).head.position, skeleton.eyesInHead);
    const pose = { head: { ...handsOnly.pose.head, position: eyes }, leftHand: null, rightHand: null, body };
    return { ...handsOnly, timeMs: 0, pose };
  }

  test('a T-pose has these until the version changes', () => {
    const packet = restPose(0);
    const { body } = packet.pose;
    const hex = [...encodePose(packet, skeleton)!].map((byte) => byte.toString(16).padStart(2, '0')).join('');
    expect(hex).toBe(
      '56000007fffa1f1f7777feffdff9730b046a4efffff3ffba60710f07dff8007ffbfeffbffbfeffbffbfeffbfefbeff7fd6a7e1feff528fc0',
    );
    const shown = forwardKinematics(skeleton, decodePose(encodePose(packet, skeleton)!, skeleton)!.pose.body!);
    const sent = forwardKinematics(skeleton, body!);
    for (const joint of jointNames) {
      expect(distance(shown[joint].position, sent[joint].position)).toBeLessThan(0.002);
    }
  });

  test('another version’s are no pose', () => {
    const bytes = encodePose(handsOnly, skeleton)!;
    for (let version = 0; version < 16; version++) {
      const other = Uint8Array.from(bytes);
      other[0] = (version << 4) | (other[0]! & 0xf);
      expect(decodePose(other, skeleton) !== null).toBe(version === poseVersion);
    }
  });

  test('too few, too many or unpadded ones are no pose', () => {
    const bytes = encodePose(handsOnly, skeleton)!;
    for (let length = 0; length < bytes.length; length++) {
      expect(decodePose(bytes.slice(0, length), skeleton)).toBeNull();
    }
    expect(decodePose(Uint8Array.from([...bytes, 0]), skeleton)).toBeNull();
    // Without fingers the last byte has a bit to fill up.
    const unclean = encodePose({ ...handsOnly, fingers: unknownFingers }, skeleton)!;
    unclean[22]! |= 1;
    expect(decodePose(unclean, skeleton)).toBeNull();
  });

  test('impossible ones are no pose: a free arm without a body', () => {
    const bytes = encodePose(handsOnly, skeleton)!;
    const withBits = (...bits: number[]) => {
      const changed = Uint8Array.from(bytes);
      for (const bit of bits) changed[bit >> 3]! ^= 0x80 >> (bit & 7);
      return decodePose(changed, skeleton);
    };
    expect(withBits()).not.toBeNull();
    expect(withBits(4)).not.toBeNull();
    // The left arm, then the right one, is free, and there is no body.
    expect(withBits(9)).toBeNull();
    expect(withBits(10, 11, 12)).toBeNull();
  });

  test('ones that pin something unnamed are no pose', () => {
    const bent = restPose(0.1);
    const bytes = encodePose(bent, skeleton)!;
    expect(decodePose(bytes, skeleton)).not.toBeNull();
    // Bits 27 and 28: something is pinned, the back is bent.
    expect(bytes[3]! & 0x1e).toBe(0x18);
    bytes[3]! &= ~0x08;
    expect(decodePose(bytes, skeleton)).toBeNull();
    expect(packetLengthAt(bytes, 0)).toBe(0);
  });

  test('are none at all for a person who is not a number', () => {
    const { head } = handsOnly.pose;
    const nowhere = { ...head, position: vec3(Number.NaN, 1, 0) };
    expect(encodePose({ ...handsOnly, pose: { ...handsOnly.pose, head: nowhere } }, skeleton)).toBeNull();
    const unturned = { ...head, orientation: { ...identity, x: Number.POSITIVE_INFINITY } };
    expect(encodePose({ ...handsOnly, pose: { ...handsOnly.pose, rightHand: unturned } }, skeleton)).toBeNull();
    expect(encodePose({ ...handsOnly, timeMs: Number.NaN }, skeleton)).toBeNull();
  });

  test('hold positions out of range at the edge of it', () => {
    const { head } = handsOnly.pose;
    const far = { ...head, position: vec3(100, 9, -100) };
    const back = decodePose(encodePose({ ...handsOnly, pose: { ...handsOnly.pose, head: far } }, skeleton)!, skeleton)!;
    expect(back.pose.head.position.x).toBeCloseTo(8.19175, 9);
    expect(back.pose.head.position.y).toBeCloseTo(3.0955, 9);
    expect(back.pose.head.position.z).toBeCloseTo(-8.19175, 9);
  });
});

test('bad packets (100,000, or a million at night) decode to null or to a finite pose', {
  tags: ['full'],
}, async () => {
  const packets = isNightly ? 1_000_000 : 100_000;
  const chance = createRandom(seed);
  const below = (end: number): number => Math.floor(chance() * end);
  const good = [...(await validPackets(seed, 60, 30)), encodePose(handsOnly, skeleton)!];
  const noise = (length: number): Uint8Array => Uint8Array.from({ length }, () => below(256));
  const bad = (): Uint8Array => {
    const sort = chance();
    if (sort < 0.1) return noise(below(100));
    if (sort < 0.4) {
      const bytes = noise(25 + below(63));
      bytes[0] = (poseVersion << 4) | (bytes[0]! & 0xf);
      return bytes;
    }
    const bytes = Uint8Array.from(good[below(good.length)]!);
    if (sort < 0.5) return bytes.slice(0, below(bytes.length));
    if (sort < 0.6) return Uint8Array.from([...bytes, ...noise(1 + below(8))]);
    for (let flips = 1 + below(12); flips > 0; flips--) bytes[below(bytes.length)]! ^= 1 << below(8);
    return bytes;
  };
  let accepted = 0;
  for (let i = 0; i < packets; i++) {
    const bytes = bad();
    const pose = decodePose(bytes, skeleton);
    const points = decodePoints(bytes);
    if ((pose === null) !== (points === null)) throw new Error(`two opinions on ${bytes}`);
    if (pose === null) continue;
    accepted += 1;
    const finite = numbersIn(pose).every(Number.isFinite);
    const { head, leftHand, rightHand, feet } = pose.pose;
    const turns = [head, leftHand, rightHand, feet?.left, feet?.right]
      .flatMap((hand) => (hand ? [hand.orientation] : []))
      .concat(Object.values(pose.pose.body?.localRotations ?? {}));
    const unit = turns.every(({ x, y, z, w }) => Math.abs(Math.hypot(x, y, z, w) - 1) < 1e-6);
    if (!finite || !unit) throw new Error(`an impossible pose from ${bytes}`);
  }
  console.log(`pose codec: ${packets} fuzzed packets, ${accepted} decoded to a pose, 0 thrown`);
  expect(accepted).toBeGreaterThan(packets / 20);
  expect(accepted).toBeLessThan(packets);
});
