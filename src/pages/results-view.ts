import { type Comparison, compareAnswers, compareScores, type Exclusion } from '../core/study/compare-conditions';
import { aboutIn } from '../core/study/exported-results';
import { frameTimes } from '../core/study/frame-times';
import { questionnairesOf } from '../core/study/plan';
import { plannedFamily } from '../core/study/planned';
import { comparisonTable, frameTimeTable } from '../core/study/result-tables';
import type { StudyRecord } from '../core/study/study-record';
import { answersIn, scalesIn, studyTables, trialsIn } from '../core/study/study-tables';
import { tidyCsv } from '../core/study/tidy-csv';
import { offerDownload } from '../ui/downloads';
import { button, element } from '../ui/element';
import { barChart, type ChartOptions, pairedChart } from './charts';
import { figure } from './figure';
import { questionFigures, scaleFigures } from './questionnaire-figures';
import { csvButton, fixed, meanCell, none, pText } from './result-cells';
import type { Compared, ShownStudy } from './shown-results';
import { tableNode } from './table';

const significance = 0.05;

function comparisonRows(comparisons: readonly Comparison[], digits: number, nameOf: (one: Comparison) => string) {
  return comparisons.map((one) => {
    const { test, signedRank } = one;
    const significant = (one.holmP ?? 1) < significance;
    return {
      look: significant ? 'significant' : '',
      cells: [
        nameOf(one),
        String(one.pairs.length),
        meanCell(one.first?.mean, one.first?.interval, digits),
        meanCell(one.second?.mean, one.second?.interval, digits),
        meanCell(test?.meanDifference, test?.interval, digits),
        fixed(test?.t, 3),
        test ? String(test.df) : none,
        pText(test?.p),
        meanCell(test?.dz ?? undefined, test?.dzInterval, 2),
        fixed(signedRank?.v, 1),
        meanCell(signedRank?.effect ?? undefined, signedRank?.effectInterval, 2),
        pText(signedRank?.p),
        pText(one.signedRankHolmP),
        `${pText(one.holmP)}${significant ? ' *' : ''}`,
      ],
    };
  });
}

const comparisonHeads = (unit: string, first: string, second: string) => [
  { text: unit },
  { text: 'n', title: 'Pairs', numeric: true },
  { text: first, numeric: true },
  { text: second, numeric: true },
  { text: 'difference', numeric: true },
  { text: 't', title: 'Paired t-test', numeric: true },
  { text: 'df', numeric: true },
  { text: 'p', title: 'Two-sided, of the t-test', numeric: true },
  { text: 'd_z', title: "Cohen's d of the differences, with its 95 % interval", numeric: true },
  { text: 'V', title: "Wilcoxon's signed ranks", numeric: true },
  { text: 'r', title: 'Rank-biserial correlation, the effect size of V, with its 95 % interval', numeric: true },
  { text: 'p (V)', title: 'Two-sided, of Wilcoxon’s test', numeric: true },
  { text: 'Holm p (V)', title: 'Wilcoxon’s p adjusted over the family', numeric: true },
  { text: 'Holm p', title: 'The t-test’s p adjusted over the family', numeric: true },
];

/** "P03, P07: voided: the phone rang (archery)"; alike reasons in one line. */
function exclusionList(all: readonly Exclusion[]): readonly string[] {
  const lines = new Map<string, { who: Set<string>; of: Set<string> }>();
  for (const { participant, of, reason } of all) {
    const line = lines.get(`${participant} ${reason}`) ?? { who: new Set(), of: new Set() };
    line.who.add(participant);
    line.of.add(of);
    lines.set(`${participant} ${reason}`, line);
  }
  return [...lines].map(([key, { who, of }]) => {
    const [participant] = [...who];
    return `${participant} (${[...of].join(', ')}): ${key.slice((participant?.length ?? 0) + 1)}`;
  });
}

