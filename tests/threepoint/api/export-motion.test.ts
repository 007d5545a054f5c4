import { describe, expect, test, vi } from 'vitest';
import { exportMotion } from '../../../src/threepoint/api/export-motion';
import { defaultCalibration } from '../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../src/threepoint/core/body/forward-kinematics';
import { closedHand } from '../../../src/threepoint/core/body/hand-shape';
import { skeletonFromCalibration } from '../../../src/threepoint/core/body/skeleton';
import { createEstimator, networkOf } from '../../../src/threepoint/core/estimation/estimators';
import type { PoseRegressor } from '../../../src/threepoint/core/estimation/networks/pose-regressor';
import type { PaperMethod } from '../../../src/threepoint/core/estimation/pose-estimator';
import { distance } from '../../../src/threepoint/core/math/vec3';
import { createSkeletonPose } from '../../../src/threepoint/core/motion/imported-motion';
import { turnPoint } from '../../../src/threepoint/core/motion/motion-bones';
import { poseBvh, readBvh } from '../../../src/threepoint/core/motion/read-bvh';
import { finishWork } from '../../../src/threepoint/core/motion/work';
import { actorFrame } from '../../../src/threepoint/core/tracking/actor-motion';
import { deviceBodySize } from '../../../src/threepoint/core/tracking/device-body';
import type { Recording } from '../../../src/threepoint/core/tracking/recording';
import type { TrackingFrame } from '../../../src/threepoint/core/tracking/tracking-frame';
import { show } from '../core/estimation/drawn';
import { openPlainModel, openShippedModel } from '../core/estimation/shipped-models';

const rateHz = 60;
const recordingOf = (seconds: number): Recording => ({
  device: 'actor',
  rateHz,
  calibration: defaultCalibration,
  frames: Array.from({ length: Math.round(seconds * rateHz) }, (_, i) => ({
    ...actorFrame(2 + i / rateHz, defaultCalibration),
    fingers: { left: closedHand, right: null },
  })),
});
const recording = recordingOf(1);
const networks = async (name: 'paper' | 'learned') => (name === 'learned' ? openPlainModel() : openShippedModel(name));
const textOf = (parts: readonly unknown[]): string => parts.join('');

describe('a recording', () => {
  test.each(['ik', 'learned', 'paper', 'paper-published'] as const)(
    'becomes the BVH of what %s draws live, within 1 mm',
    async (name) => {
      const { parts, extension } = await exportMotion<PaperMethod>(recording, {
        format: 'bvh',
        estimator: name,
        networks,
      });
      expect(extension).toBe('bvh');
      const file = finishWork(readBvh(textOf(parts)));
      const pose = createSkeletonPose(file.joints.length);
      const network = networkOf(name);
      const regressor = network && (await networks(network));
      const live = createEstimator(name, defaultCalibration, regressor);
      const skeleton = skeletonFromCalibration(defaultCalibration);
      for (const [i, frame] of recording.frames.entries()) {
        const { body } = await show(live, frame);
        const joints = forwardKinematics(skeleton, body!);
        poseBvh(file, i, pose);
        for (const joint of ['leftHand', 'rightLowerArm', 'chest', 'hips'] as const) {
          const at = pose.positions[file.joints.findIndex((found) => found.name === joint)]!;
          expect(distance(turnPoint(at), joints[joint].position), `${joint}, frame ${i}`).toBeLessThan(1e-3);
        }
      }
      await regressor?.dispose();
    },
  );

  test.each(['csv', 'vrma'] as const)('becomes a file of kind %s', async (format) => {
    const { parts, extension, type } = await exportMotion(recording, { format, estimator: 'ik' });
    expect(extension).toBe(format);
    expect(new Blob([...parts], { type }).size).toBeGreaterThan(10_000);
  });

  test('is refused in a sentence where the device’s body is wanted and no frame has one', async () => {
    await expect(exportMotion(recording, { format: 'csv', estimator: 'device', networks })).rejects.toThrow(
      'The recording has no device body. Choose another method.',
    );
    const seen = { ...recording.frames[3]!, deviceBody: new Float32Array(deviceBodySize) };
    const some = { ...recording, frames: recording.frames.with(3, seen) };
    expect((await exportMotion(some, { format: 'csv', estimator: 'device', networks })).extension).toBe('csv');
  });

  test('is refused in a sentence where the method draws no body', async () => {
    await expect(exportMotion(recording, { format: 'bvh', estimator: 'hands-only' })).rejects.toThrow(
      /estimates no body/,
    );
    // reason: what a page without types may pass
    await expect(exportMotion(recording, { format: 'bvh', estimator: 'paper' as 'learned' })).rejects.toThrow(
      /needs a runtime/,
    );
    await expect(exportMotion(recording, { format: 'fbx' as 'bvh', estimator: 'ik' })).rejects.toThrow(
      /“fbx” is not a motion format/,
    );
  });

  test('shows what a program’s frames see: a frame that is nowhere leaves no trace behind it', async () => {
    const nowhere = { x: Number.NaN, y: 0, z: 0 };
    const slips = [
      { ...recording.frames[5]!, leftHand: { ...recording.frames[5]!.leftHand!, position: nowhere } },
      { ...recording.frames[9]!, head: { ...recording.frames[9]!.head, position: nowhere } },
      // reason: a program without types leaves out what it does not see
      (({ time, head }) => ({ time, head }) as TrackingFrame)(recording.frames[12]!),
    ] as const;
    const frames = recording.frames.with(5, slips[0]).with(9, slips[1]).with(12, slips[2]);
    for (const calibration of [defaultCalibration, null]) {
      const { parts } = await exportMotion({ ...recording, calibration, frames }, { format: 'csv', estimator: 'ik' });
      const rows = textOf(parts).trimEnd().split('\n').slice(1);
      expect(rows).toHaveLength(recording.frames.length - 1);
      expect(rows.flatMap((row) => row.split(',').map(Number)).every(Number.isFinite)).toBe(true);
    }
  });

  test.each<[string, () => Promise<unknown>, RegExp]>([
    [
      'of a person of centimetres',
      () => exportMotion(recording, { format: 'csv', estimator: 'ik', calibration: { eyeHeight: 160, armSpan: 151 } }),
      /^A height of 170\.94 m is outside/,
    ],
    [
      'with an option that there is not',
      // reason: what a page without types may pass
      () => exportMotion(recording, { format: 'csv', to: 'csv' } as Parameters<typeof exportMotion>[1]),
      /^“to” is not an option of exportMotion\. Use format, estimator, /,
    ],
    [
      'of no frames',
      () => exportMotion({ ...recording, frames: [] }, { format: 'bvh', estimator: 'ik' }),
      /^The recording has no frame in which the head is seen\.$/,
    ],
    [
      'that runs backwards',
      () => exportMotion({ ...recording, frames: recording.frames.toReversed() }, { format: 'bvh', estimator: 'ik' }),
      /^Frame 2 of the recording is not later/,
    ],
    [
      'in inches',
      () => exportMotion(recording, { format: 'bvh', estimator: 'ik', unit: 'inch' as 'm' }),
      /^“inch” is not a unit of a BVH file. Use m or cm.$/,
    ],
  ])('%s is refused in a sentence', async (_, work, sentence) => {
    await expect(work()).rejects.toThrow(sentence);
  });

  test('says in a table that a hand was not seen where the device guessed it', async () => {
    const guessed = { ...recording.frames[3]!.leftHand!, tracking: 'emulated' as const };
    const frames = recording.frames.with(3, { ...recording.frames[3]!, leftHand: guessed });
    const { parts } = await exportMotion({ ...recording, frames }, { format: 'csv', estimator: 'ik' });
    const rows = textOf(parts).split('\n').slice(1);
    expect(rows.slice(2, 5).map((row) => row.split(',').slice(1, 3).join())).toEqual(['1,1', '0,1', '1,1']);
  });

  test('without measures is of a person as tall as its first frame shows', async () => {
    const { parts } = await exportMotion({ ...recording, calibration: null }, { format: 'csv', estimator: 'ik' });
    const [header, row] = textOf(parts).split('\n');
    const at = header!.split(',').indexOf('head_y');
    expect(Number(row!.split(',')[at])).toBeGreaterThan(1.3);
  });
});

