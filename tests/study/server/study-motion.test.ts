import { describe, expect, test } from 'vitest';
import { unpacked } from '../../../src/study/server/storage/study-motion';
import { completed, paperPlan } from '../model/studies';
import { now } from './running-studies';
import { opened, withPaperStudy } from './stored-studies';

describe('tracked frames', () => {
  test('are kept with consent to them alone', () => {
    const { store } = withPaperStudy();
    store.records.store('paper', 'P01', completed('P01'), now);
    expect(() => store.motion.store('paper', 'P01', 'archery/1/trial-1', '{}', now)).toThrow('motion recording');
    store.records.store('paper', 'P02', completed('P02', { motion: true }), now);
    store.motion.store('paper', 'P02', 'archery/1/trial-1', '{"frames":[]}', now);
    expect(store.motion.all('paper').map(unpacked)).toEqual([
      { participant: 'P02', trial: 'archery/1/trial-1', text: '{"frames":[]}' },
    ]);
    expect(store.deletion.delete('paper', 'P02', 'experimenter', now).motionFiles).toBe(1);
    expect(store.motion.all('paper')).toEqual([]);
  });

  test('are not kept in a study that does not ask for them', () => {
    const { store } = opened();
    store.plans.add(paperPlan({ consent: { ...paperPlan().consent, motion: null } }), { simulated: false, at: now });
    store.records.store('paper', 'P01', completed('P01', { motion: true }), now);
    expect(() => store.motion.store('paper', 'P01', 'archery/1/trial-1', '{}', now)).toThrow('motion recording');
  });
});
