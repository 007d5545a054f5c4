import { ValidationError } from 'threepoint/core';
import { type GameDescription, type GameName, games } from 'threepoint-games/all';
import type { LocalizedText } from '../model/phrases/localized-text';
import { cohortsByParticipant } from '../model/plan/allocation';
import { participantsOf, type StudyPlan } from '../model/plan/plan';
import { type PlayedStep, type Schedule, type StudyStep, scheduleFor } from '../model/plan/schedule';
import { applyEvent, type ProgressEvent } from '../model/progress/apply-event';
import { begin, currentStep, type Progress, resumed } from '../model/progress/progress';
import type { Demographics } from '../model/records/demographics';
import type { StudyRecord } from '../model/records/study-record';
import type { TrialOutcome } from '../model/records/trial-log';
import { type AnswerModel, answerModelWith, drawAnswers, drawPerson } from './answer-model';
import {
  type Circumstances,
  drawPlayer,
  drawShared,
  drawTargets,
  type PerformanceModel,
  type Player,
  statedPerformanceModel,
} from './performance-model';
import { type RandomSource, randomSource } from './random-source';

export interface SimulationModels {
  readonly answers: AnswerModel;
  readonly performance: PerformanceModel;
}

/** The effects in a simulated study, by the id of a condition or a cohort. */
export interface StatedEffects {
  /** The effect on answers in points of a scale from 1 to 5, stretched to each question's scale. */
  readonly answers: Readonly<Record<string, number>>;
  /** The effect on the chance to hit or catch. */
  readonly scores: Readonly<Record<string, number>>;
}

/** Returns the models with these effects; throws a ValidationError if the plan has no such condition or cohort. */
export function modelsWith(
  { conditions, cohorts = [] }: StudyPlan,
  { answers, scores }: StatedEffects,
): SimulationModels {
  const known = [...conditions, ...cohorts].map(({ id }) => id);
  for (const id of [...Object.keys(answers), ...Object.keys(scores)]) {
    if (known.includes(id)) continue;
    throw new ValidationError('effect', `there is no condition or cohort "${id}": expected one of ${known.join(', ')}`);
  }
  return { answers: answerModelWith(answers), performance: { ...statedPerformanceModel, effects: scores } };
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

/**
 * Yields the simulated participants of a whole study one after the other. They use the same sessions as people, with
 * reloads in the middle of trials and voided blocks. `at` is the start of the first one [s since 1970]. The same plan,
 * models and seed give the same study.
 */
export function* simulatedParticipants(
  plan: StudyPlan,
  models: SimulationModels,
  seed: number,
  at: number,
): Generator<SimulatedParticipant> {
  const rounds = new SimulatedRounds(plan, models, seed);
  for (const [index, participant] of participantsOf(plan).entries()) {
    yield new SimulatedSession(rounds, participant, at + index * slotSeconds).run();
  }
}

/** Returns all simulated participants of a study. */
export const simulateStudy = (...study: Parameters<typeof simulatedParticipants>): readonly SimulatedParticipant[] => [
  ...simulatedParticipants(...study),
];

/** A trial of a participant, whose `place` is that among the players of the group. */
interface SimulatedTrial {
  readonly performance: PerformanceModel;
  readonly circumstances: Circumstances;
  readonly players: readonly Player[];
  readonly place: number;
  readonly ownRandom: RandomSource;
  /** The source that draws the same round for every player. */
  readonly sharedRandom: RandomSource;
}

/** Draws the result of a trial of a game. */
function drawTrial(game: GameName, trial: SimulatedTrial): TrialOutcome {
  const { performance, circumstances, players, place, ownRandom, sharedRandom } = trial;
  const { simulated, ends }: GameDescription = games[game];
  if ('points' in simulated) {
    return drawTargets({ ...simulated, ends }, performance, players[place] as Player, circumstances, ownRandom);
  }
  return drawShared({ ...simulated, ends }, performance, players, circumstances, sharedRandom)[place] as TrialOutcome;
}

/** Draws the players of a study and the results of their trials. */
class SimulatedRounds {
  readonly plan: StudyPlan;
  readonly models: SimulationModels;
  readonly seed: number;
  readonly #players: ReadonlyMap<string, Player>;
  readonly #cohorts: ReturnType<typeof cohortsByParticipant>;

  constructor(plan: StudyPlan, models: SimulationModels, seed: number) {
    this.plan = plan;
    this.models = models;
    this.seed = seed;
    this.#cohorts = cohortsByParticipant(plan);
    this.#players = new Map(
      participantsOf(plan).map((participant) => [
        participant,
        drawPlayer(models.performance, randomSource(seed, `player ${participant}`)),
      ]),
    );
  }

  playerOf(participant: string): Player {
    return this.#players.get(participant) as Player;
  }

  cohortOf(participant: string): string | null {
    return this.#cohorts.get(participant)?.id ?? null;
  }

  /** Returns the result of a trial; participants who play together share a round. */
  outcomeOf({ participant, groups }: Schedule, step: PlayedStep, run: number, attempt: number): TrialOutcome {
    const task = this.plan.tasks.find(({ id }) => id === step.task);
    const group = groups[step.task];
    if (!task || !group) throw new Error(`the plan has no task "${step.task}"`);
    const circumstances = {
      estimator: step.embodiment.estimator,
      condition: step.kind === 'trial' ? step.condition : null,
      cohort: this.cohortOf(participant),
      block: step.block,
      seconds: step.seconds,
    };
    const { members } = group;
    return drawTrial(task.game, {
      performance: this.models.performance,
      circumstances,
      players: members.map((member) => this.playerOf(member)),
      place: members.indexOf(participant),
      ownRandom: randomSource(this.seed, `${participant} ${step.id} ${run} ${attempt}`),
      sharedRandom: randomSource(this.seed, `${members.join(' ')} ${step.id}`),
    });
  }
}

