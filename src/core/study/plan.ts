import type * as v from 'valibot';
import type { EstimatorName } from '../estimation/pose-estimator';
import { planSchema } from './plan-schema';
import {
  type Questionnaire,
  questionnaireNamed,
  refuseMissingLanguages,
  resolvedQuestionnaire,
  shippedQuestionnaires,
} from './questionnaires';
import { randomFor, shuffle } from './shuffle';
import { checked, complaintsAbout, ValidationError } from './validation';
import { missingLanguage, type Words } from './words';

/** A study as its file says it. */
export type StudyPlan = v.InferOutput<typeof planSchema>;
export type StudyTask = StudyPlan['tasks'][number];
export type StudyCondition = StudyPlan['conditions'][number];

const mostOrdersListed = 4;

function refuseRepeated(names: readonly string[], fieldOf: (index: number) => string): void {
  names.forEach((name, index) => {
    const first = names.indexOf(name);
    if (first !== index) throw new ValidationError(fieldOf(index), `"${name}" is the name of ${fieldOf(first)} too`);
  });
}

/** The languages that participants may choose from, the first of them chosen. */
export const languagesOf = ({ languages }: Pick<StudyPlan, 'languages'>): readonly [string, ...string[]] => {
  const [first = 'en', ...others] = languages ?? [];
  return [first, ...others];
};

/** The ids of the questionnaires after each block of a task, in the order asked. */
export const questionnairesAfter = ({ questionnaire }: Pick<StudyTask, 'questionnaire'>): readonly string[] =>
  typeof questionnaire === 'string' ? [questionnaire] : questionnaire;

/** Every questionnaire that the study asks, once, in the order first met. */
export const questionnairesOf = (plan: StudyPlan): readonly Questionnaire[] =>
  [...new Set(plan.tasks.flatMap(questionnairesAfter))].map((id) => questionnaireNamed(plan, id) as Questionnaire);

function refuseQuestionnaires(plan: StudyPlan): void {
  const own = plan.questionnaires ?? [];
  const languages = languagesOf(plan);
  refuseRepeated(languages, (index) => `languages[${index}]`);
  refuseRepeated(
    own.map(({ id }) => id),
    (index) => `questionnaires[${index}].id`,
  );
  own.forEach((file, index) => {
    const field = `questionnaires[${index}]`;
    if (Object.hasOwn(shippedQuestionnaires, file.id)) {
      throw new ValidationError(
        `${field}.id`,
        `"${file.id}" is the name of a questionnaire that comes with the program`,
      );
    }
    resolvedQuestionnaire(file, field);
    refuseMissingLanguages(file, languages, field);
  });
  plan.tasks.forEach((task, index) => {
    const named = questionnairesAfter(task);
    const fieldOf = (at: number) =>
      `tasks[${index}].questionnaire${typeof task.questionnaire === 'string' ? '' : `[${at}]`}`;
    refuseRepeated(named, fieldOf);
    named.forEach((id, at) => {
      if (questionnaireNamed(plan, id)) return;
      const known = [...own.map((one) => one.id), ...Object.keys(shippedQuestionnaires)];
      throw new ValidationError(fieldOf(at), `there is no questionnaire "${id}": expected one of ${known.join(', ')}`);
    });
  });
}

function refuseUntranslatedConsent(plan: StudyPlan): void {
  const { title, paragraphs, motion } = plan.consent;
  const texts: (readonly [string, Words])[] = [
    ['title', title],
    ...paragraphs.map((one, index) => [`paragraphs[${index}]`, one] as const),
  ];
  if (motion !== null) texts.push(['motion', motion]);
  for (const [field, text] of texts) {
    const missing = missingLanguage(text, languagesOf(plan));
    if (missing !== null) {
      throw new ValidationError(`consent.${field}.${missing}`, 'is missing, and the study is in this language too');
    }
  }
}

/** A study from parsed JSON; throws a ValidationError that names the field. */
export function checkedPlan(value: unknown): StudyPlan {
  const plan = checked(planSchema, value);
  refuseRepeated(
    plan.conditions.map(({ id }) => id),
    (index) => `conditions[${index}].id`,
  );
  refuseRepeated(
    plan.tasks.map(({ id }) => id),
    (index) => `tasks[${index}].id`,
  );
  if (plan.orders === 'all' && plan.conditions.length > mostOrdersListed) {
    throw new ValidationError(
      'orders',
      `all orders of ${plan.conditions.length} conditions are more than a study can run: expected williams`,
    );
  }
  refuseQuestionnaires(plan);
  refuseUntranslatedConsent(plan);
  plan.tasks.forEach(({ groupSize }, index) => {
    if (plan.participants % groupSize !== 0) {
      throw new ValidationError(
        `tasks[${index}].groupSize`,
        `${plan.participants} participants cannot be divided into groups of ${groupSize}`,
      );
    }
  });
  return plan;
}

/** A study from the text of its file; throws an Error that names the file and, where there is one, the field. */
export function parsePlan(json: string, file: string): StudyPlan {
  try {
    return checkedPlan(JSON.parse(json));
  } catch (error) {
    if (error instanceof ValidationError) throw new ValidationError(error.field, error.complaint, file);
    if (error instanceof SyntaxError) throw new ValidationError('', `this is no JSON: ${error.message}`, file);
    throw error;
  }
}

/** Everything that is wrong with the text of a study's file, each with file, field and reason; empty: it is sound. */
export function planComplaints(json: string, file: string): readonly string[] {
  let value: unknown;
  try {
    value = JSON.parse(json);
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    return [`${file}: this is no JSON: ${error.message}`];
  }
  const complaints = complaintsAbout(planSchema, value).map(({ field, complaint }) =>
    [file, field, complaint].filter(Boolean).join(': '),
  );
  if (complaints.length > 0) return complaints;
  try {
    checkedPlan(value);
    return [];
  } catch (error) {
    if (!(error instanceof ValidationError)) throw error;
    return [[file, error.field, error.complaint].filter(Boolean).join(': ')];
  }
}

