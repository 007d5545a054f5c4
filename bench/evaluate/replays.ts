// node --import tsx bench/evaluate/replays.ts FILE...: how the estimators follow recordings of real headsets, Beat
// Saber's .bsor files and recordings of aframe-motion-capture (.json). Nobody's body is known: the eye height is a
// quantile of the head's height, the span its usual share. Public files: MetaGuard/xror test/data/bsor,
// dmarcos/aframe-motion-capture-components examples.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { reasonOf, type TrackingFrame } from 'threepoint/core';
import { backward, distance, fromAxisAngle, multiply, right, type TrackedPose, up, type Vec3 } from 'threepoint/math';
import { createDriver, measuredMethods } from './drive';
import { loadRegressors } from './networks';

/** Wrist to wrist, in eye heights: an average person's, and someone's with short arms. */
const spans = [0.945, 0.85];
/** A frame counts where a joint moves over this many times the fastest tracker and so much more [m]. */
const [gain, slack] = [3, 0.002];
/** A hand further from its tracker than this [m] is off. */
const off = 0.001;

type Points = Readonly<Record<'head' | 'leftHand' | 'rightHand', TrackedPose>>;
type Replay = readonly (Points & { readonly time: number })[];

/** Frames of a Beat Saber replay (BSOR 1): a left-handed frame with +Z forward becomes one with −Z forward. */
function readBsor(bytes: Buffer): Replay {
  let at = 6;
  const skipTexts = (count: number) => {
    for (let i = 0; i < count; i++) at += 4 + bytes.readInt32LE(at);
  };
  if (bytes.readUInt32LE(0) !== 0x442d3d69) throw new Error('no Beat Saber replay: other first bytes');
  skipTexts(13);
  at += 4;
  skipTexts(3);
  at += 21;
  if (bytes[at] !== 1) throw new Error(`expected frames at byte ${at}`);
  const first = at + 5;
  const frameBytes = 92;
  return Array.from({ length: bytes.readInt32LE(at + 1) }, (_, row) => {
    const number = (offset: number) => bytes.readFloatLE(first + row * frameBytes + offset);
    const pose = (offset: number): TrackedPose => ({
      position: { x: number(offset), y: number(offset + 4), z: -number(offset + 8) },
      orientation: {
        x: -number(offset + 12),
        y: -number(offset + 16),
        z: number(offset + 20),
        w: number(offset + 24),
      },
      tracking: 'tracked',
    });
    return { time: number(0), head: pose(8), leftHand: pose(36), rightHand: pose(64) };
  });
}

interface AframePose {
  readonly position: Vec3;
  /** Degrees about x, y, z; Y first, then X, then Z. */
  readonly rotation: Vec3;
  /** [ms] */
  readonly timestamp: number;
}

/** Frames of aframe-motion-capture: one list of poses for camera, left and right. */
function readAframe(text: string): Replay {
  const lists = JSON.parse(text) as Record<'camera' | 'left' | 'right', { readonly poses: readonly AframePose[] }>;
  const radians = (degrees: number) => (degrees * Math.PI) / 180;
  const pose = ({ position, rotation: { x, y, z } }: AframePose): TrackedPose => ({
    position,
    orientation: multiply(
      fromAxisAngle(up, radians(y)),
      multiply(fromAxisAngle(right, radians(x)), fromAxisAngle(backward, radians(z))),
    ),
    tracking: 'tracked',
  });
  const count = Math.min(...(['camera', 'left', 'right'] as const).map((name) => lists[name].poses.length));
  return Array.from({ length: count }, (_, row) => {
    const of = (name: 'camera' | 'left' | 'right') => pose(lists[name].poses[row]!);
    return {
      time: lists.camera.poses[row]!.timestamp / 1000,
      head: of('camera'),
      leftHand: of('left'),
      rightHand: of('right'),
    };
  });
}

const read = (file: string): Replay =>
  file.endsWith('.bsor') ? readBsor(readFileSync(file)) : readAframe(readFileSync(file, 'utf8'));

/**
 * A row of the table: the share of frames that move too far, the longest step beyond what is allowed, and hands off
 * their trackers.
 */
async function measure(replay: Replay, draw: (frame: TrackingFrame) => Promise<Readonly<Record<string, Vec3>>>) {
  let before: { readonly points: Replay[number]; readonly joints: Readonly<Record<string, Vec3>> } | null = null;
  const sums = { frames: 0, tooFar: 0, longest: 0, off: 0 };
  for (const points of replay) {
    if (before && points.time <= before.points.time) continue;
    const joints = await draw(points);
    sums.frames += 1;
    for (const hand of ['leftHand', 'rightHand'] as const)
      if (distance(joints[hand]!, points[hand].position) > off) sums.off += 0.5;
    if (before) {
      const last = before;
      const moved = (name: keyof Points) => distance(points[name].position, last.points[name].position);
      const fastest = Math.max(moved('head'), moved('leftHand'), moved('rightHand'));
      const step = Math.max(...Object.entries(joints).map(([name, place]) => distance(place, last.joints[name]!)));
      if (step > gain * fastest + slack) sums.tooFar += 1;
      sums.longest = Math.max(sums.longest, step - gain * fastest);
    }
    before = { points, joints };
  }
  const share = (count: number) => `${((100 * count) / sums.frames).toFixed(2)} %`;
  return [`${sums.frames}`, share(sums.tooFar), `${(100 * sums.longest).toFixed(1)} cm`, share(sums.off)];
}

const regressors = await loadRegressors('public/models');
console.log(
  '| | method | span [eye heights] | frames | too far | longest step | hands off |\n|---|---|---:|---:|---:|---:|---:|',
);
for (const file of process.argv.slice(2)) {
  try {
    const replay = read(file);
    const heights = replay.map(({ head }) => head.position.y).sort((a, b) => a - b);
    const eyeHeight = heights[Math.floor(0.95 * heights.length)]!;
    for (const span of spans) {
      for (const name of measuredMethods) {
        const driver = createDriver(name, { eyeHeight, armSpan: span * eyeHeight }, regressors.get(name) ?? null);
        const cells = await measure(replay, async (frame) => (await driver.draw(frame)).joints);
        console.log(`| ${[basename(file), name, span, ...cells].join(' | ')} |`);
      }
    }
  } catch (error) {
    console.error(`${file}: ${reasonOf(error)}`);
    process.exitCode = 1;
  }
}
for (const regressor of regressors.values()) await regressor.dispose();
