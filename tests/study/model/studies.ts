import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { writeRecording } from 'threepoint/core';
import { parsePlan, readPlan, type StudyPlan } from '../../../src/study/model/plan/plan';
import { type Schedule, type StudyStep, scheduleFor } from '../../../src/study/model/plan/schedule';
import { applyEvent, type ProgressEvent } from '../../../src/study/model/progress/apply-event';
import { begin, currentStep, type Progress } from '../../../src/study/model/progress/progress';
import type { Answer, AnswerForm } from '../../../src/study/model/questionnaires/question-kind';
import { questionKind } from '../../../src/study/model/questionnaires/question-kinds';
import { recordVersion, type StudyRecord } from '../../../src/study/model/records/study-record';
import { TrialLog, type TrialOutcome } from '../../../src/study/model/records/trial-log';
import { noEffects, simulateStudy } from '../../../src/study/simulation/simulate-study';

const shippedFile = (name: string): string =>
  readFileSync(fileURLToPath(new URL(`../../../public/studies/${name}.json`, import.meta.url)), 'utf8');

export const paperFile = shippedFile('paper');

/** The shipped study, with changes; other tasks or conditions leave out its hypotheses, which are about its own. */
export function paperPlan(changes: Partial<StudyPlan> = {}): StudyPlan {
  const { hypotheses = [], ...plan } = parsePlan(paperFile, 'paper.json');
  return { ...plan, ...(!changes.tasks && !changes.conditions && { hypotheses }), ...changes };
}

/** Returns a copy of a plan with another value at a path, as `tasks.0.title.de`; undefined removes the field. */
export function planWith(plan: object, path: string, value: unknown): unknown {
  const copy = structuredClone(plan);
  const keys = path.split('.');
  const last = keys.pop() as string;
  // biome-ignore lint/suspicious/noExplicitAny: reason: a file from outside may hold anything
  const parent = keys.reduce((part: any, key) => part[key], copy);
  if (value === undefined) delete parent[last];
  else parent[last] = value;
  return copy;
}

/** Returns the record of a participant of the paper's study who consented, without motion, at this time. */
export const consentAt = (at: number, participant = 'P01'): StudyRecord => ({
  ...{ version: recordVersion, study: 'paper', participant, simulated: false, at, kind: 'consent', id: 'consent' },
  body: { version: paperPlan().consent.version, given: true, motion: false, at },
});

export const aWomanOf26 = {
  gender: 'woman',
  age: 26,
  major: 'Computer science',
  vrExperience: 'once-or-twice',
  vrSystems: '',
  handedness: 'right',
  vision: 'corrected',
} as const;

export function outcomeOf(score = 40): TrialOutcome {
  const log = new TrialLog({ name: 'Test headset', refreshRateHz: 72, input: 'controllers' }, null);
  log.frame({ frame: 6.5, inference: 0.4 }, false);
  log.shot();
  log.event({ time: 3.5, type: 'hit', points: 10 });
  return log.finish({ seconds: 42, ended: 'arrows', score, maximum: 50, motionFrames: 0 });
}

/** The shipped example, which asks questions of every kind in two languages. */
export const examplePlan = (): StudyPlan => parsePlan(shippedFile('example'), 'example.json');

/** The second shipped study: three latencies, questionnaires on the body and on the work load. */
export const latencyPlan = (changes: Partial<StudyPlan> = {}): StudyPlan => ({
  ...parsePlan(shippedFile('latency'), 'latency.json'),
  ...changes,
});

/** Returns the answer that is nearest to this number, the first option, or the number as text. */
function answerFor(form: AnswerForm, value: number): Answer {
  const kind = questionKind(form);
  const range = kind.range(form);
  if (!range) return kind.options(form)?.[0] ?? `${value}`;
  const [from, to] = range;
  return kind.simulate(form, Math.min(1, Math.max(0, (value - from) / (to - from))), () => 0);
}

