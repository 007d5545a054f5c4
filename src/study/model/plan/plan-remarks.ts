import { games } from 'threepoint-games/all';
import { missingKeys, phraseKeys } from '../phrases/phrases';
import { isNumeric, questionnaireNamed } from '../questionnaires/questionnaires';
import { cohortsByParticipant, groupsOf, ordersByGroup, ordersOf } from './allocation';
import { embodimentFieldsOf, embodimentInWords, type PartialEmbodiment } from './embodiment';
import { plannedMeasures } from './hypotheses';
import { languagesOf, type StudyCohort, type StudyPlan, type StudyTask, taskTitle } from './plan';

export function cohortCounts(plan: StudyPlan): ReadonlyMap<string, number> {
  const counts = new Map((plan.cohorts ?? []).map(({ id }) => [id, 0]));
  for (const { id } of cohortsByParticipant(plan).values()) counts.set(id, (counts.get(id) ?? 0) + 1);
  return counts;
}

/**
 * Counts how often each order of conditions occurs in a task, by the names of the conditions in order, including those
 * that never occur. `cohort` restricts the count to one cohort; null: all.
 */
export function orderCounts(
  plan: StudyPlan,
  task: StudyTask,
  cohort: StudyCohort | null = null,
): ReadonlyMap<string, number> {
  const nameOf = (order: readonly { readonly id: string }[]) => order.map(({ id }) => id).join(', ');
  const counts = new Map(ordersOf(plan).map((order) => [nameOf(order), 0]));
  const groups = groupsOf(plan, task.groupSize);
  const cohorts = cohortsByParticipant(plan);
  ordersByGroup(plan, task).forEach((order, index) => {
    if (cohort && cohorts.get(groups[index]?.[0] ?? '') !== cohort) return;
    const name = nameOf(order);
    counts.set(name, (counts.get(name) ?? 0) + 1);
  });
  return counts;
}

const even = (counts: ReadonlyMap<string, number>) => new Set(counts.values()).size < 2;

const greatestCommonDivisor = (a: number, b: number): number => (b === 0 ? a : greatestCommonDivisor(b, a % b));
const leastCommonMultiple = (a: number, b: number) => (a / greatestCommonDivisor(a, b)) * b;

/**
 * Returns the number of participants (or of a multiple) with which the orders of a task are balanced in every cohort.
 */
const evenParticipants = ({ tasks, cohorts, ...plan }: StudyPlan, { groupSize }: StudyTask): number =>
  (cohorts?.length ?? 1) *
  tasks.reduce((all, task) => leastCommonMultiple(all, task.groupSize), groupSize * ordersOf(plan).length);

const timesText = (count: number) => (count === 0 ? 'never' : count === 1 ? 'once' : `${count} times`);

function balanceRemarks(plan: StudyPlan): readonly string[] {
  const remarks: string[] = [];
  const sizes = cohortCounts(plan);
  if (!even(sizes)) {
    const listed = [...sizes].map(([id, count]) => `${id} ${count}`).join(', ');
    remarks.push(`The cohorts are not balanced: ${listed} participants.`);
  }
  for (const task of plan.tasks) {
    for (const cohort of plan.cohorts ?? [null]) {
      const counts = orderCounts(plan, task, cohort);
      if (even(counts)) continue;
      const [least, most] = [Math.min(...counts.values()), Math.max(...counts.values())];
      remarks.push(
        `${taskTitle(plan, task.id)}${cohort ? `, cohort ${cohort.id}` : ''}: the ${counts.size} orders are not balanced: some occur ${timesText(most)}, ` +
          `others ${timesText(least)}; a multiple of ${evenParticipants(plan, task)} participants would balance them.`,
      );
    }
  }
  return remarks;
}

/** Returns remarks about conditions or cohorts with identical bodies. */
function sameBodyRemarks(
  list: string,
  entries: readonly (PartialEmbodiment & { readonly id: string })[],
): readonly string[] {
  const described = entries.map((entry) =>
    JSON.stringify(embodimentFieldsOf(entry).map((field) => [field, entry[field]])),
  );
  return entries.flatMap(({ id }, index) => {
    const first = entries[described.indexOf(described[index] as string)];
    return first && first.id !== id
      ? [`${list} "${first.id}" and "${id}" have the same body: ${embodimentInWords(first)}.`]
      : [];
  });
}

/** Returns remarks about languages in which the page shows some phrases in English. */
const untranslatedRemarks = (plan: StudyPlan): readonly string[] =>
  languagesOf(plan).flatMap((language) => {
    const missing = missingKeys(language, plan.phrases?.[language]);
    if (missing.length === 0) return [];
    const named = missing.length > 5 ? `${missing.slice(0, 5).join(', ')} …` : missing.join(', ');
    return [
      `Language ${language} lacks ${missing.length} of ${phraseKeys.length} phrases of the page (${named}): they are shown in English.`,
    ];
  });

/** Returns remarks about planned measures that no table of results can contain. */
const untestedRemarks = (plan: StudyPlan): readonly string[] =>
  plannedMeasures(plan).flatMap((measure) => {
    const [, of = '', id] = measure.split('/');
    const questionnaire = id === undefined ? null : questionnaireNamed(plan, of);
    if (!questionnaire || isNumeric(questionnaire, id ?? '')) return [];
    return [`Planned "${measure}" is not answered with a number and will not be tested.`];
  });

/** Returns the remarks for experimenters to read before the first participant comes; empty: none. */
export function remarksOn(plan: StudyPlan): readonly string[] {
  const { conditions, cohorts = [], tasks } = plan;
  const mirrored = [...conditions, ...cohorts].some(({ mirror }) => mirror);
  const unmirroredRemarks = tasks.flatMap((task) => {
    const { unmirrored } = games[task.game];
    return mirrored && unmirrored !== null ? [`${taskTitle(plan, task.id)}: ${unmirrored}.`] : [];
  });
  return [
    ...balanceRemarks(plan),
    ...sameBodyRemarks('Conditions', conditions),
    ...sameBodyRemarks('Cohorts', cohorts),
    ...untranslatedRemarks(plan),
    ...untestedRemarks(plan),
    ...unmirroredRemarks,
  ];
}
