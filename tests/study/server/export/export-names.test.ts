import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { exportName, motionPath } from '../../../../src/study/server/export/export-zip';
import { seed } from '../../../threepoint/core/arbitraries';
import { paperPlan } from '../../model/studies';

/** Texts that are close to each other: separators, case, accents in both normal forms, dots and devices. */
const part = fc.constantFrom(
  'a',
  'A',
  'b',
  '/',
  '-',
  '_',
  '.',
  ':',
  '@',
  '%',
  '%2f',
  '~',
  ' ',
  '\u00e9',
  'e\u0301',
  'con',
  'nul.',
  '\u212a',
);
const identifier = fc.oneof(
  fc.array(part, { minLength: 1, maxLength: 6 }).map((parts) => parts.join('')),
  fc.string({ unit: 'binary', minLength: 1, maxLength: 12 }),
  fc.constantFrom('x', ':').map((unit) => unit.repeat(300)),
);
const participant = fc.constantFrom('P01', 'P1', 'P010');
const recording = fc.record({ participant, trial: identifier });

/** Returns a path as a file system without case and with one normal form of accents compares it. */
const compared = (path: string): string => path.normalize('NFKD').toLowerCase();

const isPortable = (name: string): boolean =>
  name.length <= 255 && !/[<>:"|?*\\/\p{Cc}]|[. ]$|^(con|prn|aux|nul|com\d|lpt\d)(\.|$)/iu.test(name);

describe('the files of an export', () => {
  test('have different paths for different recordings, on every file system', () => {
    expect(motionPath({ participant: 'P01', trial: 'a/b' })).not.toBe(motionPath({ participant: 'P01', trial: 'a-b' }));
    fc.assert(
      fc.property(recording, recording, (one, other) => {
        const [path, second] = [motionPath(one), motionPath(other)];
        expect(path.split('/').every(isPortable), path).toBe(true);
        const same = one.participant === other.participant && one.trial === other.trial;
        expect(compared(path) === compared(second), `${path} and ${second}`).toBe(same);
      }),
      { seed, numRuns: 2000 },
    );
  });

  test('stand in a folder that every file system can create', () => {
    for (const id of ['con', 'aux', 'nul', 'com1', 'lpt9', 'latency']) {
      const name = exportName({ plan: { ...paperPlan(), id }, simulated: false });
      expect(isPortable(name), name).toBe(true);
    }
    expect(exportName({ plan: { ...paperPlan(), id: 'latency' }, simulated: false })).toBe('latency');
  });
});
