import { Body } from 'threepoint';
import {
  type AvatarPose,
  actorFrame,
  type Buttons,
  createPageClock,
  defaultCalibration,
  nothingPressed,
  type TrackingFrame,
  unknownFingers,
} from 'threepoint/core';
import { distance } from 'threepoint/math';
import { createBallLoopbackHost } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { probeOf } from '../../../src/page/archery/archery-play';
import { createFrameLoop } from '../../../src/page/shell/frame-loop';
import { FrameTiming } from '../../../src/page/shell/session/frame-timing';
import { Recorder } from '../../../src/page/studio/recorder';
import { reportFigures } from '../../reliability/report-figures';
import { trialOf } from '../../study/participant/played-trial';
import { studiedArcher } from '../archery/studied-archer';
import { archeryPage, ballPage } from '../playing';

const frameMs = 1000 / 72;
/** The steps of the page's clock [s], each reverted 4 s later; the short ones run in the full suite only. */
const leaps = [-20, 20];
const shorterLeaps = [-5, 5];

interface Part {
  track?(time: number): { readonly frame: TrackingFrame; readonly buttons: Buttons } | null;
  observe?(frame: TrackingFrame, buttons: Buttons): void;
  skin?(pose: AvatarPose, frame: TrackingFrame): void;
  render?(time: number, frame: TrackingFrame | null): void;
}

/** Returns the page's frame loop at 72 Hz over a device whose timestamps a test can step. */
function page(part: Part) {
  let stamp = 30_000;
  let buttons = nothingPressed;
  const clock = createPageClock(() => stamp);
  const body = new Body({ estimator: 'ik', calibration: defaultCalibration, clock });
  const faults: unknown[] = [];
  const loop = createFrameLoop<never>(
    {
      track(time) {
        const performed = part.track ? part.track(time) : null;
        buttons = performed?.buttons ?? nothingPressed;
        return performed?.frame ?? actorFrame(time, defaultCalibration);
      },
      observe: (frame) => part.observe?.(frame, buttons),
      estimate: (frame) => body.update(frame),
      skin: (pose, frame) => part.skin?.(pose, frame),
      render: (time, frame) => part.render?.(time, frame),
      fail: (error) => void faults.push(error),
    },
    body,
    new FrameTiming(() => stamp),
  );
  return {
    faults,
    leap(seconds: number) {
      stamp += seconds * 1000;
    },
    run(seconds: number) {
      for (let i = 0; i < Math.round(seconds * 72); i++) {
        stamp += frameMs;
        void loop(stamp);
      }
    },
  };
}

const name = 'page time leaps by %d s, and back 4 s later';
describe.each(leaps)(name, goesOn);
describe.each(shorterLeaps)(name, { tags: ['full'] }, goesOn);

