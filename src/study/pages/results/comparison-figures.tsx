import { type GameDescription, type GameName, games } from 'threepoint-games/all';
import { inLanguage } from '../../model/phrases/localized-text';
import { languagesOf } from '../../model/plan/plan';
import type { AnswerForm } from '../../model/questionnaires/question-kind';
import { questionKind } from '../../model/questionnaires/question-kinds';
import { scaleRange } from '../../model/questionnaires/questionnaire-scores';
import { askedOf } from '../../model/results/measures';
import { barChart, type Chart, Figure, pairedChart, stripChart } from './charts';
import type { ShownComparison } from './shown-results';

/** Returns the figures of a chart: the means, and every pair of values or every participant of two cohorts. */
export function chartFigures({ results, labels, order, between }: ShownComparison, chart: Chart) {
  const { title, note, each } = chart;
  const file = results.fileOf(between ? `${chart.file}-cohorts` : chart.file);
  const legend = { labels, order, simulated: results.study.simulated };
  const every = between ? stripChart(chart, legend) : pairedChart({ ...chart, title: `${title}, pairs` }, legend);
  return (
    <div class="figures">
      <Figure svg={barChart(chart, legend)} caption={`${title}, means${between ? '' : note}`} file={file} />
      <Figure svg={every} caption={`${title}, every ${each}`} file={`${file}-${between ? 'strip' : 'pairs'}`} />
    </div>
  );
}

function axisOf(form: AnswerForm, [from, to]: readonly [number, number], language: string): string {
  const { low, high } = questionKind(form).ends?.(form) ?? {};
  if (low === undefined || high === undefined) return `answer, ${from} to ${to}`;
  const label = (text: typeof low) => inLanguage(text, language).toLowerCase();
  return `answer, ${from} ${label(low)} to ${to} ${label(high)}`;
}

/** Returns what captions add about the figure of the paper that shows the same of a game. */
function paperNote(game: string | undefined, shown: 'answers' | 'scores'): string {
  const description: GameDescription | undefined = game === undefined ? undefined : games[game as GameName];
  const figure = description?.paperFigures?.[shown];
  return figure === undefined ? '' : ` (the paper’s figure ${figure})`;
}

/** Returns a chart for the questions of a task and questionnaire that share a scale. */
export function questionCharts({ results, answers }: ShownComparison): readonly Chart[] {
  const { plan } = results.study;
  const [language] = languagesOf(plan);
  const charts = new Map<string, Chart>();
  for (const one of answers) {
    const { questionnaire, question } = askedOf(one, plan);
    const form = question?.answer;
    const range = form && questionKind(form).range(form);
    if (!questionnaire || !one.asked || !range) continue;
    const axis = axisOf(form, range, language);
    const key = `${one.asked.task} ${questionnaire.id} ${axis}`;
    const before = charts.get(key);
    const name = inLanguage(questionnaire.title, language);
    const task = results.titleOf(one.asked.task);
    const number = [...charts.keys()].filter((other) =>
      other.startsWith(`${one.asked?.task} ${questionnaire.id} `),
    ).length;
    charts.set(key, {
      title: `${task === name ? name : `${task}, ${name}`}: questionnaire`,
      file: `${one.asked.task === questionnaire.id ? '' : `${one.asked.task}-`}${questionnaire.id}-answers${number > 0 ? `-${number + 1}` : ''}`,
      axis,
      domain: range,
      nameOf: ({ asked: of }) => of?.question ?? '',
      note: paperNote(questionnaire.id, 'answers'),
      each: 'participant',
      ...before,
      comparisons: [...(before?.comparisons ?? []), one],
    });
  }
  return [...charts.values()];
}

/** Returns a chart for each scale, with all tasks side by side. */
export function scaleCharts({ results, scales }: ShownComparison): readonly Chart[] {
  const charts = new Map<string, Chart>();
  for (const one of scales) {
    const { questionnaire, scale } = askedOf(one, results.study.plan);
    if (!questionnaire || !scale) continue;
    const key = `${questionnaire.id}-${scale.id}`;
    const domain = scaleRange(questionnaire, scale);
    charts.set(key, {
      title: scale.label,
      file: key,
      axis: `${scale.label}, ${domain[0]} to ${domain[1]}`,
      domain,
      nameOf: ({ asked: of }) => results.titleOf(of?.task ?? ''),
      note: '',
      each: 'participant',
      comparisons: [...(charts.get(key)?.comparisons ?? []), one],
    });
  }
  return [...charts.values()];
}

/** Returns a chart for each task that has scores. */
export const scoreCharts = ({ results, percent }: ShownComparison): readonly Chart[] =>
  percent.map((comparison) => {
    const name = results.titleOf(comparison.of);
    const task = results.study.plan.tasks.find(({ id }) => id === comparison.of);
    return {
      comparisons: [comparison],
      title: `${name}: scores`,
      file: `${comparison.of}-scores`,
      axis: 'score in per cent of the maximum',
      domain: [0, 100],
      nameOf: () => name,
      note: paperNote(task?.game, 'scores'),
      each: (task?.groupSize ?? 1) === 1 ? 'participant' : 'group',
    };
  });
