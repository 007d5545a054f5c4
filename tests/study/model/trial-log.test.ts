import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { checkedRecord, longestRecord } from '../../../src/study/model/records/study-record';
import {
  checkedOutcome,
  DurationStatistics,
  maxTrialEvents,
  TrialLog,
} from '../../../src/study/model/records/trial-log';
import { number, seed } from '../../threepoint/core/arbitraries';
import { completed, outcomeOf } from './studies';

const device = { name: 'Test headset', refreshRateHz: 90, input: 'controllers' } as const;
const end = { seconds: 70, ended: 'time', score: 30, maximum: 50, motionFrames: 0 } as const;

describe('durations', () => {
  test('are summed up as sorting them would', () => {
    fc.assert(
      fc.property(fc.array(number(0, 150), { minLength: 1, maxLength: 300 }), (durations) => {
        const statistics = new DurationStatistics();
        for (const ms of durations) statistics.add(ms);
        const sorted = durations.toSorted((a, b) => a - b);
        const summary = statistics.summary();
        const rank = (q: number) => sorted[Math.ceil(q * sorted.length) - 1] as number;
        expect(summary?.count).toBe(durations.length);
        expect(summary?.minMs).toBe(sorted[0]);
        expect(summary?.maxMs).toBe(sorted.at(-1));
        expect(summary?.p50Ms).toBeGreaterThan(rank(0.5) - 0.051);
        expect(summary?.p50Ms).toBeLessThan(rank(0.5) + 0.051);
        expect(summary?.p95Ms).toBeGreaterThan(rank(0.95) - 0.051);
        expect(summary?.p95Ms).toBeLessThan(rank(0.95) + 0.051);
      }),
      { seed },
    );
  });

  test('invalid ones are ignored', () => {
    const statistics = new DurationStatistics();
    statistics.add(Number.NaN);
    statistics.add(-1);
    expect(statistics.summary()).toBeNull();
  });
});

describe('the log of a trial', () => {
  test('counts frames, shots and hits', () => {
    const log = new TrialLog(device, { eyeHeight: 1.6, armSpan: 1.5 });
    log.frame({ frame: 5, inference: 0.4 }, false);
    log.frame({ frame: 15, inference: 0.6 }, true);
    log.shot();
    log.shot();
    log.event({ time: 3, type: 'hit', points: 20 });
    log.event({ time: 9, type: 'miss', points: 0 });
    log.assist('seated');
    log.assist('seated');
    const outcome = log.finish(end);
    expect(outcome).toMatchObject({ shots: 2, hits: 1, eventCount: 2, assists: ['seated'], score: 30 });
    expect(outcome.frames).toMatchObject({ count: 2, missed: 1, stages: { frame: { meanMs: 10, maxMs: 15 } } });
  });

  test('knows how often and how long a hand was lost', () => {
    const log = new TrialLog(device, null);
    const seen = { head: true, leftHand: true, rightHand: true };
    log.tracked(0, seen);
    log.tracked(1, { ...seen, leftHand: false });
    log.tracked(1.5, { ...seen, leftHand: false });
    log.tracked(2, seen);
    log.tracked(4, { ...seen, leftHand: false });
    log.tracked(4.25, seen);
    const { tracking } = log.finish(end);
    expect(tracking.leftHand).toEqual({ losses: 2, seconds: 1.25 });
    expect(tracking.rightHand).toEqual({ losses: 0, seconds: 0 });
  });

  test('stays small in a trial that does not', () => {
    const log = new TrialLog(device, null);
    for (let i = 0; i < 5000; i++) {
      log.frame({ frame: i % 30, tracking: 0.1 }, false);
      log.event({ time: i / 100, type: 'hit', points: 1 });
    }
    const outcome = log.finish(end);
    expect(outcome.events).toHaveLength(maxTrialEvents);
    expect(outcome.eventCount).toBe(5000);
    expect(outcome.hits).toBe(5000);
    expect(JSON.stringify(outcome).length).toBeLessThan(longestRecord / 2);
  });

  test.each<[string, object, string]>([
    ['a score that is none', { score: Number.NaN }, 'score: expected a number'],
    ['an unknown end', { ended: 'boredom' }, 'ended: expected arrows'],
    ['a later version', { version: 2 }, 'version: expected 1'],
    [
      'too many events',
      { events: new Array(201).fill({ time: 1, type: 'hit', points: 1 }) },
      'events: expected at most 200',
    ],
  ])('%s is refused by name', (_, change, message) => {
    expect(() => checkedOutcome({ ...outcomeOf(), ...change })).toThrow(message);
  });
});

describe('a record', () => {
  const ofKind = (kind: string) => completed().find((record) => record.kind === kind) as object;

  test.each<[string, object, string]>([
    ['consent', { body: { version: 'v', given: false, motion: false, at: 1 } }, 'body.given: nothing is recorded'],
    ['answers', { id: '../../etc' }, 'id: expected small letters'],
    ['answers', { participant: 'Anna' }, 'participant: expected P and two'],
    ['demographics', { body: { age: 5 } }, 'body.'],
    ['trial', { kind: 'diary' }, 'kind: '],
    ['event', { body: { type: 'remark', text: '' } }, 'body.text: expected text'],
  ])('%s with %o is refused by field', (kind, change, message) => {
    expect(() => checkedRecord({ ...ofKind(kind), ...change }, {})).toThrow(message);
  });

  test('with an answer left out or off the scale is refused by question', () => {
    const answers = ofKind('answers') as { body: { answers: object } };
    const changed = (change: object) => ({
      ...answers,
      body: { ...answers.body, answers: { ...answers.body.answers, ...change } },
    });
    expect(() => checkedRecord(changed({ Q3: undefined }), {})).toThrow('body.answers.Q3');
    expect(() => checkedRecord(changed({ Q3: 9 }), {})).toThrow('body.answers.Q3: expected a whole number from 1 to 5');
  });

  test('is bounded', () => {
    const trial = ofKind('trial') as { body: { outcome: object } };
    const events = Array.from({ length: 200 }, () => ({
      time: Math.PI,
      type: 'hit',
      points: 1,
      note: 'x'.repeat(400),
    }));
    const long = { ...trial, body: { ...trial.body, outcome: { ...trial.body.outcome, events } } };
    expect(() => checkedRecord(long, {})).toThrow('at most 65536 characters');
  });
});
