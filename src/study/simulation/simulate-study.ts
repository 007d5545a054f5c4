import { ValidationError } from 'threepoint/core';
import { type GameDescription, games } from 'threepoint-games/all';
import type { LocalizedText } from '../model/phrases/localized-text';
import { participantsOf, type StudyPlan, type StudyTask } from '../model/plan/plan';
import { type PlayedStep, type Schedule, type StudyStep, scheduleFor } from '../model/plan/schedule';
import { applyEvent, type ProgressEvent } from '../model/progress/apply-event';
import { begin, currentStep, type Progress, resumed } from '../model/progress/progress';
import type { Demographics } from '../model/records/demographics';
import type { StudyRecord } from '../model/records/study-record';
import type { TrialOutcome } from '../model/records/trial-log';
import { drawAnswers, drawPerson } from './answer-model';
import { drawPlayer, drawShared, drawTargets, type Player } from './performance-model';
import { type RandomSource, randomSource } from './random-source';

/** The effects in a simulated study, by the id of a condition or a cohort. */
export interface StatedEffects {
  /** The effect on answers in points of a scale from 1 to 5, stretched to each question's scale. */
  readonly answers: Readonly<Record<string, number>>;
  /** The effect on the chance to hit or catch. */
  readonly scores: Readonly<Record<string, number>>;
}

export const noEffects: StatedEffects = { answers: {}, scores: {} };

/** The effect of the second and later blocks on the chance to hit or catch. */
const practiceEffect = 0.02;

/** The chance per trial of a reload, and per block of being voided. */
const mishaps = { reload: 0.05, voided: 0.02 };

/** Throws a ValidationError if the plan has no condition or cohort of an effect. */
export function rejectUnknownEffects(
  { conditions, cohorts = [] }: StudyPlan,
  { answers, scores }: StatedEffects,
): void {
  const known = [...conditions, ...cohorts].map(({ id }) => id);
  const unknown = [...Object.keys(answers), ...Object.keys(scores)].find((id) => !known.includes(id));
  if (unknown === undefined) return;
  throw new ValidationError(
    'effect',
    `there is no condition or cohort "${unknown}": expected one of ${known.join(', ')}`,
  );
}

/** Describes the effects: 'answers +0.5 points under "late-100".', or that there are none. */
export function effectsInWords({ answers, scores }: StatedEffects): string {
  const signed = (value: number) => `${value < 0 ? '−' : '+'}${Math.abs(value)}`;
  const parts = [
    ...Object.entries(answers).map(([id, value]) => `answers ${signed(value)} points under "${id}"`),
    ...Object.entries(scores).map(([id, value]) => `chances to hit ${signed(value)} under "${id}"`),
  ];
  return parts.length === 0 ? 'no effect: an analysis that finds one is wrong.' : `${parts.join('; ')}.`;
}

/** The session of a simulated participant. */
export interface SimulatedParticipant {
  readonly participant: string;
  readonly progress: Progress;
  readonly records: readonly StudyRecord[];
}

const marked = (title: string): string => `SIMULATED: ${title}`.slice(0, 120);

const markedInEachLanguage = (title: LocalizedText): LocalizedText =>
  typeof title === 'string'
    ? marked(title)
    : Object.fromEntries(Object.entries(title).map(([language, text]) => [language, marked(text)]));

/** The purpose of a simulated copy of a study: simulated participants, or an experimenter's own test of the plan. */
export type CopyPurpose = 'simulated' | 'try';

/** Returns the plan under an id and a title that mark it as simulated. */
export const simulatedPlan = (plan: StudyPlan, purpose: CopyPurpose = 'simulated'): StudyPlan => ({
  ...plan,
  id: `${plan.id.slice(0, 37)}-${purpose}`,
  title: markedInEachLanguage(plan.title),
});

const drawOneOf = <T>(random: RandomSource, options: readonly T[]): T =>
  options[Math.floor(random.uniform() * options.length)] as T;

const drawDemographics = (random: RandomSource): Demographics => ({
  gender: drawOneOf(random, ['woman', 'man', 'non-binary', 'not-said']),
  age: Math.min(60, Math.max(18, Math.round(26 + 4 * random.normal()))),
  major: 'Simulated',
  vrExperience: drawOneOf(random, ['none', 'once-or-twice', 'several-times', 'monthly', 'weekly']),
  vrSystems: '',
  handedness: random.uniform() < 0.85 ? 'right' : 'left',
  vision: drawOneOf(random, ['normal', 'corrected']),
});

type QuestionnaireStep = Extract<StudyStep, { kind: 'questionnaire' }>;

/** Seconds between the starts of two participants. */
const slotSeconds = 7200;
/** Guards against a schedule that never ends. */
const maxSteps = 10_000;

/** A simulated study; the same plan, effects and seed give the same one. */
interface Simulation {
  readonly plan: StudyPlan;
  readonly effects: StatedEffects;
  readonly seed: number;
}

/**
 * Yields the simulated participants of a whole study one after the other. They use the same sessions as people, with
 * reloads in the middle of trials and voided blocks. `at` is the start of the first one [s since 1970]. Throws a
 * ValidationError if the plan has no condition or cohort of an effect.
 */
export function* simulatedParticipants(
  plan: StudyPlan,
  effects: StatedEffects,
  seed: number,
  at: number,
): Generator<SimulatedParticipant> {
  rejectUnknownEffects(plan, effects);
  for (const [index, participant] of participantsOf(plan).entries()) {
    yield new SimulatedSession({ plan, effects, seed }, participant, at + index * slotSeconds).run();
  }
}