function demographicsText(records: readonly StudyRecord[]): string {
  const people = records.flatMap((record) => (record.kind === 'demographics' ? [record.body] : []));
  if (people.length === 0) return 'No participant has answered the questions about themselves yet.';
  const ages = people.map(({ age }) => age);
  const mean = ages.reduce((sum, age) => sum + age, 0) / ages.length;
  const deviation = Math.sqrt(ages.reduce((sum, age) => sum + (age - mean) ** 2, 0) / Math.max(1, ages.length - 1));
  const count = (test: (one: (typeof people)[number]) => boolean) => people.filter(test).length;
  return (
    `${people.length} people, ${mean.toFixed(1)} years old on average (SD ${deviation.toFixed(1)}): ` +
    `${count(({ gender }) => gender === 'woman')} women, ${count(({ gender }) => gender === 'man')} men, ${count(({ gender }) => gender !== 'woman' && gender !== 'man')} others or not said; ` +
    `${count(({ handedness }) => handedness === 'right')} right-handed; ` +
    `${count(({ vision }) => vision !== 'normal')} with corrected or impaired vision; ` +
    `${count(({ vrExperience }) => vrExperience === 'none')} new to virtual reality.`
  );
}

function compared(study: ShownStudy, conditions: readonly [string, string]): Compared {
  const { plan, simulated, records, planVersion } = study;
  const versionPart = planVersion === undefined ? '' : `-version-${planVersion}`;
  const labelOf = (id: string) => plan.conditions.find((condition) => condition.id === id)?.label ?? id;
  return {
    study,
    conditions,
    answers: compareAnswers(answersIn(records, plan), conditions),
    scales: compareAnswers(scalesIn(records, plan), conditions),
    scores: compareScores(trialsIn(records), conditions),
    labels: { first: labelOf(conditions[0]), second: labelOf(conditions[1]) },
    labelOf,
    titleOf: (task) => plan.tasks.find(({ id }) => id === task)?.title ?? task,
    fileOf: (name) => `${simulated ? 'SIMULATED-' : ''}${plan.id}${versionPart}-${name}`,
  };
}

/** What stands above all results of simulated participants. */
export const simulatedNotice = ({ simulated }: Pick<ShownStudy, 'simulated'>): readonly Node[] => {
  const text = 'SIMULATED: a program made these data. They say nothing about people.';
  return simulated ? [element('p', { class: 'simulated', role: 'note' }, text)] : [];
};

/** Everything computed from a study: figures, tables, exclusions. `conditions`: first − second. */
export function studyResults(study: ShownStudy, conditions: readonly [string, string]): readonly Node[] {
  if (!study.records.some(({ kind }) => kind === 'answers' || kind === 'trial')) {
    return [element('p', { class: 'card' }, 'Nothing has been answered or played yet.')];
  }
  const results = compared(study, conditions);
  return [
    summary(results),
    ...plannedParts(results),
    ...answerParts(results),
    ...scaleParts(results),
    ...scoreParts(results),
    ...frameTimeParts(results),
    ...leftOutParts(results),
    ...exportParts(results),
  ];
}

const bar = (...buttons: readonly Node[]) => element('div', { class: 'bar' }, ...buttons);

function summary({ study: { plan, records }, answers, labels }: Compared): HTMLElement {
  const participants = new Set(records.map(({ participant }) => participant));
  return element(
    'section',
    { class: 'card' },
    element(
      'p',
      {},
      `${participants.size} of ${plan.participants} participants have records. ${demographicsText(records)}`,
    ),
    element(
      'p',
      { class: 'soft' },
      `Differences are ${labels.first} − ${labels.second}, paired within participants (scores of groups: within groups). Tests are two-sided; * marks Holm’s p below .05 over all ${answers.comparisons.length} questions.`,
    ),
  );
}

