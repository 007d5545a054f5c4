import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import type { ProgressEvent } from '../../../src/study/model/progress/apply-event';
import {
  begin,
  clockText,
  elapsedSeconds,
  isLater,
  remainingSeconds,
  reported,
  resumed,
  sinceReport,
} from '../../../src/study/model/progress/progress';
import { checkedRecord } from '../../../src/study/model/records/study-record';
import { seed } from '../../threepoint/core/arbitraries';
import { aWomanOf26, outcomeOf, paperPlan, session } from './studies';

const schedule = scheduleFor(paperPlan(), 'P02');

/** Returns a session that has reached a step. */
function sessionAt(isReached: Parameters<ReturnType<typeof session>['doUntil']>[0]) {
  const one = session(schedule);
  one.doUntil(isReached);
  return one;
}

describe('a session', () => {
  test('runs from consent to the end and leaves what was asked for', () => {
    const one = sessionAt(({ kind }) => kind === 'end');
    const kinds = one.records.map(({ kind }) => kind);
    expect(kinds.filter((kind) => kind === 'trial')).toHaveLength(6);
    expect(kinds.filter((kind) => kind === 'answers')).toHaveLength(4);
    expect(kinds.filter((kind) => kind === 'calibration')).toHaveLength(4);
    expect(kinds[0]).toBe('consent');
    expect(one.records.at(-1)).toMatchObject({ kind: 'event', body: { type: 'finished' } });
    expect(new Set(one.records.map(({ id }) => id)).size).toBe(one.records.length);
  });

  test('makes records that the store takes', () => {
    const one = sessionAt(({ kind }) => kind === 'end');
    for (const record of one.records)
      expect(checkedRecord(JSON.parse(JSON.stringify(record)), paperPlan())).toEqual(record);
  });

  test('records nothing before consent', () => {
    const one = session(schedule);
    expect(one.tell({ type: 'demographics', demographics: aWomanOf26 })).not.toBeNull();
    expect(one.tell({ type: 'pause' })).toBeNull();
    expect(one.tell({ type: 'resume' })).toBeNull();
    expect(one.tell({ type: 'reload' })).toBeNull();
    expect(one.tell({ type: 'remark', text: 'looks tired' })).toBe('nothing is recorded before consent');
    expect(one.records).toEqual([]);
  });

  test('does not take consent to another text', () => {
    const one = session(schedule);
    expect(one.tell({ type: 'consent', version: 'old', motion: false })).toBe(
      `version: consent was given to text old, but the study shows ${schedule.consentVersion}`,
    );
    expect(one.step.kind).toBe('consent');
  });

  test('takes no event out of place', () => {
    const one = sessionAt(({ kind }) => kind === 'trial');
    const before = one.progress;
    const outOfPlace: ProgressEvent[] = [
      { type: 'submit' },
      { type: 'answer', question: 'Q1', value: 3 },
      { type: 'trial-finished', outcome: outcomeOf() },
      { type: 'resume' },
      { type: 'calibrated', calibration: { eyeHeight: 1.6, armSpan: 1.5 } },
    ];
    for (const event of outOfPlace) expect(one.tell(event)).not.toBeNull();
    expect(one.progress).toEqual(before);
  });
});

