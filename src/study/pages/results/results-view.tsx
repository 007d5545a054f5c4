import { type Choice, chooser, element } from 'threepoint-ui';
import type { StudyPlan } from '../../model/plan/plan';
import type { StudyRecord } from '../../model/records/study-record';
import { cohortViews, hasOverallAnalysis } from '../../model/results/exported-results';
import type { Exclusion } from '../../model/results/measures';
import { studyTables } from '../../model/tables/study-tables';
import { meanSummary } from '../../statistics/summaries';
import { frameTimeParts } from './frame-time-results';
import { overallResults } from './overall-results';
import { bar, csvButton } from './result-cells';
import { type ShownResults, type ShownStudy, shownResults } from './shown-results';
import { cohortResults, pairResults } from './two-sided-results';

/** The sides that are compared on the page: first − second. */
export interface Selection {
  /** null: the plan has one condition. */
  readonly conditions: readonly [string, string] | null;
  /** null: the plan has no cohorts. */
  readonly cohorts: readonly [string, string] | null;
  /** The conditions under which cohorts are compared. */
  readonly under: readonly string[];
}

/** Returns the initial selection: the second entry of the plan against the first, which is the reference. */
export function firstSelection(plan: Pick<StudyPlan, 'conditions' | 'cohorts'>): Selection {
  const pairOf = ([baseline, other]: readonly { readonly id: string }[]) =>
    baseline && other ? ([other.id, baseline.id] as const) : null;
  const [under = []] = cohortViews(plan);
  return { conditions: pairOf(plan.conditions), cohorts: pairOf(plan.cohorts ?? []), under };
}

/** Returns lines such as "P03 (archery, ball): voided: the phone rang", one for each participant and reason. */
function exclusionList(all: readonly Exclusion[]): readonly string[] {
  const lines = new Map<string, { readonly participant: string; readonly reason: string; readonly of: Set<string> }>();
  for (const { participant, of, reason } of all) {
    const key = `${participant} ${reason}`;
    const line = lines.get(key) ?? { participant, reason, of: new Set<string>() };
    line.of.add(of);
    lines.set(key, line);
  }
  return [...lines.values()].map(({ participant, reason, of }) => `${participant} (${[...of].join(', ')}): ${reason}`);
}

function demographicsText(records: readonly StudyRecord[]): string {
  const people = records.flatMap((record) => (record.kind === 'demographics' ? [record.body] : []));
  if (people.length === 0) return 'No participant has answered the questions about themselves yet.';
  const { mean, standardDeviation } = meanSummary(people.map(({ age }) => age));
  const count = (test: (one: (typeof people)[number]) => boolean) => people.filter(test).length;
  return (
    `${people.length} people, ${mean.toFixed(1)} years old on average (SD ${(standardDeviation ?? 0).toFixed(1)}): ` +
    `${count(({ gender }) => gender === 'woman')} women, ${count(({ gender }) => gender === 'man')} men, ${count(({ gender }) => gender !== 'woman' && gender !== 'man')} others or not said; ` +
    `${count(({ handedness }) => handedness === 'right')} right-handed; ` +
    `${count(({ vision }) => vision !== 'normal')} with corrected or impaired vision; ` +
    `${count(({ vrExperience }) => vrExperience === 'none')} new to virtual reality.`
  );
}

/** Returns the notice above all results of simulated participants. */
export const simulatedNotice = ({ simulated }: Pick<ShownStudy, 'simulated'>): readonly Node[] => {
  const text = 'SIMULATED: a program made these data. They say nothing about people.';
  return simulated ? [element('p', { class: 'simulated', role: 'note' }, text)] : [];
};

/** Returns everything computed from a study: figures, tables, exclusions. `choose` is called with another selection. */
export function studyResults(
  study: ShownStudy,
  selection: Selection,
  choose: (selection: Selection) => void,
): readonly Node[] {
  if (!study.records.some(({ kind }) => kind === 'answers' || kind === 'trial')) {
    return [element('p', { class: 'card' }, 'Nothing has been answered or played yet.')];
  }
  const results = shownResults(study);
  const pairs = conditionParts(results, selection, choose);
  return [
    ...summary(results),
    ...overallResults(results),
    ...pairs.nodes,
    ...cohortParts(results, selection, choose),
    ...frameTimeParts(results),
    ...leftOutParts(results, pairs.excluded),
    ...exportParts(results),
  ];
}