/** What the plan named beforehand, a family of its own; below it everything is shown once more, as explored. */
function plannedParts(results: Compared): readonly Node[] {
  const { study, answers, scales, scores, labels, titleOf } = results;
  const asked = questionnairesOf(study.plan);
  const all = [...answers.comparisons, ...scales.comparisons, ...scores.points.comparisons];
  const family = plannedFamily(all, study.plan);
  if (family.length === 0) {
    const text = 'The plan names no measure as planned: everything here is exploratory.';
    return [element('p', { class: 'soft', role: 'note' }, text)];
  }
  const name = (one: Comparison) => (one.asked ? `${one.of} ${aboutIn(asked, one)}` : `${titleOf(one.of)}, points`);
  return [
    element('h2', {}, 'Planned'),
    tableNode(
      `Planned comparisons: means with 95 % confidence intervals, and tests; Holm over these ${family.length} alone`,
      comparisonHeads('Measure', labels.first, labels.second),
      comparisonRows(family, 2, name),
    ),
    element(
      'p',
      { class: 'soft', role: 'note' },
      'Everything below is exploratory: Holm’s p there is over the table that it stands in.',
    ),
  ];
}

function answerParts(results: Compared): readonly Node[] {
  const { study, conditions, answers, labels, fileOf } = results;
  if (answers.comparisons.length === 0) return [];
  const asked = questionnairesOf(study.plan);
  const aboutOf = (one: Comparison) => aboutIn(asked, one);
  const facts = { conditions, simulated: study.simulated, aboutOf };
  return [
    element('h2', {}, 'Questionnaires'),
    ...questionFigures(asked, results),
    tableNode(
      'Paired comparisons of the answers: means with 95 % confidence intervals, and tests (the paper’s tables 9 and 10)',
      comparisonHeads('Question', labels.first, labels.second),
      comparisonRows(answers.comparisons, 2, (one) => `${one.of} ${aboutOf(one)}`),
    ),
    bar(csvButton(comparisonTable('answers-compared', answers.comparisons, facts), fileOf('answers-compared'))),
  ];
}

function scaleParts(results: Compared): readonly Node[] {
  const { study, conditions, scales, labels, titleOf, fileOf } = results;
  if (scales.comparisons.length === 0) return [];
  const asked = questionnairesOf(study.plan);
  const aboutOf = (one: Comparison) => aboutIn(asked, one);
  const facts = { conditions, simulated: study.simulated, aboutOf };
  const name = (one: Comparison) => `${aboutOf(one)}, ${titleOf(one.asked?.task ?? '')}`;
  return [
    element('h2', {}, 'Scales'),
    ...scaleFigures(asked, results),
    tableNode(
      `Paired comparisons of the scales: means with 95 % confidence intervals, and tests; Holm over all ${scales.comparisons.length} scales`,
      comparisonHeads('Scale', labels.first, labels.second),
      comparisonRows(scales.comparisons, 2, name),
    ),
    bar(csvButton(comparisonTable('scales-compared', scales.comparisons, facts), fileOf('scales-compared'))),
  ];
}

function scoreParts(results: Compared): readonly Node[] {
  const { study, conditions, scores, labels, titleOf, fileOf } = results;
  const { points, percent } = scores;
  const both = [...points.comparisons, ...percent.comparisons];
  const table = comparisonTable('scores-compared', both, { conditions, simulated: study.simulated, aboutOf: () => '' });
  return [
    element('h2', {}, 'Scores'),
    ...percent.comparisons.map((comparison) => scoreFigures(results, comparison)),
    tableNode(
      'Paired comparisons of the scores: means of the blocks’ trials with 95 % confidence intervals, and tests',
      comparisonHeads('Task', labels.first, labels.second),
      [
        ...comparisonRows(points.comparisons, 2, ({ of }) => `${titleOf(of)}, points`),
        ...comparisonRows(percent.comparisons, 2, ({ of }) => `${titleOf(of)}, per cent`),
      ],
    ),
    bar(csvButton(table, fileOf('scores-compared'))),
  ];
}