describe('a long export', () => {
  test('reports how far it is, and how long the rest takes', async () => {
    const reported: number[] = [];
    const left: (number | null)[] = [];
    await exportMotion(recordingOf(20), {
      format: 'bvh',
      estimator: 'ik',
      onProgress({ fraction, secondsLeft }) {
        reported.push(fraction);
        left.push(secondsLeft);
      },
    });
    expect(reported.length).toBeGreaterThan(1);
    expect(reported).toEqual([...reported].sort((a, b) => a - b));
    expect([reported.at(-1), left.at(-1)]).toEqual([1, 0]);
  });

  test('lets others have their turn', async () => {
    let turns = 0;
    const timer = setInterval(() => {
      turns += 1;
    }, 0);
    await exportMotion(recordingOf(20), { format: 'bvh', estimator: 'ik' });
    clearInterval(timer);
    expect(turns).toBeGreaterThan(3);
  });

  test('can be abandoned while its network is on its way, which is released on arrival', async () => {
    const giveUp = new AbortController();
    const network = { ...openPlainModel(), dispose: vi.fn(async () => undefined) };
    let arrive: (network: PoseRegressor) => void = () => undefined;
    const loading = new Promise<PoseRegressor>((resolve) => {
      arrive = resolve;
    });
    const networks = vi.fn(() => loading);
    const work = exportMotion(recording, { format: 'bvh', networks, signal: giveUp.signal });
    const refused = expect(work).rejects.toThrow('enough');
    await expect.poll(() => networks.mock.calls.length).toBeGreaterThan(0);
    giveUp.abort(new Error('enough'));
    await refused;
    arrive(network);
    await expect.poll(() => network.dispose.mock.calls.length).toBe(1);
  });

  test('is given up when it is asked to, and lets its network go', async () => {
    const giveUp = new AbortController();
    let disposed = 0;
    const network = openPlainModel();
    const work = exportMotion(recordingOf(20), {
      format: 'bvh',
      estimator: 'learned',
      networks: async () => ({
        ...network,
        async dispose() {
          disposed += 1;
        },
      }),
      signal: giveUp.signal,
      onProgress: () => giveUp.abort(new Error('enough')),
    });
    await expect(work).rejects.toThrow('enough');
    expect(disposed).toBe(1);
  });
});
