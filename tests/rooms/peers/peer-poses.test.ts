import { defaultCalibration, forwardKinematics, skeletonFromCalibration } from 'threepoint/core';
import { createRandom, distance } from 'threepoint/math';
import { afterEach, expect, test, vi } from 'vitest';
import { maxPeerPacketBytes, peerPacketVersion } from '../../../src/rooms/peers/peer-packet';
import { PoseSender } from '../../../src/rooms/peers/pose-sender';
import { RemotePoses } from '../../../src/rooms/peers/remote-poses';
import { isNightly } from '../../nightly';
import { setTime } from '../protocol/sent-bodies';
import { solvedActor } from './solved-actor';

afterEach(() => vi.restoreAllMocks());

const frameMs = 1000 / 60;
const skeleton = skeletonFromCalibration(defaultCalibration);

/** A sender and what it has sent, by time. */
function sending(options: { readonly rate?: number } = {}) {
  const sent: { readonly at: number; readonly bytes: Uint8Array }[] = [];
  let now = 0;
  const sender = new PoseSender((bytes) => sent.push({ at: now, bytes }), { name: ' Ada\u202e ', ...options });
  const actor = solvedActor();
  return {
    sender,
    actor,
    sent,
    /** Sends the frames up to this time [ms]. */
    until(timeMs: number, frame = {}) {
      for (; now < timeMs; now += frameMs) {
        actor.moveTo(now);
        sender.update(now, actor, frame);
      }
    },
  };
}

test('another page shows a moving person’s head, hands and elbows, with 2 % of packets lost', () => {
  const { until, sent } = sending();
  until(10_000);
  const others = new RemotePoses();
  const truth = solvedActor();
  let lost = 0;
  let worst = 0;
  let drawn = 0;
  let next = 0;
  for (let time = 0; time < 10_000; time += frameMs) {
    // A round trip of 60 ms, other clocks on both sides.
    for (; next < sent.length && sent[next]!.at + 30 <= time; next++) {
      if (next % 50 === 49) lost += 1;
      else others.receive(5000 + sent[next]!.at + 30, 'ada', sent[next]!.bytes);
    }
    const [ada] = others.update(5000 + time);
    if (!ada || time < 500) continue;
    expect(ada).toMatchObject({ peer: 'ada', name: 'Ada', avatar: null, placement: null, opacity: 1 });
    truth.moveTo(others.report('ada')!.shownTime * 1000);
    const joints = forwardKinematics(skeleton, truth.pose!.body!);
    drawn += 1;
    for (const joint of ['head', 'leftHand', 'rightHand', 'leftLowerArm', 'rightLowerArm'] as const)
      worst = Math.max(worst, distance(ada.joints![joint].position, joints[joint].position));
  }
  expect(lost).toBeGreaterThan(3);
  expect(drawn).toBeGreaterThan(500);
  // The actor's hands move by up to 2 m/s; a lost packet is bridged.
  expect(worst).toBeLessThan(0.03);
});

test('thirty packets a second of at most 70 bytes, and a profile a second', () => {
  const { until, sent } = sending();
  until(10_000);
  const profiles = sent.filter(({ bytes }) => bytes[1] === 0);
  expect(profiles).toHaveLength(10);
  expect(sent.length - profiles.length).toBeGreaterThanOrEqual(299);
  expect(sent.length - profiles.length).toBeLessThanOrEqual(302);
  const total = sent.reduce((sum, { bytes }) => sum + bytes.length, 0);
  expect(total / 10).toBeLessThan(2200);
  expect(Math.max(...sent.map(({ bytes }) => bytes.length))).toBeLessThanOrEqual(maxPeerPacketBytes);
});

