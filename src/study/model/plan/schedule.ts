import { ValidationError } from 'threepoint/core';
import { type Questionnaire, questionnaireNamed } from '../questionnaires/questionnaires';
import type { StoppingRule } from '../questionnaires/stopping-rule';
import { cohortsByParticipant, groupsOf, ordersByGroup } from './allocation';
import { type Embodiment, embodimentOf, type PartialEmbodiment } from './embodiment';
import { participantsOf, questionnairesAfter, type StudyCondition, type StudyPlan, type StudyTask } from './plan';

interface StepOf<Kind extends string> {
  readonly kind: Kind;
  /** Unique in the schedule: "archery/2/trial-1". */
  readonly id: string;
}

/** A step of a block, which is one condition of one task. */
interface BlockStep {
  readonly task: string;
  /**
   * Counted from 1 in the order in which the participant meets the conditions. A tutorial before all of them belongs to
   * block 1.
   */
  readonly block: number;
}

export type StudyStep =
  | StepOf<'consent'>
  | StepOf<'demographics'>
  | (StepOf<'calibration'> & BlockStep)
  | (StepOf<'tutorial'> & BlockStep & { readonly embodiment: Embodiment; readonly seconds: number })
  | (StepOf<'trial'> &
      BlockStep & {
        readonly condition: string;
        readonly embodiment: Embodiment;
        /** Counted from 1. */
        readonly repetition: number;
        readonly seconds: number;
      })
  | (StepOf<'rest'> & BlockStep & { readonly seconds: number })
  | (StepOf<'questionnaire'> &
      BlockStep & { readonly condition: string; readonly questionnaire: Questionnaire; readonly seconds: number })
  | StepOf<'end'>;

export type PlayedStep = Extract<StudyStep, { kind: 'trial' | 'tutorial' }>;

export const isPlayed = (step: StudyStep): step is PlayedStep => step.kind === 'trial' || step.kind === 'tutorial';

/** The steps of one participant, from consent to the end. */
export interface Schedule {
  readonly study: string;
  readonly participant: string;
  readonly cohort: string | null;
  readonly consentVersion: string;
  readonly askToStop: readonly StoppingRule[];
  /** The group of each task: its members and its number from 1 (for tasks alone: the participant's). */
  readonly groups: Readonly<Record<string, { readonly number: number; readonly members: readonly string[] }>>;
  readonly steps: readonly StudyStep[];
}

/** Returns the first trial of a block, or undefined. */
export const trialOf = ({ steps }: Pick<Schedule, 'steps'>, { task, block }: BlockStep) =>
  steps.find((step) => step.kind === 'trial' && step.task === task && step.block === block) as
    | Extract<StudyStep, { kind: 'trial' }>
    | undefined;

/** Returns the name of a condition that participants read, for lists of researchers (English). */
export const blindLabel = (step: { readonly block: number }): string => `Round ${step.block}`;

/** Returns the steps of a participant; throws if the plan has no such participant. */
export function scheduleFor(plan: StudyPlan, participant: string): Schedule {
  if (!participantsOf(plan).includes(participant)) {
    throw new ValidationError(
      'participant',
      `the study "${plan.id}" has the participants P01 to ${participantsOf(plan).at(-1)}, not ${participant}`,
    );
  }
  const groups: Record<string, { number: number; members: readonly string[] }> = {};
  const steps: StudyStep[] = [
    { kind: 'consent', id: 'consent' },
    { kind: 'demographics', id: 'demographics' },
  ];
  const cohort = cohortsByParticipant(plan).get(participant);
  for (const task of plan.tasks) {
    const all = groupsOf(plan, task.groupSize);
    const index = all.findIndex((members) => members.includes(participant));
    groups[task.id] = { number: index + 1, members: all[index] as readonly string[] };
    const order = ordersByGroup(plan, task)[index] as readonly StudyCondition[];
    const asked = questionnairesAfter(task).map((id) => questionnaireNamed(plan, id) as Questionnaire);
    steps.push(
      ...order.flatMap((condition, place) =>
        blockSteps({ task, condition, cohort: cohort ?? {}, block: place + 1, asked }),
      ),
    );
  }
  steps.push({ kind: 'end', id: 'end' });
  return {
    study: plan.id,
    participant,
    cohort: cohort?.id ?? null,
    consentVersion: plan.consent.version,
    askToStop: plan.askToStop ?? [],
    groups,
    steps,
  };
}

interface Block {
  readonly task: StudyTask;
  readonly condition: StudyCondition;
  readonly cohort: PartialEmbodiment;
  /** Counted from 1. */
  readonly block: number;
  readonly asked: readonly Questionnaire[];
}

function blockSteps({ task, condition, cohort, block, asked }: Block): readonly StudyStep[] {
  const where = { task: task.id, block };
  const id = (name: string) => `${task.id}/${block}/${name}`;
  const steps: StudyStep[] = [];
  if (task.calibrateBeforeBlock || block === 1) steps.push({ kind: 'calibration', id: id('calibration'), ...where });
  const { tutorial } = task;
  if (tutorial.when === 'each' || (tutorial.when === 'once' && block === 1)) {
    steps.push({
      kind: 'tutorial',
      id: id('tutorial'),
      ...where,
      embodiment: embodimentOf(cohort, { estimator: tutorial.estimator }),
      seconds: tutorial.seconds,
    });
    if (tutorial.restSeconds > 0) {
      steps.push({ kind: 'rest', id: id('rest-after-tutorial'), ...where, seconds: tutorial.restSeconds });
    }
  }
  for (let repetition = 1; repetition <= task.repetitions; repetition++) {
    steps.push({
      kind: 'trial',
      id: id(`trial-${repetition}`),
      ...where,
      condition: condition.id,
      embodiment: embodimentOf(cohort, condition),
      repetition,
      seconds: task.trialSeconds,
    });
  }
  if (task.restSeconds > 0) steps.push({ kind: 'rest', id: id('rest'), ...where, seconds: task.restSeconds });
  asked.forEach((questionnaire, index) => {
    steps.push({
      kind: 'questionnaire',
      id: id(index === 0 ? 'questionnaire' : `questionnaire-${index + 1}`),
      ...where,
      condition: condition.id,
      questionnaire,
      seconds: task.questionnaireSeconds,
    });
  });
  return steps;
}
