import { describe, expect, test } from 'vitest';
import { recordingTime } from '../../../src/core/study/trial-clock';
import { parseRecording } from '../../../src/core/tracking/recording';
import { epoch, frameSeconds, playedRound } from './played-round';

describe('what scores in a round', () => {
  test.each([
    ['without a pause', () => false],
    ['that was paused for twenty seconds', (time: number) => time > 9 && time < 29],
    ['that was paused twice, once shortly', (time: number) => (time > 4 && time < 4.4) || (time > 12 && time < 15)],
  ])('%s is found among the recorded frames at the frame that showed it', (_, paused) => {
    const { outcome, recording, landed } = playedRound({ paused });
    const { frames } = parseRecording(recording ?? '');
    const { clock } = outcome;
    if (!clock) throw new Error('the outcome tells no clock');
    expect(outcome.events.length).toBeGreaterThan(3);
    for (const [index, { onset = Number.NaN }] of outcome.events.entries()) {
      const time = recordingTime(clock, onset);
      expect(time).toBeCloseTo(landed[index] ?? Number.NaN, 6);
      expect(Math.min(...frames.map((frame) => Math.abs(frame.time - time)))).toBeLessThan(frameSeconds);
    }
  });

  test('after the head was lost for three seconds too, though the game stood meanwhile', () => {
    const { outcome, landed } = playedRound({ paused: () => false, headless: (time) => time > 5 && time < 8 });
    const { clock, events } = outcome;
    if (!clock) throw new Error('the outcome tells no clock');
    const [first, last] = [events[0], events.at(-1)];
    expect(events.map(({ onset = Number.NaN }) => recordingTime(clock, onset))).toEqual(
      landed.map((time) => expect.closeTo(time, 6)),
    );
    const drift = (event: typeof first) => (event?.onset ?? Number.NaN) - (event?.time ?? Number.NaN);
    expect(drift(last) - drift(first)).toBeGreaterThan(2.9);
  });
});

test('second 0 of a round is told by the clock of the device, and every pause with its second', () => {
  const { outcome, began } = playedRound({ paused: (time) => time > 9 && time < 29 });
  expect(outcome.clock).toMatchObject({ start: began, epoch: epoch + began });
  expect(outcome.clock?.pauses).toHaveLength(1);
  const [pause] = outcome.clock?.pauses ?? [];
  expect(pause?.time).toBeCloseTo(9, 1);
  expect(pause?.seconds).toBeCloseTo(20, 1);
});