describe('a rest', () => {
  const resting = () => sessionAt(({ kind }) => kind === 'rest');

  test('takes sixty seconds, not one less', () => {
    const one = resting();
    expect(remainingSeconds(schedule, one.progress, one.now)).toBe(60);
    one.wait(59.9);
    one.tell({ type: 'tick' });
    expect(one.step.kind).toBe('rest');
    one.wait(0.1);
    one.tell({ type: 'tick' });
    expect(one.step.kind).toBe('questionnaire');
  });

  test('goes on while the page is loaded again', () => {
    const one = resting();
    one.wait(30);
    const stored = JSON.stringify(one.progress);
    one.wait(20);
    one.progress = resumed(schedule, stored);
    one.tell({ type: 'reload' });
    expect(remainingSeconds(schedule, one.progress, one.now)).toBeCloseTo(10, 6);
  });

  test('stands while the experimenter pauses', () => {
    const one = resting();
    one.wait(10);
    one.tell({ type: 'pause' });
    one.wait(3600);
    one.tell({ type: 'tick' });
    expect(one.step.kind).toBe('rest');
    expect(remainingSeconds(schedule, one.progress, one.now)).toBeCloseTo(50, 6);
    one.tell({ type: 'resume' });
    one.wait(50);
    one.tell({ type: 'tick' });
    expect(one.step.kind).toBe('questionnaire');
  });

  test('does not end sooner because the clock was set back', () => {
    const one = resting();
    one.wait(-7200);
    expect(elapsedSeconds(one.progress, one.now)).toBe(0);
    expect(remainingSeconds(schedule, one.progress, one.now)).toBe(60);
  });

  test.each(['tick', 'reload'] as const)('goes on from the next %s after the clock was set back', (type) => {
    const one = resting();
    one.wait(-7200);
    one.tell({ type });
    one.wait(59);
    one.tell({ type: 'tick' });
    expect(one.step.kind).toBe('rest');
    one.wait(1);
    one.tell({ type: 'tick' });
    expect(one.step.kind).toBe('questionnaire');
  });
});

test.each([
  [0, '0:00'],
  [0.2, '0:01'],
  [59.5, '1:00'],
  [60, '1:00'],
  [60.2, '1:01'],
  [119.99, '2:00'],
])('%d seconds left read %s: a second that has begun counts whole', (seconds, said) => {
  expect(clockText(seconds)).toBe(said);
});

describe('a rest that another device goes on with', () => {
  const reportedAfter = (seconds: number) => {
    const one = sessionAt(({ kind }) => kind === 'rest');
    one.wait(seconds);
    return { one, told: resumed(schedule, JSON.stringify(reported(one.progress, one.now))) };
  };

  test.each([-600, 0, 600])('takes what is left of its sixty seconds where that clock is %d s ahead', (ahead) => {
    const { one, told } = reportedAfter(20);
    one.progress = told;
    one.wait(ahead);
    one.tell({ type: 'reload' });
    expect(one.step.kind).toBe('rest');
    expect(remainingSeconds(schedule, one.progress, one.now)).toBeCloseTo(40, 6);
    one.wait(40);
    one.tell({ type: 'tick' });
    expect(one.step.kind).toBe('questionnaire');
  });

  test('went on meanwhile', () => {
    const { one, told } = reportedAfter(20);
    one.progress = sinceReport(told, 15);
    one.tell({ type: 'reload' });
    expect(remainingSeconds(schedule, one.progress, one.now)).toBeCloseTo(25, 6);
  });

  test('stands in a pause', () => {
    const { one } = reportedAfter(20);
    one.tell({ type: 'pause' });
    one.progress = sinceReport(reported(one.progress, one.now), 15);
    one.tell({ type: 'reload' });
    one.wait(300);
    expect(remainingSeconds(schedule, one.progress, one.now)).toBeCloseTo(40, 6);
    one.tell({ type: 'resume' });
    expect(remainingSeconds(schedule, one.progress, one.now)).toBeCloseTo(40, 6);
  });
});