export const simulateStudy = (...study: Parameters<typeof simulatedParticipants>): readonly SimulatedParticipant[] => [
  ...simulatedParticipants(...study),
];

const effectUnder = (effects: Readonly<Record<string, number>>, ids: readonly (string | null)[]): number =>
  ids.reduce((sum, id) => sum + (id === null ? 0 : (effects[id] ?? 0)), 0);

/** Simulates a participant from consent to the end. */
class SimulatedSession {
  readonly #simulation: Simulation;
  readonly #schedule: Schedule;
  readonly #random: RandomSource;
  /** The constant deviation of this participant's answers. */
  readonly #person: number;
  readonly #records: StudyRecord[] = [];
  #progress: Progress;
  /** Seconds since 1970. */
  #now: number;

  constructor(simulation: Simulation, participant: string, at: number) {
    this.#simulation = simulation;
    this.#schedule = scheduleFor(simulation.plan, participant);
    this.#random = this.#randomFor(`session ${participant}`);
    this.#person = drawPerson(this.#randomFor(`person ${participant}`));
    this.#progress = begin(this.#schedule, true);
    this.#now = at;
  }

  run(): SimulatedParticipant {
    const { participant } = this.#schedule;
    for (let steps = 0; steps < maxSteps; steps++) {
      const step = currentStep(this.#schedule, this.#progress);
      if (step.kind === 'end') return { participant, progress: this.#progress, records: this.#records };
      this.#now += 5 + Math.round(10 * this.#random.uniform());
      this.#complete(step);
    }
    throw new Error(`${participant} does not reach the end`);
  }

  #apply(event: ProgressEvent): void {
    const next = applyEvent(this.#schedule, this.#progress, event, this.#now);
    if (next.rejection)
      throw new Error(`${this.#schedule.participant}, ${this.#progress.step}: ${next.rejection.message}`);
    this.#progress = next.progress;
    this.#records.push(...next.records);
  }

  #complete(step: StudyStep): void {
    switch (step.kind) {
      case 'consent':
        this.#apply({ type: 'consent', version: this.#schedule.consentVersion, motion: false });
        break;
      case 'demographics':
        this.#apply({ type: 'demographics', demographics: drawDemographics(this.#random) });
        break;
      case 'calibration': {
        const { eyeHeight, armSpan } = this.#player(this.#schedule.participant);
        this.#apply({ type: 'calibrated', calibration: { eyeHeight, armSpan } });
        break;
      }
      case 'rest':
        this.#now += step.seconds;
        this.#apply({ type: 'tick' });
        break;
      case 'tutorial':
      case 'trial':
        this.#play(step);
        break;
      case 'questionnaire':
        this.#answer(step);
        break;
    }
  }

  #play(step: PlayedStep): void {
    this.#apply({ type: 'start' });
    if (this.#random.uniform() < mishaps.reload) {
      this.#now += 10;
      this.#progress = resumed(this.#schedule, JSON.stringify(this.#progress));
      this.#apply({ type: 'reload' });
      return;
    }
    const outcome = this.#drawTrial(step);
    this.#now += outcome.seconds;
    this.#apply({ type: 'trial-finished', outcome });
    // The block of a group is voided for all or none; single participants have separate mishaps.
    const alone = this.#schedule.groups[step.task]?.members.length === 1;
    if (step.kind === 'trial' && alone && this.#random.uniform() < mishaps.voided) {
      this.#apply({ type: 'void-block', reason: 'simulated mishap', repeat: true });
    }
  }

  #answer({ condition, questionnaire }: QuestionnaireStep): void {
    const effect = effectUnder(this.#simulation.effects.answers, [condition, this.#schedule.cohort]);
    const drawn = drawAnswers(questionnaire, this.#person, effect, this.#random);
    for (const [question, value] of Object.entries(drawn)) {
      this.#now += 4 + Math.round(8 * this.#random.uniform());
      this.#apply({ type: 'answer', question, value });
    }
    this.#apply({ type: 'submit' });
  }

  /** Draws the result of a trial; participants who play together share a round. */
  #drawTrial(step: PlayedStep): TrialOutcome {
    const { plan, effects } = this.#simulation;
    const { participant, cohort, groups } = this.#schedule;
    const task = plan.tasks.find(({ id }) => id === step.task) as StudyTask;
    const { simulated, ends }: GameDescription = games[task.game];
    const condition = step.kind === 'trial' ? step.condition : null;
    const circumstances = {
      estimator: step.embodiment.estimator,
      effect: effectUnder(effects.scores, [condition, cohort]) + (step.block > 1 ? practiceEffect : 0),
      seconds: step.seconds,
    };
    if ('points' in simulated) {
      const run = this.#progress.runs[`${step.task}/${step.block}`] ?? 1;
      const random = this.#randomFor(`${participant} ${step.id} ${run} ${this.#progress.attempt}`);
      return drawTargets({ ...simulated, ends }, this.#player(participant), circumstances, random);
    }
    const members = groups[step.task]?.members ?? [];
    const players = members.map((member) => this.#player(member));
    const random = this.#randomFor(`${members.join(' ')} ${step.id}`);
    const outcomes = drawShared({ ...simulated, ends }, players, circumstances, random);
    return outcomes[members.indexOf(participant)] as TrialOutcome;
  }

  #player(participant: string): Player {
    return drawPlayer(this.#randomFor(`player ${participant}`));
  }

  #randomFor(purpose: string): RandomSource {
    return randomSource(this.#simulation.seed, purpose);
  }
}
