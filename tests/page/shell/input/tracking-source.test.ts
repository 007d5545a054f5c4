import { Body } from 'threepoint';
import { actorFrame, defaultCalibration, forwardKinematics, skeletonFromCalibration } from 'threepoint/core';
import { ReplayedBody } from 'threepoint/internal';
import { expect, test } from 'vitest';
import { createActor } from '../../../../src/page/emulator/actor';
import { TrackingSource } from '../../../../src/page/shell/input/tracking-source';
import type { StageParts } from '../../../../src/page/shell/stage/stage-parts';
import { Recorder } from '../../../../src/page/studio/recorder';
import { noPointers, noSession } from '../../activity-services';
import { fake } from '../fake';

const skeleton = skeletonFromCalibration(defaultCalibration);

/** A page whose headset is worn by a person who moves as the actor does, with its recorder and its body. */
function worn() {
  const recorder = new Recorder();
  const body = new Body({
    estimator: 'ik',
    calibration: defaultCalibration,
    networks: () => Promise.reject(new Error('inverse kinematics has none')),
  });
  const replayed = new ReplayedBody(body, recorder);
  const parts = fake<StageParts>({
    settings: { actor: true },
    headset: { emulator: null, worn: true },
    tracker: { tracking: null, read: (_: unknown, time: number) => actorFrame(time, defaultCalibration) },
    body,
    recorder,
    activities: { current: null, act: () => null },
    study: { run: null },
  });
  const source = new TrackingSource(parts, noPointers, createActor());
  const wristAt = (time: number) => {
    const pose = replayed.update(source.read(time, {} as XRFrame), source.standIn);
    return { ...forwardKinematics(skeleton, pose!.body!).rightHand.position };
  };
  return { recorder, wristAt };
}

test('with the actor off before a real headset is put on, the body stands still', () => {
  const asked: number[] = [];
  const parts = fake<StageParts>({
    settings: { actor: false },
    headset: { emulator: null, worn: false },
    ...noSession,
    recorder: new Recorder(),
    activities: {
      current: null,
      act(time: number) {
        asked.push(time);
        return null;
      },
    },
    study: { run: null },
  });
  const source = new TrackingSource(parts, noPointers, createActor());
  const [earlier, later] = [source.read(10, undefined), source.read(13, undefined)];
  expect(later).toEqual({ ...earlier, time: 13 });
  expect(later?.head.position.y).toBeCloseTo(defaultCalibration.eyeHeight, 1);
  expect(asked).toEqual([]);
});

test('a replay that arrives paused while a headset is worn does not hold its wearer still', () => {
  const { recorder, wristAt } = worn();
  wristAt(10);
  recorder.load('dance.json', {
    device: 'a test',
    rateHz: 60,
    calibration: defaultCalibration,
    frames: [0, 1, 2, 3].map((time) => actorFrame(time, defaultCalibration)),
  });
  recorder.seek(2);
  recorder.setPaused(true);
  wristAt(11);
  expect(wristAt(12)).not.toEqual(wristAt(13));
  expect(recorder.mode).toBe('idle');
  expect(recorder.name).toBe('dance.json');
});