test('a peer that joins later sees the person within a second, or at once after sendProfile', () => {
  const { until, sent, sender } = sending();
  until(4500);
  const late = new RemotePoses();
  const from = sent.length;
  until(6000);
  const shownAt = sent.slice(from).find(({ at, bytes }) => {
    late.receive(at, 'ada', bytes);
    return late.update(at).length > 0;
  })?.at;
  expect(shownAt).toBeLessThan(5600);
  const later = new RemotePoses();
  sender.sendProfile();
  const again = sent.length;
  until(6100);
  for (const { at, bytes } of sent.slice(again)) later.receive(at, 'ada', bytes);
  expect(later.update(6100)).toHaveLength(1);
});

test('a person whose session ends is not shown until poses come again', () => {
  const { until, sent, sender, actor } = sending();
  const others = new RemotePoses();
  until(1000);
  for (const { at, bytes } of sent) others.receive(at, 'ada', bytes);
  expect(others.update(1000)).toHaveLength(1);
  const from = sent.length;
  sender.update(1010, { pose: null, calibration: actor.calibration });
  for (const { bytes } of sent.slice(from)) others.receive(1010, 'ada', bytes);
  expect(others.update(1020)).toHaveLength(0);
  until(1200);
  for (const { at, bytes } of sent.slice(from)) others.receive(at, 'ada', bytes);
  expect(others.update(1200)).toHaveLength(1);
});

test('a floor that the page moves is part of the packet, far beyond pose coordinates', () => {
  const { until, sent } = sending();
  until(500, { placement: { position: { x: 312.5, y: 2, z: -90 }, heading: 3 }, mouth: 0.5 });
  until(1000, { placement: { position: { x: 312.5, y: 2, z: -90 }, heading: -3 }, mouth: 1 });
  const others = new RemotePoses();
  let between = false;
  for (const { at, bytes } of sent) {
    others.receive(at, 'ada', bytes);
    const [ada] = others.update(at);
    if (!ada) continue;
    expect(ada.placement?.position).toEqual({ x: 312.5, y: 2, z: -90 });
    const heading = ada.placement?.heading ?? 0;
    // The shorter way round: through half a turn, never through 0.
    expect(Math.cos(heading)).toBeLessThan(-0.98);
    between ||= Math.abs(Math.abs(heading) - Math.PI) < 0.13;
  }
  expect(between).toBe(true);
  expect(others.update(1000)[0]?.mouth).toBe(1);
});

test('a peer with another version is refused with a sentence that names both', () => {
  const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
  const { until, sent } = sending();
  until(100);
  const other = sent[0]!.bytes.slice();
  other[0] = 17;
  const others = new RemotePoses();
  expect(others.receive(0, 'old', other)).toBe(false);
  expect(others.receive(10, 'old', other)).toBe(false);
  expect(warn.mock.calls).toEqual([
    [
      `threepoint-rooms: a packet of "old" was refused: it has version 17, and this page reads version ${peerPacketVersion}: use the same release of threepoint-rooms in both.`,
    ],
  ]);
});

test('a flood costs its sender the packets beyond three times the usual rate, and nobody else', () => {
  const { until, sent } = sending();
  until(2000);
  const reasons = new Set<string>();
  const others = new RemotePoses();
  others.addEventListener('refused', (event) => {
    event.preventDefault();
    reasons.add(`${event.peer}: ${event.reason}`);
  });
  let taken = 0;
  for (const { at, bytes } of sent) {
    for (let i = 0; i < 100; i++) if (others.receive(at, 'flood', bytes)) taken += 1;
    expect(others.receive(at, 'ada', bytes)).toBe(true);
  }
  expect(taken).toBeLessThanOrEqual(90 * 3 + 1);
  expect([...reasons]).toEqual(['flood: it sends too many packets']);
});