/** Simulates a participant from consent to the end. */
class SimulatedSession {
  readonly #rounds: SimulatedRounds;
  readonly #schedule: Schedule;
  readonly #random: RandomSource;
  /** The constant deviation of this participant's answers. */
  readonly #person: number;
  readonly #records: StudyRecord[] = [];
  #progress: Progress;
  /** Seconds since 1970. */
  #now: number;

  constructor(rounds: SimulatedRounds, participant: string, at: number) {
    const { plan, models, seed } = rounds;
    this.#rounds = rounds;
    this.#schedule = scheduleFor(plan, participant);
    this.#random = randomSource(seed, `session ${participant}`);
    this.#person = drawPerson(models.answers, randomSource(seed, `person ${participant}`));
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
        const { eyeHeight, armSpan } = this.#rounds.playerOf(this.#schedule.participant);
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
    const { mishaps } = this.#rounds.models.performance;
    this.#apply({ type: 'start' });
    if (this.#random.uniform() < mishaps.reload) {
      this.#now += 10;
      this.#progress = resumed(this.#schedule, JSON.stringify(this.#progress));
      this.#apply({ type: 'reload' });
      return;
    }
    const run = this.#progress.runs[`${step.task}/${step.block}`] ?? 1;
    const outcome = this.#rounds.outcomeOf(this.#schedule, step, run, this.#progress.attempt);
    this.#now += outcome.seconds;
    this.#apply({ type: 'trial-finished', outcome });
    // The block of a group is voided for all or none; single participants have separate mishaps.
    const alone = this.#schedule.groups[step.task]?.members.length === 1;
    if (step.kind === 'trial' && alone && this.#random.uniform() < mishaps.voided) {
      this.#apply({ type: 'void-block', reason: 'simulated mishap', repeat: true });
    }
  }

  #answer({ condition, block, questionnaire }: QuestionnaireStep): void {
    const cohort = this.#rounds.cohortOf(this.#schedule.participant);
    const about = { person: this.#person, condition, cohort, block };
    const drawn = drawAnswers(this.#rounds.models.answers, questionnaire, about, this.#random);
    for (const [question, value] of Object.entries(drawn)) {
      this.#now += 4 + Math.round(8 * this.#random.uniform());
      this.#apply({ type: 'answer', question, value });
    }
    this.#apply({ type: 'submit' });
  }
}
