import {
  type Comparison,
  compareAnswers,
  compareScores,
  type Exclusion,
  type Results,
} from '../core/study/compare-conditions';
import { frameTimes } from '../core/study/frame-times';
import { checkedPaperRows, paperDf, paperFrameTimes, paperScores, savedShare } from '../core/study/paper-tables';
import type { StudyPlan } from '../core/study/plan';
import { questionnaires } from '../core/study/questionnaires';
import { comparisonTable, frameTimeTable, paperTable } from '../core/study/result-tables';
import type { Interval } from '../core/study/statistics';
import type { StudyRecord } from '../core/study/study-record';
import { answersIn, studyTables, trialsIn } from '../core/study/study-tables';
import { type Table, tidyCsv } from '../core/study/tidy-csv';
import { offerDownload } from '../ui/downloads';
import { button, element } from '../ui/element';
import { barChart, type ChartOptions, pairedChart, pngOf, svgText } from './charts';
import { tableNode } from './table';

/** What the results are computed from. */
export interface ShownStudy {
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  readonly records: readonly StudyRecord[];
}

const none = '–';
const fixed = (value: number | null | undefined, digits: number) =>
  value == null ? none : value.toFixed(digits).replace('-', '−');
const pText = (p: number | null | undefined) =>
  p == null ? none : p < 0.0005 ? '< .001' : p.toFixed(3).replace(/^0/, '');
const interval = (between: Interval | null | undefined, digits: number) =>
  between ? `[${fixed(between.low, digits)}, ${fixed(between.high, digits)}]` : '';
const meanCell = (mean: number | undefined, between: Interval | null | undefined, digits: number): Node =>
  element('div', {}, fixed(mean, digits), element('div', { class: 'soft interval' }, interval(between, digits)));

const significance = 0.05;

const aboutOf = (id: string) =>
  Object.values(questionnaires)
    .flatMap(({ questions }) => questions)
    .find((question) => question.id === id);

const csvButton = (table: Table, file: string) =>
  button('CSV', () => offerDownload(`${file}.csv`, 'text/csv;charset=utf-8', tidyCsv(table)), { class: 'small' });

function figure(svg: SVGSVGElement, caption: string, file: string): HTMLElement {
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', caption);
  return element(
    'figure',
    {},
    svg,
    element(
      'div',
      { class: 'bar' },
      element('figcaption', { class: 'soft' }, caption),
      button('SVG', () => offerDownload(`${file}.svg`, 'image/svg+xml', svgText(svg)), { class: 'small' }),
      button('PNG', () => void pngOf(svg).then((blob) => offerDownload(`${file}.png`, 'image/png', blob)), {
        class: 'small',
      }),
    ),
  );
}

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
        fixed(test?.dz, 2),
        fixed(signedRank?.v, 1),
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
  { text: 'd_z', title: "Cohen's d of the differences", numeric: true },
  { text: 'V', title: "Wilcoxon's signed ranks", numeric: true },
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
  if (people.length === 0) return 'Nobody has told anything about themselves yet.';
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

