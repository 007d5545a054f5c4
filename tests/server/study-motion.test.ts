import { describe, expect, test } from 'vitest';
import { unpacked } from '../../server/study-motion';
import { paperPlan } from '../core/study/studies';
import { now } from './running-studies';
import { completed, opened, withPaperStudy } from './stored-studies';

describe('tracked frames', () => {
  test('are kept with consent to them alone', () => {
    const { store } = withPaperStudy();
    store.storeRecords('paper', 'P01', completed('P01'), now);
    expect(() => store.storeMotion('paper', 'P01', 'archery/1/trial-1', '{}', now)).toThrow('motion recording');
    store.storeRecords('paper', 'P02', completed('P02', { motion: true }), now);
    store.storeMotion('paper', 'P02', 'archery/1/trial-1', '{"frames":[]}', now);
    expect(store.motion('paper').map(unpacked)).toEqual([
      { participant: 'P02', trial: 'archery/1/trial-1', text: '{"frames":[]}' },
    ]);
    expect(store.deleteParticipant('paper', 'P02', 'experimenter', now).motionFiles).toBe(1);
    expect(store.motion('paper')).toEqual([]);
  });

  test('are not kept in a study that does not ask for them', () => {
    const { store } = opened();
    store.addStudy(paperPlan({ consent: { ...paperPlan().consent, motion: null } }), { simulated: false, at: now });
    store.storeRecords('paper', 'P01', completed('P01', { motion: true }), now);
    expect(() => store.storeMotion('paper', 'P01', 'archery/1/trial-1', '{}', now)).toThrow('motion recording');
  });
});