/** P01, P02 … in the order of the plan. */
export function participantsOf(plan: Pick<StudyPlan, 'participants'>): readonly string[] {
  const digits = plan.participants > 99 ? 3 : 2;
  return Array.from({ length: plan.participants }, (_, index) => `P${String(index + 1).padStart(digits, '0')}`);
}

/** Every order of the items, in the order of the items. */
function permutations<T>(items: readonly T[]): readonly (readonly T[])[] {
  if (items.length < 2) return [items];
  return items.flatMap((first, index) =>
    permutations(items.filter((_, other) => other !== index)).map((rest) => [first, ...rest]),
  );
}

/**
 * Williams' Latin square (Australian Journal of Scientific Research 2, 1949): each item at each place equally often and each
 * directly after each other equally often. An odd number needs the mirrored square too.
 */
function williams<T>(items: readonly T[]): readonly (readonly T[])[] {
  const count = items.length;
  const first = Array.from({ length: count }, (_, place) =>
    place % 2 === 0 ? (count - place / 2) % count : (place + 1) / 2,
  );
  const rows = items.map((_, shift) => first.map((index) => items[(index + shift) % count] as T));
  return count % 2 === 0 ? rows : [...rows, ...rows.map((row) => row.toReversed())];
}

/** The orders of conditions among which participants and groups are divided. */
export function ordersOf(plan: Pick<StudyPlan, 'orders' | 'conditions'>): readonly (readonly StudyCondition[])[] {
  return plan.orders === 'all' ? permutations(plan.conditions) : williams(plan.conditions);
}

/** Who plays a task together: groups drawn by the seed, alike for all tasks of the same size; alone: one each, in order. */
export function groupsOf(plan: StudyPlan, groupSize: number): readonly (readonly string[])[] {
  const participants = participantsOf(plan);
  if (groupSize === 1) return participants.map((participant) => [participant]);
  const drawn = shuffle(participants, randomFor(plan.seed, `groups of ${groupSize}`)).items;
  return Array.from({ length: drawn.length / groupSize }, (_, index) =>
    drawn.slice(index * groupSize, (index + 1) * groupSize).toSorted(),
  );
}

/**
 * The order of conditions for each group of a task. Orders are drawn in rounds, each round every order once in random
 * sequence: at any number of groups the counts of two orders differ by at most one, and by none after a whole round.
 */
export function ordersByGroup(plan: StudyPlan, task: StudyTask): readonly (readonly StudyCondition[])[] {
  const orders = ordersOf(plan);
  const groups = plan.participants / task.groupSize;
  const drawn: (readonly StudyCondition[])[] = [];
  let random = randomFor(plan.seed, `orders of ${task.id}`);
  while (drawn.length < groups) {
    const round = shuffle(orders, random);
    random = round.random;
    drawn.push(...round.items);
  }
  return drawn.slice(0, groups);
}

interface StepOf<Kind extends string> {
  readonly kind: Kind;
  /** Unique in the schedule: "archery/2/trial-1". */
  readonly id: string;
}

/** A step that belongs to a block: one condition of one task. */
interface BlockStep {
  readonly task: string;
  /** From 1, in the order in which the participant meets the conditions. The tutorial before them all belongs to block 1. */
  readonly block: number;
}

/** One thing that a participant does. */
export type StudyStep =
  | StepOf<'consent'>
  | StepOf<'demographics'>
  | (StepOf<'calibration'> & BlockStep)
  | (StepOf<'tutorial'> & BlockStep & { readonly estimator: EstimatorName; readonly seconds: number })
  | (StepOf<'trial'> &
      BlockStep & {
        readonly condition: string;
        readonly estimator: EstimatorName;
        /** From 1. */
        readonly repetition: number;
        readonly seconds: number;
      })
  | (StepOf<'rest'> & BlockStep & { readonly seconds: number })
  | (StepOf<'questionnaire'> &
      BlockStep & { readonly condition: string; readonly questionnaire: Questionnaire; readonly seconds: number })
  | StepOf<'end'>;

/** What one participant does, from consent to the end. */
export interface Schedule {
  readonly study: string;
  readonly participant: string;
  readonly consentVersion: string;
  /** Per task: with whom, and the group's number from 1 (for tasks alone: the participant's). */
  readonly groups: Readonly<Record<string, { readonly number: number; readonly members: readonly string[] }>>;
  readonly steps: readonly StudyStep[];
}

/** What a participant may read instead of a condition's name. */
export const blindLabel = (step: { readonly block: number }): string => `Round ${step.block}`;

/** The steps of one participant; throws where the plan has no such participant. */
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
  for (const task of plan.tasks) {
    const all = groupsOf(plan, task.groupSize);
    const index = all.findIndex((members) => members.includes(participant));
    groups[task.id] = { number: index + 1, members: all[index] as readonly string[] };
    const order = ordersByGroup(plan, task)[index] as readonly StudyCondition[];
    const asked = questionnairesAfter(task).map((id) => questionnaireNamed(plan, id) as Questionnaire);
    steps.push(...order.flatMap((condition, place) => blockSteps(task, condition, place + 1, asked)));
  }
  steps.push({ kind: 'end', id: 'end' });
  return { study: plan.id, participant, consentVersion: plan.consent.version, groups, steps };
}

function blockSteps(
  task: StudyTask,
  condition: StudyCondition,
  block: number,
  asked: readonly Questionnaire[],
): readonly StudyStep[] {
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
      estimator: tutorial.estimator,
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
      estimator: condition.estimator,
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
