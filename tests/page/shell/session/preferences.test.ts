import fc from 'fast-check';
import { armSpanRange, eyeHeightFromStature, statureRange } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { createPreferenceStore, parsePreferences } from '../../../../src/page/shell/session/preferences';
import { evenly } from '../../../threepoint/core/arbitraries';
import { memoryStorage } from './memory-storage';

describe('the memory of the page', () => {
  test('a calibration survives a reload', () => {
    const storage = memoryStorage();
    createPreferenceStore(storage).remember({ calibration: { eyeHeight: 1.58, armSpan: 1.33 } });
    const next = createPreferenceStore(storage);
    expect(next.complaint).toBeNull();
    expect(next.preferences.calibration).toEqual({ eyeHeight: 1.58, armSpan: 1.33 });
  });

  test('remembering undefined forgets, and leaves the rest', () => {
    const storage = memoryStorage();
    const store = createPreferenceStore(storage);
    store.remember({ calibration: { eyeHeight: 1.6, armSpan: 1.3 }, mirror: false });
    store.remember({ calibration: undefined });
    expect(createPreferenceStore(storage).preferences).toEqual({ mirror: false });
  });

  test('the changes of another window of the page stay', () => {
    const storage = memoryStorage();
    const [one, other] = [createPreferenceStore(storage), createPreferenceStore(storage)];
    one.remember({ calibration: { eyeHeight: 1.58, armSpan: 1.33 } });
    other.remember({ mirror: false });
    one.remember({ sound: false });
    const learned = { mirror: false, sound: false };
    expect(createPreferenceStore(storage).preferences).toEqual({
      calibration: { eyeHeight: 1.58, armSpan: 1.33 },
      ...learned,
    });
    other.remember({ calibration: undefined });
    one.remember({ overlay: true });
    expect(createPreferenceStore(storage).preferences).toEqual({ ...learned, overlay: true });
  });

  test('a preference that a full storage did not take lasts as long as the page', () => {
    const storage = memoryStorage();
    createPreferenceStore(storage).remember({ mirror: false });
    const full = {
      ...storage,
      setItem() {
        throw new DOMException('the storage is full', 'QuotaExceededError');
      },
    };
    const store = createPreferenceStore(full);
    store.remember({ sound: false });
    store.remember({ overlay: true });
    expect(store.preferences).toEqual({ mirror: false, sound: false, overlay: true });
  });

  test('a damaged entry is replaced by what this visit knows', () => {
    const storage = memoryStorage();
    const store = createPreferenceStore(storage);
    store.remember({ mirror: false });
    for (const damaged of ['no JSON', '{"calibration":3}']) {
      storage.setItem('threepoint.preferences.1', damaged);
      store.remember({ sound: false });
      expect(createPreferenceStore(storage).preferences).toEqual({ mirror: false, sound: false });
    }
  });

  test('a first visit remembers nothing and complains of nothing', () => {
    expect(parsePreferences(null)).toEqual({ preferences: {}, complaint: null });
  });

  test('a person three metres tall is a damaged memory, said in a sentence', () => {
    const read = parsePreferences(JSON.stringify({ calibration: { eyeHeight: 3, armSpan: 1.4 } }));
    expect(read.preferences).toEqual({});
    expect(read.complaint).toMatch(/damaged \(calibration\)/);
  });

  test('reading anything that is stored throws nothing and yields no measure outside a person', () => {
    const seen = { complaints: 0, calibrations: 0 };
    fc.assert(
      fc.property(
        fc.oneof(
          fc.string(),
          fc.json(),
          fc.object().map((value) => JSON.stringify({ calibration: value })),
          fc
            .record({ eyeHeight: evenly(0.9, 2.3), armSpan: evenly(0.9, 2.3) })
            .map((calibration) => JSON.stringify({ calibration })),
        ),
        (text) => {
          const { preferences, complaint } = parsePreferences(text);
          if (complaint !== null) {
            seen.complaints += 1;
            expect(preferences).toEqual({});
          }
          const { calibration } = preferences;
          if (!calibration) return;
          seen.calibrations += 1;
          expect(calibration.eyeHeight).toBeGreaterThanOrEqual(eyeHeightFromStature(statureRange.min));
          expect(calibration.eyeHeight).toBeLessThanOrEqual(eyeHeightFromStature(statureRange.max));
          expect(calibration.armSpan).toBeGreaterThanOrEqual(armSpanRange.min);
          expect(calibration.armSpan).toBeLessThanOrEqual(armSpanRange.max);
        },
      ),
    );
    expect(seen.complaints).toBeGreaterThan(20);
    expect(seen.calibrations).toBeGreaterThan(2);
  });

  test('a choice that the browser cannot store lasts as long as the page, which says so', () => {
    const full = {
      getItem: () => null,
      setItem: () => {
        throw new DOMException('full', 'QuotaExceededError');
      },
    };
    for (const storage of [null, full]) {
      const told: string[] = [];
      const store = createPreferenceStore(storage, (sentence) => void told.push(sentence));
      store.remember({ mirror: false });
      store.remember({ sound: false });
      expect(store.preferences).toEqual({ mirror: false, sound: false });
      expect(told).toEqual([
        'This browser does not let the page store anything, so calibration and settings are lost when you close it.',
      ]);
    }
  });
});
