// npm run bench:bodies [-- --json FILE] [--seconds N]: what it costs to show other people's bodies, by the format in
// which they are sent. One motion at 30 packets a second goes over the same simulated network in all formats.

import { writeFileSync } from 'node:fs';
import { BodySolver } from 'threepoint';
import { actorFrame, defaultCalibration, forwardKinematics, skeletonFromCalibration } from 'threepoint/core';
import { createRandom, distance, lerp, median, type Vec3 } from 'threepoint/math';
import { mean, quantile } from '../../src/threepoint/core/math/statistics';
import { type BodyFormat, formats } from './formats';

const displayMs = 1000 / 72;
const settlingMs = 6000;
const measured = ['head', 'leftHand', 'rightHand', 'leftLowerArm', 'rightLowerArm', 'leftUpperArm', 'hips'] as const;
const skeleton = skeletonFromCalibration(defaultCalibration);

/** One way through the network: half of the round trip and its jitter [ms], and the share of packets lost. */
const network = { oneWay: 25, jitter: 20, loss: 0.02 } as const;
/** People who are drawn at the same time, for the time on the main thread. */
const crowd = 15;

interface Sent {
  readonly arrivesAt: number;
  readonly bytes: Uint8Array;
}

const actor = () =>
  new BodySolver({
    estimator: 'ik',
    calibration: defaultCalibration,
    networks: () => Promise.reject(new Error('inverse kinematics needs no network')),
  });

/** The sender's joints at each of its frames [m]. */
function record(durationMs: number): readonly (readonly Vec3[])[] {
  const body = actor();
  const frames: Vec3[][] = [];
  for (let time = 0; time < durationMs; time += displayMs) {
    const pose = body.update(actorFrame(time / 1000, defaultCalibration));
    const joints = forwardKinematics(skeleton, pose!.body!);
    frames.push(measured.map((name) => ({ ...joints[name].position })));
  }
  return frames;
}

/** Sends the motion, and returns its packets in the order of their arrival, with all bytes that were sent. */
function transmit(format: BodyFormat, durationMs: number): { packets: readonly Sent[]; bytes: number } {
  const body = actor();
  // All formats have the same delays and losses, by the number of the packet.
  const delays = createRandom(47);
  const losses = createRandom(48);
  const packets: Sent[] = [];
  let bytes = 0;
  let now = 0;
  const send = format.sender((packet) => {
    bytes += packet.length;
    const arrivesAt = now + network.oneWay + network.jitter * (2 * delays() - 1);
    if (losses() >= network.loss) packets.push({ arrivesAt, bytes: packet });
  });
  for (; now < durationMs; now += displayMs) {
    body.update(actorFrame(now / 1000, defaultCalibration));
    send(now, body);
  }
  return { packets: packets.sort((a, b) => a.arrivesAt - b.arrivesAt), bytes };
}

/** Draws the motion, and measures it against the sender's own at the time that is drawn. */
function draw(format: BodyFormat, packets: readonly Sent[], truth: ReturnType<typeof record>, durationMs: number) {
  const receiver = format.receiver();
  const errors: number[] = [];
  const ages: number[] = [];
  let next = 0;
  let still = 0;
  let frames = 0;
  let before: Vec3 | null = null;
  for (let time = 0; time < durationMs; time += displayMs) {
    for (; next < packets.length && packets[next]!.arrivesAt <= time; next++)
      receiver.receive('ada', packets[next]!.bytes, packets[next]!.arrivesAt);
    receiver.update(time);
    const drawn = receiver.drawn('ada');
    if (!drawn || time < settlingMs) continue;
    frames += 1;
    const index = drawn.senderMs / displayMs;
    const [a, b] = [truth[Math.floor(index)], truth[Math.floor(index) + 1]];
    if (!a || !b) continue;
    ages.push(time - drawn.senderMs);
    for (const [i, name] of measured.entries())
      errors.push(100 * distance(drawn.joints[name].position, lerp(a[i]!, b[i]!, index % 1)));
    const hand = { ...drawn.joints.leftHand.position };
    if (before && distance(hand, before) === 0) still += 1;
    before = hand;
  }
  return {
    'error, mean [cm]': mean(errors),
    'error, p95 [cm]': quantile(errors, 0.95),
    'age, p50 [ms]': median(ages),
    'age, p95 [ms]': quantile(ages, 0.95),
    'frames that stand still [%]': (100 * still) / frames,
  };
}

/** Returns the time on the main thread for a crowd, a frame of the display [ms]. */
function timeOf(format: BodyFormat, packets: readonly Sent[], durationMs: number): number {
  const receiver = format.receiver();
  let next = 0;
  let spent = 0;
  let frames = 0;
  for (let time = 0; time < durationMs; time += displayMs) {
    const started = performance.now();
    for (; next < packets.length && packets[next]!.arrivesAt <= time; next++) {
      for (let peer = 0; peer < crowd; peer++)
        receiver.receive(`peer ${peer}`, packets[next]!.bytes, packets[next]!.arrivesAt);
    }
    receiver.update(time);
    if (time < settlingMs) continue;
    spent += performance.now() - started;
    frames += 1;
  }
  return spent / frames;
}

const { json, seconds = '60' } = JSON.parse(process.argv[2] ?? '{}') as { json?: string; seconds?: string };
const durationMs = 1000 * Number(seconds);
const truth = record(durationMs);
const sent = formats.map((format) => ({ format, ...transmit(format, durationMs) }));
/** Three rounds, each with all formats in turn: the median of a shared machine. */
const rounds = [0, 1, 2].map(() => sent.map(({ format, packets }) => timeOf(format, packets, durationMs)));
const table = sent.map(({ format, packets, bytes }, i) => ({
  format: format.name,
  'bytes a second': (1000 * bytes) / durationMs,
  ...draw(format, packets, truth, durationMs),
  [`main thread for ${crowd}, a frame [ms]`]: median(rounds.map((times) => times[i]!)),
}));
console.table(
  table.map((row) =>
    Object.fromEntries(
      Object.entries(row).map(([key, value]) => [
        key,
        typeof value === 'number' ? Number(value.toPrecision(3)) : value,
      ]),
    ),
  ),
);
if (json) writeFileSync(json, `${JSON.stringify({ network, seconds: durationMs / 1000, table }, null, 2)}\n`);
