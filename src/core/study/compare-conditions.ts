import { holm } from '../statistics/holm';
import { type PairedTTest, pairedTTest, type SignedRankTest, signedRankTest } from '../statistics/paired-tests';
import { type MeanSummary, meanSummary } from '../statistics/summaries';
import type { AnswerRow } from './answer-tables';
import { refuseMixture, type TrialRow } from './study-tables';

/** A participant or an answer left out, and why: results state it. */
export interface Exclusion {
  readonly participant: string;
  /** What it concerns: a question or a task. */
  readonly of: string;
  readonly reason: string;
}

/** A question, or a scale, of a questionnaire after a task. */
export type Asked = Pick<AnswerRow, 'task' | 'questionnaire' | 'question'>;

/** One question, or one score, under two conditions. */
export interface Comparison {
  /** "Q1", or the id of a task; of a question that is asked in more than one place: "archery/nasa-tlx/mental". */
  readonly of: string;
  /** What was asked where; null: scores. */
  readonly asked: Asked | null;
  readonly unit: 'answer' | 'points' | 'percent';
  /** null: no participant has both. */
  readonly first: MeanSummary | null;
  readonly second: MeanSummary | null;
  /** The pairs, in the order of the participants (or groups): for paired plots. */
  readonly pairs: readonly { readonly who: string; readonly first: number; readonly second: number }[];
  readonly test: PairedTTest | null;
  readonly signedRank: SignedRankTest | null;
  /** Adjusted over the family of comparisons made together. */
  readonly holmP: number | null;
  readonly signedRankHolmP: number | null;
}

export interface Results {
  readonly simulated: boolean;
  readonly comparisons: readonly Comparison[];
  readonly excluded: readonly Exclusion[];
}

type Pair = Comparison['pairs'][number];

interface Series {
  readonly of: string;
  readonly asked: Asked | null;
  readonly unit: Comparison['unit'];
  readonly pairs: readonly Pair[];
}

const bothTested = ({ pairs }: Series) => ({
  first: pairs.map(({ first }) => first),
  second: pairs.map(({ second }) => second),
});

function compared(series: readonly Series[]): readonly Comparison[] {
  const single = series.map((one) => {
    const { first, second } = bothTested(one);
    if (one.pairs.length === 0) return { ...one, first: null, second: null, test: null, signedRank: null };
    return {
      ...one,
      first: meanSummary(first),
      second: meanSummary(second),
      test: pairedTTest(first, second),
      signedRank: signedRankTest(first, second),
    };
  });
  const holmP = holm(single.map(({ test }) => test?.p ?? null));
  const signedRankHolmP = holm(single.map(({ signedRank }) => signedRank?.p ?? null));
  return single.map((one, index) => ({
    ...one,
    holmP: holmP[index] ?? null,
    signedRankHolmP: signedRankHolmP[index] ?? null,
  }));
}

interface Observation {
  readonly who: string;
  readonly condition: string;
  readonly value: number;
}

/** The mean of what each has under either condition, for those who have both; the others are named. */
function paired(
  observations: readonly Observation[],
  conditions: readonly [string, string],
): { readonly pairs: readonly Pair[]; readonly alone: readonly { readonly who: string; readonly missing: string }[] } {
  const values = new Map<string, Record<string, number[]>>();
  for (const { who, condition, value } of observations) {
    const own = values.get(who) ?? {};
    values.set(who, own);
    own[condition] = [...(own[condition] ?? []), value];
  }
  const mean = (of: readonly number[]) => of.reduce((sum, value) => sum + value, 0) / of.length;
  const pairs: Pair[] = [];
  const alone: { who: string; missing: string }[] = [];
  for (const [who, own] of [...values].toSorted(([a], [b]) => (a < b ? -1 : 1))) {
    const [first, second] = conditions.map((condition) => own[condition]);
    if (first && second) pairs.push({ who, first: mean(first), second: mean(second) });
    else alone.push({ who, missing: (first ? conditions[1] : conditions[0]) as string });
  }
  return { pairs, alone };
}

