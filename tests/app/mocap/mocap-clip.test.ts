import { describe, expect, test } from 'vitest';
import { drive } from '../../../bench/evaluate/drive';
import { addClip, emptyMeasures, report, reportNames } from '../../../bench/evaluate/measures';
import type { RecordedFrame } from '../../../bench/evaluate/recordings';
import { meanErrors, meanOf } from '../../../src/app/mocap/joint-errors';
import { pairFiles } from '../../../src/app/mocap/mocap-files';
import { recordingOf, Truth } from '../../../src/app/mocap/truth';
import { createEstimator } from '../../../src/core/estimation/estimators';
import { mocapRateHz, prepareMocap } from '../../../src/core/mocap/prepare-mocap';
import { finishWork } from '../../../src/core/motion/work';
import type { Recording } from '../../../src/core/tracking/recording';
import { goldenMocap, sourceOf } from '../../core/mocap/golden-mocap';

const clip = finishWork(prepareMocap(sourceOf(goldenMocap[0]!))).clips[0]!;

/** The clip as the evaluation reads it. */
const recorded = (recording: Recording, truth: Truth): RecordedFrame[] =>
  recording.frames.map((frame) => {
    const places = Object.entries(truth.at(frame.time)).map(([joint, place]) => [joint, { ...place }]);
    return { frame, truth: Object.fromEntries(places) };
  });

describe('an opened clip', () => {
  test('has the errors over the whole clip that the evaluation reports, joint by joint', async () => {
    const truth = new Truth(clip);
    const recording = finishWork(recordingOf(clip));
    const work = meanErrors(recording, truth, createEstimator('ik', clip.calibration, null));
    let step = await work.next();
    while (!step.done) step = await work.next();
    const measures = emptyMeasures();
    addClip(measures, await drive('ik', clip.calibration, null, recorded(recording, truth)), mocapRateHz);
    const { mpjpeCm, joints } = report(measures);
    expect(meanOf(step.value)).toBeCloseTo(mpjpeCm.mean, 2);
    for (const [i, name] of reportNames.entries()) expect(step.value[i]).toBeCloseTo(joints[name].mean, 2);
  });

  test('is true between two frames where a straight line between them is, and stays at its ends', () => {
    const truth = new Truth(clip);
    const at = (seconds: number) => ({ ...truth.at(seconds).leftHand! });
    const [before, after] = [at(10 / mocapRateHz), at(11 / mocapRateHz)];
    const between = at(10.25 / mocapRateHz);
    for (const axis of ['x', 'y', 'z'] as const)
      expect(between[axis]).toBeCloseTo(before[axis] + 0.25 * (after[axis] - before[axis]), 6);
    expect(at(1e6)).toEqual(at((clip.frameCount - 1) / mocapRateHz));
    expect(at(-1)).toEqual(at(0));
  });
});

describe('files of one motion', () => {
  const file = (name: string) => ({ name, bytes: new ArrayBuffer(0) });

  test('are an AMC and the ASF whose name its own begins with', () => {
    const { motion, skeleton, others } = pairFiles(['02.asf', '01.asf', '01_02.amc'].map(file));
    expect([motion.name, skeleton?.name, others]).toEqual(['01_02.amc', '01.asf', ['02.asf']]);
  });

  test('are named where one is missing', () => {
    expect(() => pairFiles([file('01_02.amc')])).toThrow(
      '01_02.amc: a motion without its skeleton; open its .asf together with it',
    );
    expect(() => pairFiles([file('01.asf')])).toThrow(
      '01.asf: a skeleton without motion; open its .amc together with it',
    );
  });

  test('are one motion: others are named', () => {
    expect(pairFiles(['a.bvh', 'b.bvh', 'c.asf'].map(file)).others).toEqual(['b.bvh', 'c.asf']);
  });
});