describe('a questionnaire', () => {
  const asked = () => sessionAt(({ kind }) => kind === 'questionnaire');

  test('goes on after a reload with the answers given so far', () => {
    const one = asked();
    one.tell({ type: 'answer', question: 'Q1', value: 5 });
    one.tell({ type: 'answer', question: 'Q2', value: 2 });
    one.progress = resumed(schedule, JSON.stringify(one.progress));
    one.tell({ type: 'reload' });
    expect(one.step.kind).toBe('questionnaire');
    expect(one.progress.draft).toEqual({ Q1: 5, Q2: 2 });
  });

  test('lets an answer be changed and hands in the last one', () => {
    const one = asked();
    one.tell({ type: 'answer', question: 'Q1', value: 5 });
    one.tell({ type: 'answer', question: 'Q1', value: 1 });
    for (const id of ['Q2', 'Q3', 'Q4', 'Q5', 'Q6', 'Q7']) one.tell({ type: 'answer', question: id, value: 3 });
    expect(one.tell({ type: 'submit' })).toBeNull();
    expect(one.records.at(-1)).toMatchObject({ kind: 'answers', body: { answers: { Q1: 1, Q7: 3 }, overtime: false } });
  });

  test('is not handed in with a question open', () => {
    const one = asked();
    one.tell({ type: 'answer', question: 'Q1', value: 5 });
    expect(one.tell({ type: 'submit' })).toBe('Q2: this question has no answer');
    expect(one.step.kind).toBe('questionnaire');
  });

  test('may take longer than seven minutes, and that is recorded', () => {
    const one = asked();
    one.wait(421);
    expect(remainingSeconds(schedule, one.progress, one.now)).toBe(0);
    one.doStep();
    expect(one.records.at(-1)).toMatchObject({ kind: 'answers', body: { overtime: true } });
  });
});

describe('a questionnaire that stands behind the question whether to stop', () => {
  const plan = paperPlan({ askToStop: [{ questionnaire: 'archery', measure: 'Q2', atLeast: 4 }] });
  const tasks = plan.tasks.map((task) => ({ ...task, questionnaire: ['archery', 'nasa-tlx-raw'] }));
  const asked = () => {
    const one = session(scheduleFor({ ...plan, tasks }, 'P02'));
    one.doUntil(({ kind }) => kind === 'questionnaire');
    one.doStep(4);
    expect(one.progress.unwell).toBe(true);
    expect(one.step.id).toBe('archery/1/questionnaire-2');
    return one;
  };
  const secondsOf = (one: ReturnType<typeof asked>) =>
    one.records.flatMap((record) => (record.kind === 'answers' ? [record.body.seconds] : []));

  test('takes its time from its first question on, not from that one', () => {
    const one = asked();
    one.wait(300);
    one.tell({ type: 'go-on' });
    one.doStep(4);
    // One second before the first answer, five for each of six.
    expect(secondsOf(one)).toEqual([36, 31]);
  });

  test('also where the session is paused meanwhile', () => {
    const one = asked();
    one.wait(300);
    one.tell({ type: 'pause' });
    one.tell({ type: 'go-on' });
    one.wait(300);
    one.tell({ type: 'resume' });
    one.doStep(4);
    expect(secondsOf(one)).toEqual([36, 31]);
  });
});

describe('a trial', () => {
  const playing = () => {
    const one = sessionAt(({ kind }) => kind === 'trial');
    one.tell({ type: 'start' });
    return one;
  };

  test('is noted and tried again after a reload interrupts it', () => {
    const one = playing();
    one.progress = resumed(schedule, JSON.stringify(one.progress));
    one.tell({ type: 'reload' });
    expect(one.records.at(-1)).toMatchObject({
      body: { type: 'interrupted', step: 'archery/1/trial-1', place: { attempt: 1 } },
    });
    expect(one.progress.running).toBe(false);
    one.doStep();
    expect(one.records.at(-1)).toMatchObject({ kind: 'trial', body: { place: { attempt: 2 } } });
  });

  test('knows its condition, order, group and attempt', () => {
    const one = playing();
    one.tell({ type: 'trial-finished', outcome: outcomeOf(35) });
    const trial = schedule.steps.find(({ kind }) => kind === 'trial');
    expect(one.records.at(-1)).toMatchObject({
      kind: 'trial',
      body: {
        place: { task: 'archery', block: 1, run: 1, attempt: 1 },
        condition: trial?.kind === 'trial' && trial.condition,
        group: 2,
        outcome: { score: 35 },
      },
    });
  });

  test('leaves a rest whose clock stands when it ends while paused', () => {
    const one = playing();
    one.tell({ type: 'pause' });
    expect(one.tell({ type: 'trial-finished', outcome: outcomeOf() })).toBeNull();
    one.wait(600);
    expect(remainingSeconds(schedule, one.progress, one.now)).toBe(60);
  });
});

