// Prints, as JSON, how many bytes on the heap each call of an operation leaves once it is compiled: a program of its
// own, because the records of property tests have x, y and z too (see `Vec3`).
import { Session } from 'node:inspector/promises';
import '../../src/page/archery/archery-play';
import '../../src/page/ball/match/ball-play';
import '../../src/page/studio/recorder';
import { createEstimator, defaultCalibration, TrackingDegradation } from 'threepoint/core';
import { add, fromAxisAngle, multiply, quat, rotate, vec3 } from 'threepoint/math';
import 'threepoint-study';
import 'threepoint-rooms/room';

const calls = 20_000;
/** Until the operation is compiled: at most this often. */
const rounds = 40;

createEstimator('ik', defaultCalibration);

const session = new Session();
session.connect();
await session.post('HeapProfiler.enable');

type Profile = Awaited<ReturnType<typeof stop>>;
const stop = async () => (await session.post('HeapProfiler.stopSampling')).profile.head;
const sizeOf = ({ selfSize, children }: Profile): number =>
  children.reduce((sum, child) => sum + sizeOf(child), selfSize);

async function bytesPerCall(work: () => void): Promise<number> {
  let least = Number.POSITIVE_INFINITY;
  for (let round = 0; round < rounds && least >= 1; round++) {
    await session.post('HeapProfiler.startSampling', {
      samplingInterval: 256,
      includeObjectsCollectedByMajorGC: true,
      includeObjectsCollectedByMinorGC: true,
    });
    for (let i = 0; i < calls; i++) work();
    least = Math.min(least, sizeOf(await stop()) / calls);
  }
  return least;
}

const a = vec3(0.1, 0.2, 0.3);
const sum = vec3(0.4, 0.5, 0.6);
const turn = fromAxisAngle(vec3(0, 1, 0), 0.4);
const product = quat(0.1, 0.2, 0.3, 0.4);
const vector = await bytesPerCall(() => {
  add(a, sum, sum);
  rotate(turn, sum, sum);
});
const quaternion = await bytesPerCall(() => {
  multiply(turn, product, product);
});
const hand = {
  position: vec3(0.3, 1.2, -0.4),
  orientation: fromAxisAngle(vec3(0, 1, 0), 0.4),
  tracking: 'tracked',
} as const;
const frame = { time: 3.1, head: hand, leftHand: hand, rightHand: hand };
const impairedTracking = new TrackingDegradation();
impairedTracking.configure({
  latencyMs: 100,
  trackerNoise: { positionMm: 5, rotationDegrees: 1 },
  dropouts: { perMinute: 20, seconds: 0.5 },
});
const impaired = await bytesPerCall(() => {
  frame.time += 1 / 72;
  impairedTracking.apply(frame);
});
console.log(JSON.stringify({ vector, quaternion, impaired }));