function goesOn(step: number): void {
  test('a round of archery goes on at once, both times', () => {
    const play = archeryPage();
    const { run, leap, faults } = page({
      track: (time) => play.act(time),
      observe: (frame, buttons) => void play.follow(frame, buttons),
    });
    const secondsLeft = () => (play.newest ? probeOf(play.newest).secondsLeft : Number.NaN);
    const until = (condition: () => boolean) => {
      for (let i = 0; i < 60 && !condition(); i++) run(0.25);
    };
    until(() => play.newest?.state.phase === 'running');
    expect(play.newest?.state.phase).toBe('running');
    let standing = 0;
    let leapt = 0;
    for (const by of [step, -step]) {
      leap(by);
      const before = secondsLeft();
      run(1 / 72);
      const first = before - secondsLeft();
      leapt = Math.max(leapt, first);
      run(2);
      const passed = before - secondsLeft() - first;
      standing = Math.max(standing, 2 - passed);
      expect(first).toBeGreaterThanOrEqual(0);
      expect(first).toBeLessThanOrEqual(0.53);
      expect(passed).toBeCloseTo(2, 1);
      run(2);
    }
    until(() => play.newest?.state.phase === 'over');
    expect(play.newest?.state).toMatchObject({ end: 'targets', score: 50 });
    expect(faults).toEqual([]);
    reportFigures('clock-steps', {
      [`archery, ${step} s and back`]: `stands still ${Math.abs(standing).toFixed(2)} s, first frame ${leapt.toFixed(2)} s`,
    });
  });

  test('a ball game with two built-in players goes on, theirs included', { tags: ['full'] }, () => {
    const host = createBallLoopbackHost({ seed: 5, ball: { seconds: 60 } });
    const play = ballPage(host, { bots: () => true, readyByItself: () => true, seed: 3 });
    const shown = new Map<number, number>();
    let opacity = 1;
    const { run, leap, faults } = page({
      track(time) {
        play.begin(time);
        return play.act(time);
      },
      observe(frame, buttons) {
        const seen = play.follow(frame.time, frame, buttons);
        for (const body of seen?.bodies ?? []) {
          shown.set(body.id, (shown.get(body.id) ?? 0) + 1);
          opacity = Math.min(opacity, body.opacity);
        }
      },
      skin: (pose, frame) => play.sendPose(frame.time, pose, unknownFingers),
    });
    for (let i = 0; i < 40 && play.probe()?.phase !== 'running'; i++) run(0.25);
    expect(play.probe()?.phase).toBe('running');
    run(3);
    opacity = 1;
    for (const by of [step, -step]) {
      leap(by);
      const before = play.probe()?.secondsLeft ?? Number.NaN;
      shown.clear();
      run(4);
      const passed = before - (play.probe()?.secondsLeft ?? Number.NaN);
      expect(passed).toBeGreaterThan(3.9);
      expect(passed).toBeLessThan(4.6);
      expect([...shown.values()]).toEqual([288, 288]);
      expect(opacity, 'no player becomes a ghost').toBe(1);
    }
    expect(play.probe()?.score).toBeGreaterThan(0);
    expect(faults).toEqual([]);
  });

  test('the body moves on in its own time: no hand leaps further than a frame’s motion', () => {
    let last: { readonly pose: AvatarPose; readonly time: number } | null = null;
    let furthest = 0;
    const { run, leap, faults } = page({
      skin(pose, { time }) {
        const hand = pose.leftHand;
        const before = last?.pose.leftHand;
        if (hand && before) {
          expect(time).toBeGreaterThan(last?.time ?? Number.NaN);
          furthest = Math.max(furthest, distance(hand.position, before.position) / (time - (last?.time ?? 0)));
        }
        last = { pose, time };
      },
    });
    // The actor repeats its motion every 36.8 s.
    run(38);
    const usual = furthest;
    for (const by of [step, -step]) {
      leap(by);
      run(4);
    }
    expect(furthest).toBeLessThanOrEqual(usual * 1.05);
    expect(faults).toEqual([]);
  });

  test('a recording and the log of a trial have every frame once, in order', () => {
    const recorder = new Recorder();
    const { play, runner } = studiedArcher(7);
    const trial = trialOf(runner, { seconds: 70, seed: 7 });
    recorder.record({ device: 'actor', rateHz: 72, calibration: defaultCalibration });
    let finished: ReturnType<typeof trial.follow> = null;
    const { run, leap, faults } = page({
      track: (time) => play.act(time),
      observe(frame, buttons) {
        recorder.observe(frame);
        play.follow(frame, buttons);
        runner.played();
      },
      render(time, frame) {
        finished ??= trial.follow(time, frame);
      },
    });
    run(2);
    for (const by of [step, -step]) {
      leap(by);
      run(2);
    }
    expect(recorder.frameCount).toBe(6 * 72);
    for (let i = 0; i < 400 && !finished; i++) run(0.25);
    const log = finished as unknown as NonNullable<ReturnType<typeof trial.follow>>;
    const times = log.outcome.events.map(({ time }) => time);
    expect(times).toEqual([...times].sort((a, b) => a - b));
    expect(log.outcome.events).toHaveLength(4);
    expect(log.recording).not.toBeNull();
    expect(faults).toEqual([]);
  });
}
