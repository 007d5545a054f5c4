import type { Calibration, TrackingFrame } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { createActor } from '../../../../src/page/emulator/actor';
import type { Emulator } from '../../../../src/page/emulator/emulator';
import { CalibrationControl } from '../../../../src/page/shell/input/calibration-control';
import { TrackingSource } from '../../../../src/page/shell/input/tracking-source';
import type { StageParts } from '../../../../src/page/shell/stage/stage-parts';
import { Recorder } from '../../../../src/page/studio/recorder';
import { noPointers, noSession } from '../../activity-services';
import { trackedAt } from '../../frames';
import { fake } from '../fake';

/** A person with eyes this high [m] in the posture of the guided calibration. */
const standing = (time: number, eyeHeight: number): TrackingFrame => ({
  time,
  head: trackedAt(0, eyeHeight, 0),
  leftHand: trackedAt(-0.11 * eyeHeight, 0.81 * eyeHeight, -0.35 * eyeHeight),
  rightHand: trackedAt(0.11 * eyeHeight, 0.81 * eyeHeight, -0.35 * eyeHeight),
});

/** An emulated headset that its user holds as a person of 1.6 m at the eyes stands. */
const emulatedHeadset = { read: (time) => standing(time, 1.6) } as Emulator;

/** A page at a desk whose user may be measured; it records notices and stored values. */
function page({ actor = false, emulator = null as Emulator | null } = {}) {
  const told: string[] = [];
  const remembered: Calibration[] = [];
  const recorder = new Recorder();
  const settings = { actor };
  const headset = { worn: false, emulator };
  const parts = fake<StageParts>({
    settings,
    headset,
    ...noSession,
    recorder,
    userCalibration: { calibrateForGood: (calibration: Calibration) => void remembered.push(calibration) },
    notices: { show: (_: unknown, text: string) => void told.push(text) },
    activities: { current: null, act: () => null },
    study: { run: null },
  });
  const measuring = new CalibrationControl(parts);
  const source = new TrackingSource(parts, noPointers, createActor());
  let now = 0;
  return {
    measuring,
    told,
    remembered,
    recorder,
    settings,
    /** Runs the page for this many seconds at 60 frames a second. */
    pass(seconds: number) {
      for (let frame = 0; frame < 60 * seconds; frame++) {
        now += 1 / 60;
        measuring.observe(source.read(now, undefined)!);
      }
    },
    /** Replays a person of 1.9 m at the eyes. */
    replay() {
      const frames = [0, 1, 2, 3, 4, 5, 6, 7].map((time) => standing(time, 1.9));
      recorder.load('tall.json', { device: 'a test', rateHz: 1, calibration: null, frames });
      recorder.replay();
    },
  };
}

describe('calibrating at a desk', () => {
  test('says to put a real headset on first, with the actor off, and opens no countdown', () => {
    const { measuring, told } = page();
    measuring.start();
    expect(measuring.step).toBeNull();
    expect(told).toEqual([expect.stringContaining('Enter VR first')]);
  });

  test('begins where the user moves the emulated headset, and not where the actor does', () => {
    const user = page({ emulator: emulatedHeadset });
    user.measuring.start();
    user.pass(8);
    expect(user.measuring.step?.kind).toBe('done');
    expect(user.remembered.map(({ eyeHeight }) => eyeHeight)).toEqual([expect.closeTo(1.6, 2)]);
    const watching = page({ actor: true, emulator: emulatedHeadset });
    watching.measuring.start();
    expect(watching.measuring.step).toBeNull();
    expect(watching.told).toHaveLength(1);
  });

  test('during a replay measures no one: the person in the recording is not the user', () => {
    const { measuring, told, remembered, pass, replay } = page({ emulator: emulatedHeadset });
    replay();
    measuring.start();
    pass(8);
    expect(remembered).toEqual([]);
    expect(measuring.step).toBeNull();
    expect(told).toEqual([expect.stringContaining('Stop the replay first')]);
  });

  test('ends with a sentence where a replay, or the actor, takes over while it measures', () => {
    const interrupted = page({ emulator: emulatedHeadset });
    interrupted.measuring.start();
    interrupted.pass(2);
    interrupted.replay();
    interrupted.pass(8);
    expect(interrupted.remembered).toEqual([]);
    expect(interrupted.measuring.step).toBeNull();
    expect(interrupted.told).toEqual([expect.stringContaining('Stop the replay first')]);
    const left = page({ emulator: emulatedHeadset });
    left.measuring.start();
    left.pass(2);
    left.settings.actor = true;
    left.pass(8);
    expect([left.remembered, left.measuring.step, left.told.length]).toEqual([[], null, 1]);
  });

  test('a finished calibration stays on the screen while a recording replays', () => {
    const { measuring, told, pass, replay } = page({ emulator: emulatedHeadset });
    measuring.start();
    pass(8);
    replay();
    pass(1);
    expect([measuring.step?.kind, told]).toEqual(['done', []]);
  });
});