function summary({ study: { plan, records }, measures }: ShownResults): readonly Node[] {
  const participants = new Set(records.map(({ participant }) => participant));
  const text = `${participants.size} of ${plan.participants} participants have records. ${demographicsText(records)}`;
  const planned =
    measures.planned.length === 0
      ? 'The plan names no measure as planned: everything here is exploratory.'
      : 'Planned measures come first, as a separate family. All other tables are exploratory; planned measures are marked in them.';
  return [
    element(
      'section',
      { class: 'card' },
      element('p', {}, text),
      element('p', { class: 'soft', role: 'note' }, planned),
    ),
  ];
}

type Choose = (selection: Selection) => void;

function conditionParts(results: ShownResults, selection: Selection, choose: Choose) {
  const { conditions } = selection;
  const { plan } = results.study;
  if (!conditions) {
    const { answers, scales, points } = results.measures;
    return { nodes: [], excluded: [...answers, ...scales, ...points].flatMap(({ voided }) => voided) };
  }
  const head = [
    element('h2', {}, hasOverallAnalysis(plan) ? 'Two conditions' : 'Both conditions'),
    ...pairChooser('condition', plan.conditions, conditions, (pair) => choose({ ...selection, conditions: pair })),
  ];
  if (conditions[0] === conditions[1]) {
    const complaint = element('p', { class: 'complaint' }, 'Choose two different conditions.');
    return { nodes: [...head, complaint], excluded: [] };
  }
  const { nodes, excluded } = pairResults(results, conditions);
  return { nodes: [...head, ...nodes], excluded };
}

function cohortParts(results: ShownResults, selection: Selection, choose: Choose): readonly Node[] {
  const { cohorts, under } = selection;
  const { plan } = results.study;
  if (!cohorts) return [];
  const views = cohortViews(plan).map((view) => ({
    id: view.join(' '),
    label: view.length === 1 ? results.labelOf(view[0] ?? '') : 'all conditions, the mean of each participant',
  }));
  const choosing = [
    ...pairChooser('cohort', plan.cohorts ?? [], cohorts, (pair) => choose({ ...selection, cohorts: pair })),
    ...(views.length === 1
      ? []
      : [bar(chooser('Under', views, under.join(' '), (id) => choose({ ...selection, under: id.split(' ') })))]),
  ];
  return [
    element('h2', {}, 'Two cohorts'),
    ...choosing,
    ...(cohorts[0] === cohorts[1]
      ? [element('p', { class: 'complaint' }, 'Choose two different cohorts.')]
      : cohortResults(results, { sides: cohorts, conditions: under })),
  ];
}

/** Returns the choice of which two of several `what` are compared; nothing if there are only two. */
function pairChooser(
  what: 'condition' | 'cohort',
  choices: readonly Choice[],
  [first, second]: readonly [string, string],
  choose: (pair: readonly [string, string]) => void,
): readonly Node[] {
  if (choices.length < 3) return [];
  return [
    bar(
      chooser(`Compare ${what}`, choices, first, (id) => choose([id, second])),
      chooser(`with ${what}`, choices, second, (id) => choose([first, id])),
    ),
  ];
}

const listNode = (lines: readonly string[]) => element('ul', {}, ...lines.map((line) => element('li', {}, line)));

function leftOutParts({ study: { records } }: ShownResults, all: readonly Exclusion[]): readonly Node[] {
  const excluded = exclusionList(all);
  const assisted = records.flatMap((record) => {
    if (record.kind !== 'trial' || record.body.outcome.assists.length === 0) return [];
    const { place, outcome } = record.body;
    return [`${record.participant}, ${place.task} block ${place.block}: ${outcome.assists.join(', ')}`];
  });
  return [
    element('h2', {}, 'Left out'),
    excluded.length === 0 ? element('p', {}, 'Nothing was left out of the comparisons above.') : listNode(excluded),
    element('p', { class: 'soft' }, 'Tutorials and interrupted attempts are recorded but not evaluated.'),
    ...(assisted.length === 0 ? [] : [element('h2', {}, 'Played with aids'), listNode(assisted)]),
  ];
}

const exportParts = ({ study: { plan, records }, fileOf }: ShownResults): readonly Node[] => [
  element('h2', {}, 'Tables of the export'),
  bar(...studyTables(records, plan).map((table) => csvButton(table, fileOf(table.name), `${table.name}.csv`))),
];