function scoreFigures(
  { study: { plan, simulated }, labels, titleOf, fileOf }: Compared,
  comparison: Comparison,
): HTMLElement {
  const name = titleOf(comparison.of);
  const task = plan.tasks.find(({ id }) => id === comparison.of);
  const alone = (task?.groupSize ?? 1) === 1;
  const options: Omit<ChartOptions, 'title'> = {
    labels,
    simulated,
    nameOf: () => name,
    axis: 'score in per cent of the maximum',
    domain: [0, 100],
  };
  return element(
    'div',
    { class: 'figures' },
    figure(
      barChart([comparison], { title: `${name}: scores`, ...options }),
      `${name}: mean scores (the paper’s figure ${task?.game === 'ball' ? 14 : 12})`,
      fileOf(`${comparison.of}-scores`),
    ),
    figure(
      pairedChart([comparison], { title: `${name}: scores, pairs`, ...options }),
      `${name}: every ${alone ? 'participant' : 'group'}`,
      fileOf(`${comparison.of}-scores-pairs`),
    ),
  );
}

const frameTimeHeads = [
  { text: 'Task' },
  { text: 'Condition' },
  { text: 'Stage' },
  { text: 'trials', numeric: true },
  { text: 'frames', numeric: true },
  { text: 'min', numeric: true },
  { text: 'max', numeric: true },
  { text: 'mean', numeric: true },
  { text: 'worst p95', numeric: true, title: 'Largest of the trials’ 95th percentiles' },
  { text: 'late', numeric: true, title: 'Frames shown later than the device wanted' },
] as const;

function frameTimeParts({ study: { simulated, records }, titleOf, labelOf, fileOf }: Compared): readonly Node[] {
  const times = frameTimes(records);
  const lateText = (missed: number, frames: number) =>
    `${missed} (${((100 * missed) / Math.max(1, frames)).toFixed(1)} %)`;
  return [
    element('h2', {}, 'Frame times'),
    tableNode(
      'Work of the page per frame [ms] (the paper’s tables 5 and 6)',
      frameTimeHeads,
      times.map((row) => ({
        cells: [
          titleOf(row.task),
          labelOf(row.condition),
          row.stage,
          String(row.trials),
          String(row.frames),
          fixed(row.minMs, 2),
          fixed(row.maxMs, 2),
          fixed(row.meanMs, 2),
          fixed(row.worstP95Ms, 2),
          row.stage === 'frame' ? lateText(row.missed, row.frames) : '',
        ],
      })),
    ),
    bar(csvButton(frameTimeTable(times, simulated), fileOf('frame-times'))),
  ];
}

const listNode = (lines: readonly string[]) => element('ul', {}, ...lines.map((line) => element('li', {}, line)));

function leftOutParts({ study: { records }, answers, scales, scores }: Compared): readonly Node[] {
  const excluded = exclusionList([
    ...answers.excluded,
    ...scales.excluded,
    ...scores.points.excluded.filter(notTutorial),
  ]);
  const assisted = records.flatMap((record) => {
    if (record.kind !== 'trial' || record.body.outcome.assists.length === 0) return [];
    const { place, outcome } = record.body;
    return [`${record.participant}, ${place.task} block ${place.block}: ${outcome.assists.join(', ')}`];
  });
  return [
    element('h2', {}, 'Left out'),
    excluded.length === 0
      ? element('p', {}, 'Nothing was left out, and every participant has both conditions.')
      : listNode(excluded),
    element('p', { class: 'soft' }, 'Tutorials and attempts that were interrupted are recorded and never evaluated.'),
    ...(assisted.length === 0 ? [] : [element('h2', {}, 'Played with aids'), listNode(assisted)]),
  ];
}

const exportParts = ({ study: { plan, records }, fileOf }: Compared): readonly Node[] => [
  element('h2', {}, 'Tables of the export'),
  bar(
    ...studyTables(records, plan).map((table) =>
      button(
        `${table.name}.csv`,
        () => offerDownload(`${fileOf(table.name)}.csv`, 'text/csv;charset=utf-8', tidyCsv(table)),
        { class: 'small' },
      ),
    ),
  ),
];

const notTutorial = ({ reason }: Exclusion) => reason !== 'tutorial';
