import { checked, complaintsAbout, ValidationError } from 'threepoint/core';
import { games } from 'threepoint-games/all';
import type * as v from 'valibot';
import { inLanguage, type LocalizedText, missingLanguage } from '../phrases/localized-text';
import { rejectPhrases } from '../phrases/phrase-schema';
import {
  type Questionnaire,
  questionnaireNamed,
  rejectMissingLanguages,
  resolvedQuestionnaire,
  shippedQuestionnaires,
} from '../questionnaires/questionnaires';
import { checkStoppingRules } from '../questionnaires/stopping-rule';
import { embodimentFieldsOf } from './embodiment';
import { rejectUnclearHypotheses } from './hypotheses';
import { planSchema } from './plan-schema';

/** A study as its file has it. */
export type StudyPlan = v.InferOutput<typeof planSchema>;
export type StudyTask = StudyPlan['tasks'][number];
/** What a match of a group does when a participant is away. */
export type AbsenceRule = NonNullable<StudyTask['absence']>;
export type StudyCondition = StudyPlan['conditions'][number];
export type StudyCohort = NonNullable<StudyPlan['cohorts']>[number];

const maxOrdersListed = 4;
/** The properties that all conditions set if one does, because the default of the page depends on the headset. */
const setByAllOrNone = ['estimator', 'avatar', 'mirror', 'upperBodyOnly'] as const;

export const largestGroup = ({ tasks }: Pick<StudyPlan, 'tasks'>): number =>
  Math.max(...tasks.map(({ groupSize }) => groupSize));

const rejectRepeatedIds = (list: readonly { readonly id: string }[], name: string): void =>
  rejectRepeated(
    list.map(({ id }) => id),
    (index) => `${name}[${index}].id`,
  );

function rejectRepeated(names: readonly string[], fieldOf: (index: number) => string): void {
  names.forEach((name, index) => {
    const first = names.indexOf(name);
    if (first !== index) throw new ValidationError(fieldOf(index), `"${name}" is the name of ${fieldOf(first)} too`);
  });
}

/** Returns the languages that participants may choose, the default first. */
export const languagesOf = ({ languages }: Pick<StudyPlan, 'languages'>): readonly [string, ...string[]] => {
  const [first = 'en', ...others] = languages ?? [];
  return [first, ...others];
};

/** Returns the title of a study for experimenters, in its first language. */
export const studyTitle = (plan: Pick<StudyPlan, 'title' | 'languages'>): string =>
  inLanguage(plan.title, languagesOf(plan)[0]);

/** Returns a task's title in a language, by default the study's first one; an unknown task has its id. */
export function taskTitle(plan: StudyPlan, id: string, language: string = languagesOf(plan)[0]): string {
  const task = plan.tasks.find((one) => one.id === id);
  return task ? inLanguage(task.title, language) : id;
}

/** Returns what a match of a task does when a participant is away; by default it waits a minute and is repeated. */
export const absenceRuleOf = ({ absence }: Pick<StudyTask, 'absence'>): AbsenceRule =>
  absence ?? { waitSeconds: 60, after: 'repeat' };

/** Returns the ids of the questionnaires after each block of a task, in the order asked. */
export const questionnairesAfter = ({ questionnaire }: Pick<StudyTask, 'questionnaire'>): readonly string[] =>
  typeof questionnaire === 'string' ? [questionnaire] : questionnaire;

/** Returns every questionnaire of the study once, in the order of its first use. */
export const questionnairesOf = (plan: StudyPlan): readonly Questionnaire[] =>
  [...new Set(plan.tasks.flatMap(questionnairesAfter))].map((id) => questionnaireNamed(plan, id) as Questionnaire);