/** Everything computed from a study: figures, tables, exclusions. `conditions`: first − second. */
export function studyResults(study: ShownStudy, conditions: readonly [string, string]): readonly Node[] {
  const { plan, simulated, records } = study;
  const label = (id: string) => plan.conditions.find((condition) => condition.id === id)?.label ?? id;
  const labels = { first: label(conditions[0]), second: label(conditions[1]) };
  const mark = simulated ? 'SIMULATED-' : '';
  const fileOf = (name: string) => `${mark}${plan.id}-${name}`;
  const participants = new Set(records.map(({ participant }) => participant));
  const notice = simulated
    ? [
        element(
          'p',
          { class: 'simulated', role: 'note' },
          'SIMULATED: a program made these data. They say nothing about people.',
        ),
      ]
    : [];
  if (!records.some(({ kind }) => kind === 'answers' || kind === 'trial')) {
    return [...notice, element('p', { class: 'card' }, 'Nothing has been answered or played yet.')];
  }
  const answers = compareAnswers(answersIn(records), conditions);
  const scores = compareScores(trialsIn(records), conditions);
  const times = frameTimes(records);
  const titleOf = (task: string) => plan.tasks.find(({ id }) => id === task)?.title ?? task;

  const chartOptions = (title: string, rest: Pick<ChartOptions, 'nameOf' | 'axis' | 'domain'>): ChartOptions => ({
    title,
    labels,
    simulated,
    ...rest,
  });
  const answerScale = {
    nameOf: ({ of }: Comparison) => of,
    axis: 'answer, 1 very poor to 5 excellent',
    domain: [1, 5] as const,
  };

  const questionnaireParts = Object.values(questionnaires).flatMap((questionnaire) => {
    const ids = questionnaire.questions.map(({ id }) => id);
    const comparisons = answers.comparisons.filter(({ of }) => ids.includes(of));
    if (comparisons.length === 0) return [];
    const paperFigure = questionnaire.id === 'archery' ? 11 : 13;
    const name = `${questionnaire.title}: questionnaire`;
    return [
      element(
        'div',
        { class: 'figures' },
        figure(
          barChart(comparisons, chartOptions(name, answerScale)),
          `${name}, means (the paper’s figure ${paperFigure})`,
          fileOf(`${questionnaire.id}-answers`),
        ),
        figure(
          pairedChart(comparisons, chartOptions(`${name}, pairs`, answerScale)),
          `${name}, every participant`,
          fileOf(`${questionnaire.id}-answers-pairs`),
        ),
      ),
    ];
  });

  const scoreParts = scores.percent.comparisons.map((comparison) => {
    const name = titleOf(comparison.of);
    const domain = { nameOf: () => name, axis: 'score in per cent of the maximum', domain: [0, 100] as const };
    const task = plan.tasks.find(({ id }) => id === comparison.of);
    const paperFigure = task?.game === 'ball' ? 14 : 12;
    const alone = (task?.groupSize ?? 1) === 1;
    return element(
      'div',
      { class: 'figures' },
      figure(
        barChart([comparison], chartOptions(`${name}: scores`, domain)),
        `${name}: mean scores (the paper’s figure ${paperFigure})`,
        fileOf(`${comparison.of}-scores`),
      ),
      figure(
        pairedChart([comparison], chartOptions(`${name}: scores, pairs`, domain)),
        `${name}: every ${alone ? 'participant' : 'group'}`,
        fileOf(`${comparison.of}-scores-pairs`),
      ),
    );
  });

  const answerTable = comparisonTable('answers-compared', answers.comparisons, conditions, simulated);
  const scoreTable = comparisonTable(
    'scores-compared',
    [...scores.points.comparisons, ...scores.percent.comparisons],
    conditions,
    simulated,
  );
  const excluded = exclusionList([...answers.excluded, ...scores.points.excluded.filter(notTutorial)]);
  const assisted = records.flatMap((record) =>
    record.kind === 'trial' && record.body.outcome.assists.length > 0
      ? [
          `${record.participant}, ${record.body.place.task} block ${record.body.place.block}: ${record.body.outcome.assists.join(', ')}`,
        ]
      : [],
  );
  const raw = studyTables(records);

  return [
    ...notice,
    element(
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
    ),
    element('h2', {}, 'Questionnaires'),
    ...questionnaireParts,
    tableNode(
      'Paired comparisons of the answers: means with 95 % confidence intervals, and tests (the paper’s tables 9 and 10)',
      comparisonHeads('Question', labels.first, labels.second),
      comparisonRows(answers.comparisons, 2, ({ of }) => `${of} ${aboutOf(of)?.about ?? ''}`),
    ),
    element('div', { class: 'bar' }, csvButton(answerTable, fileOf('answers-compared'))),
    element('h2', {}, 'Scores'),
    ...scoreParts,
    tableNode(
      'Paired comparisons of the scores: means of the blocks’ trials with 95 % confidence intervals, and tests',
      comparisonHeads('Task', labels.first, labels.second),
      [
        ...comparisonRows(scores.points.comparisons, 2, ({ of }) => `${titleOf(of)}, points`),
        ...comparisonRows(scores.percent.comparisons, 2, ({ of }) => `${titleOf(of)}, per cent`),
      ],
    ),
    element('div', { class: 'bar' }, csvButton(scoreTable, fileOf('scores-compared'))),
    element('h2', {}, 'Frame times'),
    tableNode(
      'Work of the page per frame [ms] (the paper’s tables 5 and 6)',
      [
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
      ],
      times.map((row) => ({
        cells: [
          titleOf(row.task),
          label(row.condition),
          row.stage,
          String(row.trials),
          String(row.frames),
          fixed(row.minMs, 2),
          fixed(row.maxMs, 2),
          fixed(row.meanMs, 2),
          fixed(row.worstP95Ms, 2),
          row.stage === 'frame' ? `${row.missed} (${((100 * row.missed) / Math.max(1, row.frames)).toFixed(1)} %)` : '',
        ],
      })),
    ),
    element('div', { class: 'bar' }, csvButton(frameTimeTable(times, simulated), fileOf('frame-times'))),
    element('h2', {}, 'Left out'),
    excluded.length === 0
      ? element('p', {}, 'Nothing was left out, and everybody has both conditions.')
      : element('ul', {}, ...excluded.map((line) => element('li', {}, line))),
    element('p', { class: 'soft' }, 'Tutorials and attempts that were interrupted are recorded and never evaluated.'),
    ...(assisted.length === 0
      ? []
      : [element('h2', {}, 'Played with aids'), element('ul', {}, ...assisted.map((line) => element('li', {}, line)))]),
    element('h2', {}, 'Tables of the export'),
    element(
      'div',
      { class: 'bar' },
      ...raw.map((table) =>
        button(
          `${table.name}.csv`,
          () => offerDownload(`${fileOf(table.name)}.csv`, 'text/csv;charset=utf-8', tidyCsv(table)),
          { class: 'small' },
        ),
      ),
    ),
  ];
}

