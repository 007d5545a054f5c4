import type { TrackingFrame } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { Recorder } from '../../../src/page/studio/recorder';
import { headFrame, trackedAt } from '../frames';

const source = { device: 'emulated headset', rateHz: 72, calibration: { eyeHeight: 1.6, armSpan: 1.4 } };

/** A head that goes right at one metre per second. */
const frameAt = (time: number): TrackingFrame => ({ ...headFrame(time, 1.6), head: trackedAt(time, 1.6, 0) });

function recorded(from: number, to: number) {
  const recorder = new Recorder();
  recorder.record(source);
  for (let time = from; time < to; time += 1 / 64) recorder.observe(frameAt(time));
  recorder.stop();
  return recorder;
}

describe('the recorder', () => {
  test('keeps nothing before it is asked to', () => {
    const recorder = new Recorder();
    recorder.observe(frameAt(1));
    expect([recorder.name, recorder.file(), recorder.frameCount]).toEqual([null, null, 0]);
    recorder.replay();
    expect(recorder.sample(5)).toBeNull();
  });

  test('a recording is replayed at the viewer’s time', () => {
    const recorder = recorded(10, 12);
    recorder.replay();
    expect(recorder.sample(100)?.head.position.x).toBeCloseTo(10, 6);
    const later = recorder.sample(101.25);
    expect(later?.time).toBe(101.25);
    expect(later?.head.position.x).toBeCloseTo(11.25, 6);
  });

  test('a replay begins anew at its end, or ends', () => {
    const recorder = recorded(0, 1);
    recorder.replay();
    recorder.sample(50);
    expect(recorder.sample(51.5)?.head.position.x).toBeCloseTo(0, 6);
    recorder.setLoop(false);
    expect(recorder.sample(53)).toBeNull();
    expect(recorder.mode).toBe('idle');
  });

  test('reports its end where no one stopped it: a replay is over, a recording is full', () => {
    let ends = 0;
    const recorder = new Recorder(() => {
      ends += 1;
    });
    recorder.setLoop(false);
    recorder.record(source);
    for (let frame = 0; frame < 64; frame++) recorder.observe(frameAt(frame / 64));
    recorder.stop();
    recorder.replay();
    recorder.sample(50);
    recorder.sample(50.5);
    expect(ends).toBe(0);
    recorder.sample(52);
    expect([ends, recorder.mode]).toEqual([1, 'idle']);
    recorder.record(source);
    for (let frame = 0; recorder.mode === 'recording'; frame++) recorder.observe(frameAt(frame / 120));
    expect([ends, recorder.frameCount]).toEqual([2, 108_000]);
  });

  test('a paused replay stands at its second while time passes, and goes on from there', () => {
    const recorder = recorded(0, 4);
    recorder.replay();
    recorder.sample(50);
    recorder.sample(51);
    recorder.setPaused(true);
    expect(recorder.sample(58)?.head.position.x).toBeCloseTo(1, 6);
    expect(recorder.sample(59)?.time).toBe(59);
    recorder.setPaused(false);
    expect(recorder.sample(59.5)?.head.position.x).toBeCloseTo(1.5, 6);
  });

  test('a replay goes on from the second that is asked for, also where none was running', () => {
    const recorder = recorded(0, 4);
    recorder.seek(3);
    expect(recorder.mode).toBe('replaying');
    expect(recorder.sample(50)?.head.position.x).toBeCloseTo(3, 6);
    expect(recorder.sample(50.5)?.head.position.x).toBeCloseTo(3.5, 6);
    recorder.seek(99);
    expect(recorder.seconds).toBe(recorder.duration);
    recorder.seek(-1);
    expect(recorder.sample(51)?.head.position.x).toBeCloseTo(0.5, 6);
  });

  test('a request made before a recording comes too late, and leaves it', () => {
    const recorder = new Recorder();
    const requestNumber = recorder.nextRequest();
    recorder.record(source);
    for (const time of [1, 2]) recorder.observe(frameAt(time));
    recorder.stop();
    const other = recorded(0, 1).recording!;
    expect(() => recorder.load('slow.json', other, requestNumber)).toThrow('a newer recording was opened');
    expect(recorder.name).toBe('recording-1.json');
    recorder.load('new.json', other, recorder.nextRequest());
    expect(recorder.name).toBe('new.json');
  });

  test('its file is read back to the bit', () => {
    const recorder = recorded(1 / 3, 1);
    const file = recorder.file();
    const other = new Recorder();
    const read = other.open('copy.json', file?.text ?? '');
    expect(read.frames.at(0)).toEqual(frameAt(1 / 3));
    expect(read).toMatchObject({ device: source.device, rateHz: source.rateHz, calibration: source.calibration });
    expect(other.file()?.text).toBe(file?.text);
  });

  test('its download never has the name of a file that was opened', () => {
    const recorder = recorded(0, 1);
    const { name, text } = recorder.file()!;
    expect(name).toBe('recording-1.json');
    for (const opened of [name, 'walk.json', 'WALK.JSON', 'walk.bvh']) {
      recorder.open(opened, text);
      expect(recorder.name).toBe(opened);
      expect(recorder.file()!.name).toBe(`${opened.replace(/\.json$/i, '')}-tracking.json`);
    }
  });

  test('a file that is no recording leaves the one at hand', () => {
    const recorder = recorded(0, 1);
    expect(() => recorder.open('photos.json', '{"photos": []}')).toThrow(/not a threepoint recording/);
    expect(recorder.name).toBe('recording-1.json');
  });

  test('a file with measures of no person is refused: nothing could replay it', () => {
    const text = recorded(0, 1).file()!.text.replace('"eyeHeight":1.6', '"eyeHeight":160');
    expect(() => new Recorder().open('cm.json', text)).toThrow(/height of 170\.94 m is outside/);
  });
});