function rejectQuestionnaires(plan: StudyPlan): void {
  const own = plan.questionnaires ?? [];
  const languages = languagesOf(plan);
  rejectRepeated(languages, (index) => `languages[${index}]`);
  rejectRepeatedIds(own, 'questionnaires');
  own.forEach((file, index) => {
    const field = `questionnaires[${index}]`;
    if (Object.hasOwn(shippedQuestionnaires, file.id)) {
      throw new ValidationError(
        `${field}.id`,
        `"${file.id}" is the name of a questionnaire that comes with the program`,
      );
    }
    resolvedQuestionnaire(file, field);
    rejectMissingLanguages(file, languages, field);
  });
  plan.tasks.forEach((task, index) => {
    const named = questionnairesAfter(task);
    const fieldOf = (at: number) =>
      `tasks[${index}].questionnaire${typeof task.questionnaire === 'string' ? '' : `[${at}]`}`;
    rejectRepeated(named, fieldOf);
    named.forEach((id, at) => {
      if (questionnaireNamed(plan, id)) return;
      const known = [...own.map((one) => one.id), ...Object.keys(shippedQuestionnaires)];
      throw new ValidationError(fieldOf(at), `there is no questionnaire "${id}": expected one of ${known.join(', ')}`);
    });
  });
}

/**
 * Throws a ValidationError if only some conditions set a property, if conditions and cohorts both do, or if no one sets
 * the estimator.
 */
function rejectUnclearBodies({ conditions, cohorts = [] }: StudyPlan): void {
  const lists = { conditions, cohorts };
  for (const [list, entries] of Object.entries(lists)) {
    for (const field of setByAllOrNone) {
      const missing = entries.findIndex((entry) => entry[field] === undefined);
      const present = entries.findIndex((entry) => entry[field] !== undefined);
      if (missing >= 0 && present >= 0) {
        throw new ValidationError(`${list}[${missing}].${field}`, `is missing, and ${list}[${present}] has it`);
      }
    }
  }
  const ofCohorts = new Set(cohorts.flatMap(embodimentFieldsOf));
  conditions.forEach((condition, index) => {
    const twice = embodimentFieldsOf(condition).find((field) => ofCohorts.has(field));
    if (twice) throw new ValidationError(`conditions[${index}].${twice}`, 'is set by cohorts already');
    if (condition.estimator === undefined && !ofCohorts.has('estimator')) {
      throw new ValidationError(`conditions[${index}].estimator`, 'is missing');
    }
  });
}

function rejectUnfilledCohorts(plan: StudyPlan): void {
  const { cohorts, conditions, participants } = plan;
  if (!cohorts) {
    if (conditions.length < 2) {
      throw new ValidationError('conditions', 'expected at least two conditions to compare, or cohorts');
    }
    return;
  }
  rejectRepeatedIds(cohorts, 'cohorts');
  const together = largestGroup(plan);
  if (participants / together < cohorts.length) {
    const units = together === 1 ? 'participants' : `groups of ${together}`;
    throw new ValidationError('cohorts', `${participants / together} ${units} do not fill ${cohorts.length} cohorts`);
  }
}

function rejectUntranslated(plan: StudyPlan): void {
  const { title, paragraphs, motion } = plan.consent;
  const texts: (readonly [string, LocalizedText])[] = [
    ['title', plan.title],
    ...plan.tasks.map((task, index) => [`tasks[${index}].title`, task.title] as const),
    ['consent.title', title],
    ...paragraphs.map((one, index) => [`consent.paragraphs[${index}]`, one] as const),
  ];
  if (motion !== null) texts.push(['consent.motion', motion]);
  for (const [field, text] of texts) {
    const missing = missingLanguage(text, languagesOf(plan));
    if (missing !== null) {
      throw new ValidationError(`${field}.${missing}`, 'is missing, and the study is in this language too');
    }
  }
}

/**
 * Returns the measures that a plan may name as planned: "archery/embodiment/ownership", a question or a scale of a
 * task, or "archery/score".
 */
export function measuresOf(plan: StudyPlan): readonly string[] {
  return plan.tasks.flatMap(({ id, questionnaire }) => {
    const asked = questionnairesAfter({ questionnaire }).flatMap((one) => questionnaireNamed(plan, one) ?? []);
    const named = asked.flatMap(({ id: of, questions, scales }) =>
      [...questions, ...scales].map((one) => `${id}/${of}/${one.id}`),
    );
    return [...named, `${id}/score`];
  });
}

