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
      expect(sections[3]!.lines).toHaveLength(report.frameTimes.length);
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
