import { parseRecording } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { maxMotionBytes } from '../../../src/study/model/progress/study-api';
import { recordingTime } from '../../../src/study/model/records/trial-clock';
import { epoch, frameSeconds, playedRound } from './played-round';
import { trialOf } from './played-trial';
import { OneShotGame } from './study-browser';

describe('a scoring event of a round', () => {
  test.each([
    ['without a pause', () => false],
    ['that was paused for twenty seconds', (time: number) => time > 9 && time < 29],
    ['that was paused twice, once shortly', (time: number) => (time > 4 && time < 4.4) || (time > 12 && time < 15)],
  ])('%s is found among the recorded frames at the frame that showed it', (_, paused) => {
    const { outcome, recording, landed } = playedRound({ paused });
    const { frames } = parseRecording(recording ?? '');
    const { clock } = outcome;
    if (!clock) throw new Error('the outcome has no clock');
    expect(outcome.events.length).toBeGreaterThan(3);
    for (const [index, { onset = Number.NaN }] of outcome.events.entries()) {
      const time = recordingTime(clock, onset);
      expect(time).toBeCloseTo(landed[index] ?? Number.NaN, 6);
      expect(Math.min(...frames.map((frame) => Math.abs(frame.time - time)))).toBeLessThan(frameSeconds);
    }
  });

  test('is found after a three-second loss of the head, too, which stops the game', () => {
    const { outcome, landed } = playedRound({ paused: () => false, headless: (time) => time > 5 && time < 8 });
    const { clock, events } = outcome;
    if (!clock) throw new Error('the outcome has no clock');
    const [first, last] = [events[0], events.at(-1)];
    expect(events.map(({ onset = Number.NaN }) => recordingTime(clock, onset))).toEqual(
      landed.map((time) => expect.closeTo(time, 6)),
    );
    const drift = (event: typeof first) => (event?.onset ?? Number.NaN) - (event?.time ?? Number.NaN);
    expect(drift(last) - drift(first)).toBeGreaterThan(2.9);
  });
});

test('the outcome gives a round’s second 0 and every pause by the device’s clock', () => {
  const { outcome, began } = playedRound({ paused: (time) => time > 9 && time < 29 });
  expect(outcome.clock).toMatchObject({ start: began, epoch: epoch + began });
  expect(outcome.clock?.pauses).toHaveLength(1);
  const [pause] = outcome.clock?.pauses ?? [];
  expect(pause?.time).toBeCloseTo(9, 1);
  expect(pause?.seconds).toBeCloseTo(20, 1);
});

test('a round too long for the server keeps its first frames, and the outcome counts them', {
  tags: ['full'],
}, async () => {
  const game = new OneShotGame();
  const place = { participant: 'P01', members: [], seconds: 600, afterAbsence: 'repeat' } as const;
  await game.prepare({ ...place, seat: () => Promise.reject() });
  const trial = trialOf(game, { seconds: 600 });
  // A headset's numbers have single precision and are written in double.
  const a = Math.fround(-0.123_456_7);
  const pose = { position: { x: a, y: a, z: a }, orientation: { x: a, y: a, z: a, w: Math.sqrt(1 - 3 * a * a) } };
  const hand = { ...pose, tracking: 'tracked' as const };
  const played = 39_000;
  for (let index = 0; index < played; index++) {
    const time = 345.6 + index * frameSeconds;
    expect(trial.follow(time, { time, head: hand, leftHand: hand, rightHand: hand })).toBeNull();
  }
  game.hit(10);
  const { outcome, recording } = (trial.follow(1000, null) ?? trial.conclude()) as NonNullable<
    ReturnType<typeof trial.conclude>
  >;
  expect(outcome.motionFrames).toBeLessThan(played);
  expect(outcome.motionFrames).toBeGreaterThan(30_000);
  expect(Buffer.byteLength(recording as string)).toBeLessThanOrEqual(maxMotionBytes);
  expect(parseRecording(recording as string).frames).toHaveLength(outcome.motionFrames);
});