function rejectUnknownMeasures(plan: StudyPlan): void {
  const { planned = [], hypotheses = [] } = plan;
  const known = measuresOf(plan);
  const lists = [
    ['planned', planned],
    ...hypotheses.map(({ measures }, index) => [`hypotheses[${index}].measures`, measures] as const),
  ] as const;
  for (const [field, measures] of lists) {
    rejectRepeated(measures, (index) => `${field}[${index}]`);
    measures.forEach((measure, index) => {
      if (known.includes(measure)) return;
      throw new ValidationError(
        `${field}[${index}]`,
        `"${measure}" is not measured: expected task/questionnaire/question, task/questionnaire/scale or task/score, as "${known[0]}"`,
      );
    });
  }
}

/**
 * Returns a plan that was checked before it was stored; throws a ValidationError if it does not match the schema. The
 * consistency of its parts is not checked again: a later rule must not make records inaccessible.
 */
export const storedPlan = (value: unknown): StudyPlan => checked(planSchema, value);

/** Returns a new study from parsed JSON; throws a ValidationError that names the field. */
export function checkedPlan(value: unknown): StudyPlan {
  const plan = checked(planSchema, value);
  rejectRepeatedIds(plan.conditions, 'conditions');
  rejectRepeatedIds(plan.tasks, 'tasks');
  if (plan.orders === 'all' && plan.conditions.length > maxOrdersListed) {
    throw new ValidationError(
      'orders',
      `all orders of ${plan.conditions.length} conditions are more than a study can run: expected williams`,
    );
  }
  rejectUnclearBodies(plan);
  rejectQuestionnaires(plan);
  checkStoppingRules(plan.askToStop ?? [], questionnairesOf(plan));
  rejectUntranslated(plan);
  rejectPhrases(plan.phrases ?? {}, languagesOf(plan));
  rejectUnknownMeasures(plan);
  plan.tasks.forEach(({ game, groupSize }, index) => {
    const { players, because } = games[game];
    if (plan.tasks[index]?.absence && players === 1) {
      throw new ValidationError(`tasks[${index}].absence`, 'is for games of a group: a game for one waits for nobody');
    }
    if (groupSize !== players) {
      throw new ValidationError(`tasks[${index}].groupSize`, `${because}: expected ${players}`);
    }
    if (plan.participants % groupSize !== 0) {
      throw new ValidationError(
        `tasks[${index}].groupSize`,
        `${plan.participants} participants cannot be divided into groups of ${groupSize}`,
      );
    }
  });
  rejectUnfilledCohorts(plan);
  rejectRepeatedIds(plan.hypotheses ?? [], 'hypotheses');
  rejectUnclearHypotheses(
    plan.hypotheses ?? [],
    plan.conditions.map(({ id }) => id),
  );
  return plan;
}

/** A plan, or everything that is wrong with the text of its file, each with file, field and reason. */
export type ReadPlan = { readonly plan: StudyPlan } | { readonly problems: readonly ValidationError[] };

/** Returns the plan in the text of a file, or what is wrong with it. */
export function readPlan(json: string, file: string): ReadPlan {
  const errorAt = (field: string, problem: string) => new ValidationError(field, problem, file);
  try {
    const value: unknown = JSON.parse(json);
    const problems = complaintsAbout(planSchema, value);
    if (problems.length === 0) return { plan: checkedPlan(value) };
    return { problems: problems.map(({ field, complaint }) => errorAt(field, complaint)) };
  } catch (error) {
    if (error instanceof ValidationError) return { problems: [errorAt(error.field, error.complaint)] };
    if (error instanceof SyntaxError) return { problems: [errorAt('', `this is not JSON: ${error.message}`)] };
    throw error;
  }
}

/** Returns the plan in the text of a file; throws a ValidationError that names the file and, if known, the field. */
export function parsePlan(json: string, file: string): StudyPlan {
  const read = readPlan(json, file);
  if ('plan' in read) return read.plan;
  throw read.problems[0];
}

/** Returns the codes P01, P02 … of a plan. */
export function participantsOf(plan: Pick<StudyPlan, 'participants'>): readonly string[] {
  const digits = plan.participants > 99 ? 3 : 2;
  return Array.from({ length: plan.participants }, (_, index) => `P${String(index + 1).padStart(digits, '0')}`);
}
