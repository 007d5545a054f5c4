import {
  createEstimator,
  parseRecording,
  type Replayable,
  recordingDuration,
  sampleRecording,
  writeRecording,
} from 'threepoint/core';
import { mocapRateHz } from 'threepoint/internal';
import { describe, expect, test } from 'vitest';
import { drive } from '../../../bench/evaluate/drive';
import { addClip, emptyMeasures, report, reportNames } from '../../../bench/evaluate/measures';
import type { RecordedFrame } from '../../../bench/evaluate/recordings';
import { meanErrors, meanOf } from '../../../src/page/mocap/joint-errors';
import { pairFiles } from '../../../src/page/mocap/mocap-files';
import { recordingOf } from '../../../src/page/mocap/simulated-recording';
import { Truth } from '../../../src/page/mocap/truth';
import { clipOf, goldenMocap } from '../../threepoint/core/mocap/golden-mocap';

const clip = clipOf(goldenMocap[0]!);

/** The clip as the evaluation reads it. */
const recorded = (recording: Replayable, truth: Truth): RecordedFrame[] =>
  Array.from(recording.frames, (frame) => {
    const places = Object.entries(truth.at(frame.time)).map(([joint, place]) => [joint, { ...place }]);
    return { frame, truth: Object.fromEntries(places) };
  });

describe('an opened clip', () => {
  test('has the errors over the whole clip that the evaluation reports, joint by joint', async () => {
    const truth = new Truth(clip);
    const recording = recordingOf(clip);
    const work = meanErrors(recording, truth, createEstimator('ik', clip.calibration, null));
    let step = await work.next();
    while (!step.done) step = await work.next();
    const measures = emptyMeasures();
    addClip(measures, await drive('ik', clip.calibration, null, recorded(recording, truth)), mocapRateHz);
    const { mpjpeCm, joints } = report(measures);
    expect(meanOf(step.value)).toBeCloseTo(mpjpeCm.mean, 2);
    for (const [i, name] of reportNames.entries()) expect(step.value[i]).toBeCloseTo(joints[name].mean, 2);
  });

  test('replays half an hour without more frames in memory than are looked at', () => {
    const frameCount = 30 * 60 * mocapRateHz;
    const tracked = new Float32Array(21 * frameCount);
    for (let i = 0; i < tracked.length; i++) tracked[i] = clip.tracked[i % clip.tracked.length]!;
    const { frames, ...about } = recordingOf({ ...clip, frameCount, tracked });
    let made = 0;
    const watched: typeof frames = {
      length: frames.length,
      at(index) {
        made += 1;
        return frames.at(index);
      },
      [Symbol.iterator]: () => frames[Symbol.iterator](),
    };
    const recording = { ...about, frames: watched };
    expect(recordingDuration(recording)).toBeCloseTo(30 * 60, 1);
    for (const second of [0, 1, 17.31, 900.005, 1799]) {
      made = 0;
      expect(sampleRecording(recording, second).time).toBe(second);
      expect(made, `frames made for second ${second}`).toBeLessThan(10);
    }
    expect(frames.at(5)).toEqual(frames.at(5 - frameCount));
    expect(frames.at(5)).not.toBe(frames.at(5));
    expect(frames.at(frameCount)).toBeUndefined();
  });

  test('is downloaded as a recording like any other', () => {
    const recording = recordingOf(clip);
    const read = parseRecording(writeRecording(recording));
    expect(read.frames).toEqual([...recording.frames]);
    expect(read.frames).toHaveLength(clip.frameCount);
  });

  test('is true between two frames where a line between them is, and keeps its ends', () => {
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
  test('are an AMC and the ASF whose name its own begins with', () => {
    const { motion, skeleton, others } = pairFiles(['02.asf', '01.asf', '01_02.amc']);
    expect([motion, skeleton, others]).toEqual(['01_02.amc', '01.asf', ['02.asf']]);
  });

  test('are an AMC and its own skeleton, also where another one’s name begins as it does', () => {
    expect(pairFiles(['10.asf', '105.asf', '105_01.amc']).skeleton).toBe('105.asf');
    expect(pairFiles(['10.asf', '105.asf', '10_01.amc']).skeleton).toBe('10.asf');
  });

  test('are a BVH and the map of its skeleton', () => {
    expect(pairFiles(['map.json', 'dance.bvh'])).toEqual({
      motion: 'dance.bvh',
      skeleton: null,
      map: 'map.json',
      others: [],
    });
    expect(() => pairFiles(['map.json'])).toThrow('map.json: a skeleton map without motion');
  });

  test('are named where one is missing', () => {
    expect(() => pairFiles(['clips/01_02.amc'])).toThrow(
      '01_02.amc: a motion without its skeleton; open it together with its .asf',
    );
    expect(() => pairFiles([new File([], '01.asf')])).toThrow(
      '01.asf: a skeleton without motion; open it together with its .amc',
    );
  });

  test('are one motion: others are named', () => {
    expect(pairFiles(['a.bvh', 'b.bvh', 'c.asf']).others).toEqual(['b.bvh', 'c.asf']);
  });
});