const notTutorial = ({ reason }: Exclusion) => reason !== 'tutorial';

/** Whether results hold anything to compare. */
export const comparable = (results: Results): boolean => results.comparisons.some(({ test }) => test !== null);

/** The paper's printed numbers, recomputed from its t values and tables. */
export function paperCheck(): readonly Node[] {
  const rows = checkedPaperRows();
  const wrong = rows.filter(({ follows }) => !follows).map(({ question }) => question);
  return [
    element('h2', {}, 'The paper’s own numbers'),
    element(
      'p',
      {},
      `From the t values of its tables 9 and 10 with ${paperDf} degrees of freedom every p is computed anew. Printed values that do not follow from their t: ${wrong.join(' and ')}. The paper corrects for none of its twelve tests; Holm’s correction stands beside.`,
    ),
    tableNode(
      'Anvari, Park and Kim 2023, tables 9 and 10, recomputed',
      [
        { text: 'Question' },
        { text: 'ours', numeric: true },
        { text: 'IK', numeric: true },
        { text: 't', numeric: true },
        { text: 'printed p', numeric: true },
        { text: 'p from t', numeric: true },
        { text: 'd_z', numeric: true },
        { text: 'Holm p', numeric: true },
        { text: 'printed p follows?' },
      ],
      rows.map(({ question, ours, ik, t, printedP, p, dz, holmP, follows }) => ({
        look: follows ? '' : 'wrong',
        cells: [
          `${question} ${aboutOf(question)?.about ?? ''}`,
          fixed(ours, 2),
          fixed(ik, 2),
          fixed(t, 3),
          fixed(printedP, 3),
          p < 0.001 ? p.toFixed(4) : p.toFixed(3),
          fixed(dz, 2),
          pText(holmP),
          follows ? 'yes' : `no: p = ${p < 0.001 ? p.toFixed(4) : p.toFixed(3)}`,
        ],
      })),
    ),
    element('div', { class: 'bar' }, csvButton(paperTable(), 'paper-check')),
    element(
      'ul',
      {},
      ...paperScores.map(({ task, maximum, ours, ik, printedPercent }) =>
        element(
          'li',
          {},
          `Score, ${task}: ${ours} and ${ik} of ${maximum} points are ${((100 * ours) / maximum).toFixed(2)} and ${((100 * ik) / maximum).toFixed(2)} %; printed ${printedPercent.ours} and ${printedPercent.ik} %.`,
        ),
      ),
      ...paperFrameTimes.map((times) =>
        element(
          'li',
          {},
          `Frame time, ${times.title}: ${times.ours.meanMs} against ${times.ik.meanMs} ms saves ${(100 * savedShare(times)).toFixed(0)} %; the text says approximately 60 %.`,
        ),
      ),
    ),
  ];
}
