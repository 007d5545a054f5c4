import type { Comparison } from '../core/study/compare-conditions';
import { languagesOf } from '../core/study/plan';
import type { AnswerForm } from '../core/study/questionnaire-schema';
import { scaleRange } from '../core/study/questionnaire-scores';
import type { Questionnaire } from '../core/study/questionnaires';
import { inLanguage } from '../core/study/words';
import { element } from '../ui/element';
import { barChart, pairedChart } from './charts';
import { figure } from './figure';
import type { Compared } from './shown-results';

/** Comparisons on one scale, in one picture. */
interface Chart {
  readonly comparisons: readonly Comparison[];
  readonly title: string;
  readonly file: string;
  readonly axis: string;
  readonly domain: readonly [number, number];
  readonly nameOf: (one: Comparison) => string;
  /** Behind the caption of the means. */
  readonly note: string;
}

function chartNodes({ study: { simulated }, labels, fileOf }: Compared, chart: Chart): Node {
  const { comparisons, title, file, note, ...options } = chart;
  const both = { labels, simulated, ...options };
  return element(
    'div',
    { class: 'figures' },
    figure(barChart(comparisons, { title, ...both }), `${title}, means${note}`, fileOf(file)),
    figure(
      pairedChart(comparisons, { title: `${title}, pairs`, ...both }),
      `${title}, every participant`,
      fileOf(`${file}-pairs`),
    ),
  );
}

type Ranged = Extract<AnswerForm, { from: number }>;

function axisOf(form: Ranged, language: string): string {
  const labels = form.kind === 'likert' ? form.labels : undefined;
  const ends = form.kind === 'number' ? undefined : form.ends;
  const low = labels?.[0] ?? ends?.low;
  const high = labels?.at(-1) ?? ends?.high;
  if (low === undefined || high === undefined) return `answer, ${form.from} to ${form.to}`;
  const said = (text: typeof low) => inLanguage(text, language).toLowerCase();
  return `answer, ${form.from} ${said(low)} to ${form.to} ${said(high)}`;
}

/** The figure of the paper that shows these answers, in words. */
const paperFigures: Readonly<Record<string, string>> = {
  archery: ' (the paper’s figure 11)',
  ball: ' (the paper’s figure 13)',
};

/** Figures of the questions: those of one task and questionnaire that are answered on the same scale together. */
export function questionFigures(asked: readonly Questionnaire[], results: Compared): readonly Node[] {
  const { plan } = results.study;
  const [language] = languagesOf(plan);
  const charts = new Map<string, Chart>();
  for (const one of results.answers.comparisons) {
    const questionnaire = asked.find(({ id }) => id === one.asked?.questionnaire);
    const form = questionnaire?.questions.find(({ id }) => id === one.asked?.question)?.answer;
    if (!questionnaire || !one.asked || !form || form.kind === 'choice' || form.kind === 'text') continue;
    const axis = axisOf(form, language);
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
      domain: [form.from, form.to],
      nameOf: ({ asked: of }) => of?.question ?? '',
      note: paperFigures[questionnaire.id] ?? '',
      ...before,
      comparisons: [...(before?.comparisons ?? []), one],
    });
  }
  return [...charts.values()].map((chart) => chartNodes(results, chart));
}

/** A figure for each scale, all tasks side by side. */
export function scaleFigures(asked: readonly Questionnaire[], results: Compared): readonly Node[] {
  const charts = new Map<string, Chart>();
  for (const one of results.scales.comparisons) {
    const questionnaire = asked.find(({ id }) => id === one.asked?.questionnaire);
    const scale = questionnaire?.scales.find(({ id }) => id === one.asked?.question);
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
      comparisons: [...(charts.get(key)?.comparisons ?? []), one],
    });
  }
  return [...charts.values()].map((chart) => chartNodes(results, chart));
}