describe('a voided block', () => {
  test('starts again with its calibration, under a new run, and the first run is named', () => {
    const one = sessionAt(({ id }) => id === 'archery/2/questionnaire');
    expect(one.tell({ type: 'void-block', reason: 'controller died', repeat: true })).toBeNull();
    expect(one.records.at(-1)).toMatchObject({
      body: { type: 'void-block', task: 'archery', block: 2, run: 1, reason: 'controller died' },
    });
    expect(one.step.id).toBe('archery/2/calibration');
    one.doUntil(({ kind }) => kind === 'end');
    const runs = one.records.flatMap((record) =>
      record.kind === 'trial' && record.body.place.task === 'archery' && record.body.place.block === 2
        ? [record.body.place.run]
        : [],
    );
    expect(runs).toEqual([1, 2]);
    expect(new Set(one.records.map(({ id }) => id)).size).toBe(one.records.length);
  });

  test('is the one that was meant: a participant who has moved on loses no other', () => {
    const one = sessionAt(({ id }) => id === 'archery/2/calibration');
    const of = { task: 'archery', block: 1 };
    const late = { type: 'void-block', reason: 'controller died', repeat: true, of } as const;
    expect(one.tell(late)).toBe('block 1 of "archery", which the command is for, is not under way');
    expect(one.step.id).toBe('archery/2/calibration');
    expect(one.tell({ ...late, of: { ...of, block: 2 } })).toBeNull();
    expect(one.step.id).toBe('archery/2/calibration');
    expect(one.progress.runs).toEqual({ 'archery/2': 2 });
  });

  test('is left behind without a repetition', () => {
    const one = sessionAt(({ id }) => id === 'archery/1/trial-1');
    one.tell({ type: 'void-block', reason: 'unwell', repeat: false });
    expect(one.step.id).toBe('archery/2/calibration');
  });

  test('is repeated without the practice that was finished in it, and with an unfinished one', () => {
    const one = session(schedule);
    const repeat = { type: 'void-block', reason: 'wrong avatar', repeat: true } as const;
    one.doUntil(({ id }) => id === 'archery/1/tutorial');
    one.tell(repeat);
    const kinds = () => {
      const met: string[] = [];
      one.doUntil((step) => {
        met.push(step.kind);
        return step.kind === 'trial';
      });
      return met;
    };
    expect(kinds()).toEqual(['calibration', 'tutorial', 'trial']);
    one.tell(repeat);
    expect(kinds()).toEqual(['calibration', 'trial']);
    one.progress = resumed(schedule, JSON.stringify(one.progress));
    one.tell(repeat);
    expect(kinds()).toEqual(['calibration', 'trial']);
  });

  test('needs a reason', () => {
    const one = sessionAt(({ id }) => id === 'archery/1/trial-1');
    expect(one.tell({ type: 'void-block', reason: ' ', repeat: true })).toContain('expected text');
  });
});