test('a page hidden for an hour keeps a few packets and draws the newest when shown', { tags: ['full'] }, () => {
  const { until, sent } = sending();
  until(8000);
  const others = new RemotePoses();
  const poses = sent.filter(({ bytes }) => bytes[1] !== 0);
  others.receive(0, 'ada', sent[0]!.bytes);
  let at = 0;
  // A hidden page draws no frames, and its transport goes on.
  for (let loop = 0; loop < 450; loop++) {
    for (const [i, { bytes }] of poses.entries()) {
      at = 8000 * loop + (8000 * i) / poses.length;
      const later = bytes.slice();
      // The pose packet follows three bytes of the peer's.
      setTime(later.subarray(3), at);
      others.receive(at, 'ada', later);
    }
  }
  const started = process.cpuUsage().user;
  expect(others.update(at)).toHaveLength(1);
  // An hour's packets, dropped one by one, took 4 s.
  expect((process.cpuUsage().user - started) / 1000).toBeLessThan(500);
  expect(at / 1000 - others.report('ada')!.shownTime).toBeLessThan(0.25);
});

test('the number of peers is limited, and one that is silent for 30 s is forgotten', () => {
  const { until, sent } = sending();
  until(50);
  const refused: string[] = [];
  const others = new RemotePoses({ maxPeers: 2 });
  others.addEventListener('refused', (event) => {
    event.preventDefault();
    refused.push(event.peer);
  });
  for (const peer of ['ada', 'ben', 'cy']) others.receive(0, peer, sent[0]!.bytes);
  expect(refused).toEqual(['cy']);
  others.update(31_000);
  expect(others.receive(31_000, 'cy', sent[0]!.bytes)).toBe(true);
});

test('a rate, measures or a reference that cannot be are refused with a sentence', () => {
  const make = (options: object) => () => new PoseSender(() => undefined, { name: 'Ada', ...options });
  expect(make({ rateHz: 0 })).toThrow(/0 poses a second/);
  expect(make({ avatar: 'x'.repeat(201) })).toThrow(/201 characters/);
  const sender = make({})();
  expect(() => sender.update(0, { pose: null, calibration: { eyeHeight: 170, armSpan: 150 } })).toThrow(RangeError);
});

test('mutated and random packets never throw, and show nobody who is not finite', {
  tags: ['full'],
  timeout: 600_000,
}, () => {
  const { until, sent } = sending();
  until(1000, { placement: { position: { x: 1, y: 0, z: 1 }, heading: 1 } });
  const chance = createRandom(47);
  const below = (end: number) => Math.floor(chance() * end);
  const some = () => sent[below(sent.length)]!.bytes.slice();
  const ways: readonly (() => Uint8Array)[] = [
    some,
    () => some().map((byte) => (chance() < 0.03 ? below(256) : byte)),
    () => some().slice(0, below(100)),
    () => Uint8Array.from([...some(), ...some()]).slice(0, below(2 * maxPeerPacketBytes)),
    () => Uint8Array.from([peerPacketVersion, below(4), ...Array.from({ length: below(90) }, () => below(256))]),
  ];
  const reasons = new Map<string, number>();
  const others = new RemotePoses();
  others.addEventListener('refused', (event) => {
    event.preventDefault();
    reasons.set(event.reason, (reasons.get(event.reason) ?? 0) + 1);
  });
  let shown = 0;
  const packets = isNightly ? 1_000_000 : 100_000;
  for (let i = 0; i < packets; i++) {
    const now = 20 * i;
    others.receive(now, 'mallory', ways[below(ways.length)]!());
    for (const { joints, pose, placement, mouth, name } of others.update(now)) {
      shown += 1;
      const places = [pose.head, pose.leftHand, joints?.leftHand, joints?.hips, placement];
      const sum = places.reduce((total, at) => total + (at ? at.position.x + at.position.y + at.position.z : 0), 0);
      if (!Number.isFinite(sum) || !(mouth >= 0 && mouth <= 1) || name.length > 40) expect.fail(`packet ${i}`);
    }
  }
  expect(shown).toBeGreaterThan(packets / 10);
  // Every check is met, and not the first alone.
  expect(reasons.size).toBeGreaterThanOrEqual(6);
});
