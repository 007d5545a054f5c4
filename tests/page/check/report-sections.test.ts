import * as fc from 'fast-check';
import { expect, test } from 'vitest';
import { reportSections } from '../../../src/page/check/report-sections';
import { anyReport } from './any-report';

test('any report has a card, and each of its figures has a unit', () => {
  fc.assert(
    fc.property(anyReport, (report) => {
      const sections = reportSections(report);
      expect(sections.map(({ title }) => title.replace(' (emulated)', ''))).toEqual([
        'Device',
        'Noise at rest',
        'Lost hands',
        'Frames by world and estimator',
        'Latency',
        'Body tracking against our body',
      ]);
      for (const { lines } of sections) {
        for (const { label, value } of lines) {
          expect(label).not.toBe('');
          expect(value).not.toMatch(/NaN|undefined|null|\[object/);
        }
      }
      expect(sections[3]!.lines).toHaveLength(Math.max(1, report.frameTimes.length));
    }),
  );
});

test('losses are counted by length in words', () => {
  const [sample] = fc.sample(anyReport, { numRuns: 1, seed: 2 });
  const losses = { hand: 'left', source: 'hand', observedSeconds: 20.2, openEnd: true } as const;
  const lineOf = (lengthsMs: number[]) =>
    reportSections({ ...sample!, losses: [{ ...losses, lengthsMs }] })[2]!.lines[0]!;
  expect(lineOf([30, 120, 240, 9000])).toEqual({
    label: 'Left hand (hand)',
    value: 'Losses in 20 s: 1 up to 50 ms, 2 of 100 to 250 ms, 1 over 2000 ms; lost at the end',
  });
  expect(lineOf([]).value).toBe('Losses in 20 s: none; lost at the end');
});

test('figures have the number of their frames, and too few frames show no figure', () => {
  const [sample] = fc.sample(anyReport, { numRuns: 1, seed: 2 });
  const latency = { frames: 30, p50Ms: 3, p95Ms: 8.04 };
  const lines = (frames: number) => {
    const sections = reportSections({
      ...sample!,
      latency: { displayAhead: null, callbackDelay: { ...latency, frames } },
    });
    return sections[4]!.lines.map(({ value }) => value);
  };
  expect(lines(30)).toEqual(['not known: this browser reports no usable time', '3.0 ms, p95 8.0 ms (30 frames)']);
  expect(lines(29)[1]).toBe('too few: 29 frames');
  expect(lines(1)[1]).toBe('too few: 1 frame');
});

test('one frame rate is shown, and whether it is assumed', () => {
  const [sample] = fc.sample(anyReport, { numRuns: 1, seed: 2 });
  const lines = (rateReported: boolean) => {
    const session = { ...sample!.session, rateHz: 72, rateReported, ratesHz: [72, 90] };
    return reportSections({ ...sample!, session }).flatMap((section) => section.lines);
  };
  const withRate = (rateReported: boolean) => lines(rateReported).filter(({ value }) => / Hz/.test(value));
  expect(withRate(true)).toEqual([{ label: 'Frame rate', value: '72 Hz, offers 72, 90 Hz' }]);
  expect(withRate(false)).toEqual([{ label: 'Frame rate', value: '72 Hz (assumed), offers 72, 90 Hz' }]);
});

test('parts that were not measured give the reason and what to do', () => {
  const [sample] = fc.sample(anyReport, { numRuns: 1, seed: 2 });
  const unmeasured = [
    { tracker: 'head', frames: 900, moved: true },
    { tracker: 'left', frames: 0, moved: false },
    { tracker: 'right', frames: 70, moved: false },
  ] as const;
  const bodyTracking = { frames: 0, complaint: null, joints: null };
  const lines = (complete: boolean) =>
    reportSections({
      ...sample!,
      session: { ...sample!.session, complete },
      noise: [],
      unmeasured: [...unmeasured],
      losses: [],
      frameTimes: [],
      bodyTracking,
    }).flatMap((section, index) => (index === 0 || section.title === 'Latency' ? [] : section.lines));
  expect(lines(true)).toEqual([
    { label: 'Head', value: 'Not measured: you moved. Measure again.' },
    { label: 'Left hand', value: 'Not measured: it was not seen. Measure again.' },
    { label: 'Right hand', value: 'Not measured: too few steady frames (70 frames). Measure again.' },
    { label: 'Hands', value: 'Not measured: no hand was seen. Measure again.' },
    { label: 'Frames', value: 'Not measured: the check ended too early. Measure again.' },
    { label: 'Not compared', value: 'the device reports no body' },
  ]);
  const early = lines(false);
  expect(early).toHaveLength(6);
  for (const { value } of early) expect(value).toContain('the check ended too early');
});