describe('the clock of a match', () => {
  const playing = () => {
    const one = session(schedule);
    one.doUntil(({ id }) => id === 'ball/1/trial-1');
    one.tell({ type: 'start' });
    return one;
  };
  const left = (one: ReturnType<typeof playing>) => remainingSeconds(schedule, one.progress, one.now);

  test('is that of the group: it waits, runs and stands with the match', () => {
    const one = playing();
    one.tell({ type: 'match-clock', runs: false, second: 0 });
    one.wait(40);
    expect(left(one)).toBe(90);
    one.tell({ type: 'match-clock', runs: true, second: 0 });
    one.wait(30);
    expect(left(one)).toBeCloseTo(60, 6);
    one.tell({ type: 'match-clock', runs: false, second: 29.5 });
    one.wait(100);
    expect(left(one)).toBeCloseTo(60.5, 6);
    expect(sinceReport(reported(one.progress, one.now), 20).elapsed).toBeCloseTo(29.5, 6);
    one.tell({ type: 'pause' });
    one.tell({ type: 'resume' });
    one.wait(10);
    expect(left(one)).toBeCloseTo(60.5, 6);
    one.tell({ type: 'match-clock', runs: true, second: 29.5 });
    one.tell({ type: 'trial-finished', outcome: outcomeOf() });
    expect(one.progress.waiting).toBe(false);
  });

  test('does not run before its trial is started, which a finished group leaves behind', () => {
    const one = session(schedule);
    one.doUntil(({ id }) => id === 'ball/1/trial-1');
    expect(one.tell({ type: 'match-clock', runs: true, second: 0 })).not.toBeNull();
    expect(one.tell({ type: 'missed' })).toBeNull();
    expect(one.step.id).toBe('ball/1/rest');
    expect(one.records.at(-1)).toMatchObject({ body: { type: 'missed', step: 'ball/1/trial-1' } });
  });

  test('stands in a pause whose record names its author', () => {
    const one = playing();
    one.tell({ type: 'pause' });
    one.tell({ type: 'resume', by: 'experimenter' });
    expect(one.records.slice(-2).map(({ body }) => body)).toEqual([
      { type: 'pause', by: 'participant' },
      { type: 'resume', by: 'experimenter' },
    ]);
  });
});

describe('a stored session', () => {
  test('is whole again after a crash at any step', () => {
    fc.assert(
      fc.property(fc.integer({ min: 0, max: 21 }), fc.boolean(), (steps, started) => {
        const straight = session(schedule);
        const crashed = session(schedule);
        for (let i = 0; i < steps; i++) {
          straight.doStep();
          crashed.doStep();
        }
        if (started) crashed.tell({ type: 'start' });
        crashed.progress = resumed(schedule, JSON.stringify(crashed.progress));
        crashed.tell({ type: 'reload' });
        expect(crashed.step).toEqual(straight.step);
        for (const one of [straight, crashed]) one.doUntil(({ kind }) => kind === 'end');
        const asked = (one: typeof straight) =>
          one.records.filter(({ kind }) => kind !== 'event').map(({ id }) => id.replace(/\.\d+:/, ':'));
        expect(asked(crashed)).toEqual(asked(straight));
      }),
      { seed },
    );
  });

  test.each<[string, object, string]>([
    ['of another participant', { participant: 'P03' }, 'participant: the stored session is of P03, not of P02'],
    ['of another study', { study: 'other' }, 'study: the stored session is of other, not of paper'],
    ['at a step that is none', { step: 'archery/9/trial-1' }, 'step: the schedule of P02 has no step'],
    ['of a later program', { version: 2 }, 'version: expected 1'],
    ['with a broken clock', { since: 'noon' }, 'since: '],
  ])('%s is refused', (_, change, message) => {
    expect(() => resumed(schedule, JSON.stringify({ ...begin(schedule), ...change }))).toThrow(message);
  });

  test('is later than one at an earlier step, and later still once its block is voided', () => {
    const one = session(schedule);
    const early = one.progress;
    one.doUntil(({ kind }) => kind === 'questionnaire');
    const late = one.progress;
    expect(isLater(schedule, late, early)).toBe(true);
    expect(isLater(schedule, early, late)).toBe(false);
    expect(isLater(schedule, late, late)).toBe(false);
    one.tell({ type: 'void-block', reason: 'the phone rang', repeat: true });
    expect(isLater(schedule, one.progress, late)).toBe(true);
  });

  test('is refused when it is no JSON', () => {
    expect(() => resumed(schedule, '{"version":1')).toThrow('the stored session is not JSON');
  });
});