/** Who has something recorded under one condition but not, or not validly, under the other. */
const incomplete = (alone: readonly { readonly who: string; readonly missing: string }[], of: string): Exclusion[] =>
  alone.map(({ who, missing }) => ({ participant: who, of, reason: `no valid value under "${missing}"` }));

/** What is asked with a number, in the order first met, and what each is called: its id, where that is of one place alone. */
export function askedIn(rows: readonly AnswerRow[]): readonly { readonly of: string; readonly asked: Asked }[] {
  const places = new Map<string, Asked>();
  for (const { task, questionnaire, question, answer } of rows) {
    const key = `${task}/${questionnaire}/${question}`;
    if (typeof answer === 'number' && !places.has(key)) places.set(key, { task, questionnaire, question });
  }
  const times = new Map<string, number>();
  for (const { question } of places.values()) times.set(question, (times.get(question) ?? 0) + 1);
  return [...places].map(([key, asked]) => ({ of: times.get(asked.question) === 1 ? asked.question : key, asked }));
}

/** Whether a row answers this question. */
export const isOf = (row: AnswerRow, { task, questionnaire, question }: Asked) =>
  row.question === question && row.questionnaire === questionnaire && row.task === task;

/**
 * Every question (or scale) that is answered with a number compared between two conditions, first − second, as one family for
 * Holm's correction. Only participants with both values count; who is left out is stated. Throws where simulated rows and rows
 * of people are mixed.
 */
export function compareAnswers(rows: readonly AnswerRow[], conditions: readonly [string, string]): Results {
  refuseMixture(rows);
  const excluded: Exclusion[] = [];
  const series = askedIn(rows).map(({ of, asked }): Series => {
    const relevant = rows.filter((row) => isOf(row, asked) && conditions.includes(row.condition));
    for (const { participant, excluded: reason } of relevant) {
      if (reason) excluded.push({ participant, of, reason });
    }
    const { pairs, alone } = paired(
      relevant.flatMap(({ participant, condition, answer, excluded: reason }) =>
        reason || typeof answer !== 'number' ? [] : [{ who: participant, condition, value: answer }],
      ),
      conditions,
    );
    excluded.push(...incomplete(alone, of));
    return { of, asked, unit: 'answer', pairs };
  });
  return { simulated: rows[0]?.simulated ?? false, comparisons: compared(series), excluded };
}

/**
 * The scores of every task compared between two conditions, in points and in per cent of the maximum, the mean of a block's
 * trials. A group's score is one value, not one for each member. Holm's family: the tasks, points and per cent apart.
 */
export function compareScores(
  rows: readonly TrialRow[],
  conditions: readonly [string, string],
): { readonly points: Results; readonly percent: Results } {
  refuseMixture(rows);
  const excluded: Exclusion[] = [];
  const tasks = [...new Set(rows.map(({ task }) => task))];
  const seriesOf = (unit: 'points' | 'percent'): readonly Series[] =>
    tasks.map((task) => {
      const relevant = rows.filter((row) => row.task === task && row.condition && conditions.includes(row.condition));
      const counted = relevant.filter(({ excluded: reason }) => !reason);
      // The members of a group report one and the same score.
      const groups = new Map<string, TrialRow>();
      for (const row of counted) groups.set(`${row.group} ${row.condition} ${row.repetition}`, row);
      const digits = String(Math.max(...relevant.map(({ group }) => group))).length;
      const { pairs, alone } = paired(
        [...groups.values()].map(({ group, condition, score, maximum }) => ({
          who: `group ${String(group).padStart(digits, '0')}`,
          condition: condition as string,
          value: unit === 'points' ? score : (100 * score) / maximum,
        })),
        conditions,
      );
      if (unit === 'points') {
        for (const { participant, excluded: reason } of relevant) {
          if (reason) excluded.push({ participant, of: task, reason });
        }
        excluded.push(...incomplete(alone, task));
      }
      return { of: task, asked: null, unit, pairs };
    });
  const simulated = rows[0]?.simulated ?? false;
  return {
    points: { simulated, comparisons: compared(seriesOf('points')), excluded },
    percent: { simulated, comparisons: compared(seriesOf('percent')), excluded },
  };
}