/** The third shipped study: three bodies and hands alone. */
export const threeBodiesPlan = (): StudyPlan => parsePlan(shippedFile('three-bodies'), 'three-bodies.json');

/** Returns the records of a complete session; `motion` is the consent to recordings. */
export function completed(
  participant = 'P01',
  { plan = paperPlan(), simulated = false, motion = false } = {},
): StudyRecord[] {
  const schedule = scheduleFor(plan, participant);
  const one = session(schedule, simulated);
  one.tell({ type: 'consent', version: schedule.consentVersion, motion });
  one.doUntil(({ kind }) => kind === 'end');
  return one.records;
}

/** A recording of one frame, in which the hands are not seen. */
export const shortRecording = writeRecording({
  ...{ device: 'Test headset', rateHz: 72, calibration: null },
  frames: [
    {
      time: 1,
      head: { position: { x: 0, y: 1.6, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' },
      leftHand: null,
      rightHand: null,
    },
  ],
});

/** Returns the records of a simulated study; the same seed gives the same ones. */
export const simulatedRecords = (plan: StudyPlan, effects = noEffects, seed = 5): StudyRecord[] =>
  simulateStudy(plan, effects, seed, 1e9).flatMap(({ records }) => records);

/** Returns the progress of a participant who has only just begun. */
export const begun = (plan: StudyPlan, participant: string): Progress => begin(scheduleFor(plan, participant));

/** A session that is driven by events, with a clock that the test sets. */
export function session(schedule: Schedule, simulated = false) {
  let progress = begin(schedule, simulated);
  let now = 1_800_000_000;
  const records: StudyRecord[] = [];
  return {
    get progress() {
      return progress;
    },
    set progress(restored: Progress) {
      progress = restored;
    },
    get step(): StudyStep {
      return currentStep(schedule, progress);
    },
    get now() {
      return now;
    },
    records,
    wait(seconds: number) {
      now += seconds;
    },
    /** Applies an event; returns the refusal, or null. */
    tell(event: ProgressEvent): string | null {
      const next = applyEvent(schedule, progress, event, now);
      progress = next.progress;
      records.push(...next.records);
      return next.rejection?.message ?? null;
    },
    /** Completes the present step; every question gets the same answer. */
    doStep(answer = 4, score = 40): void {
      const step = currentStep(schedule, progress);
      const tell = (event: ProgressEvent) => {
        const refusal = this.tell(event);
        if (refusal) throw new Error(`${step.id}: ${refusal}`);
      };
      now += 1;
      if (step.kind === 'consent') tell({ type: 'consent', version: schedule.consentVersion, motion: false });
      else if (step.kind === 'demographics') tell({ type: 'demographics', demographics: aWomanOf26 });
      else if (step.kind === 'calibration') tell({ type: 'calibrated', calibration: { eyeHeight: 1.6, armSpan: 1.5 } });
      else if (step.kind === 'tutorial' || step.kind === 'trial') {
        tell({ type: 'start' });
        now += 42;
        tell({ type: 'trial-finished', outcome: outcomeOf(score) });
      } else if (step.kind === 'rest') {
        now += step.seconds;
        tell({ type: 'tick' });
      } else if (step.kind === 'questionnaire') {
        for (const { id, answer: form } of step.questionnaire.questions) {
          now += 5;
          tell({ type: 'answer', question: id, value: answerFor(form, answer) });
        }
        tell({ type: 'submit' });
      }
    },
    doUntil(found: (step: StudyStep) => boolean): void {
      for (let steps = 0; steps < 200; steps++) {
        const step = currentStep(schedule, progress);
        if (found(step)) return;
        if (step.kind === 'end') throw new Error('the study ended before that');
        this.doStep();
      }
      throw new Error('the study does not end');
    },
  };
}

/** Returns the faults in the text of a plan's file, each with file, field and reason. */
export function planComplaints(json: string, file: string): readonly string[] {
  const read = readPlan(json, file);
  return 'problems' in read ? read.problems.map(({ message }) => message) : [];
}
