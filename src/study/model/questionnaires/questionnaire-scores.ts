import { questionKind } from './question-kinds';
import type { Question, Scale } from './questionnaire-schema';
import type { Answers, Questionnaire } from './questionnaires';

/** Returns an answer as a number, reversed if the question is, or null if there is none or it is no number. */
function counted({ id, answer, reversed }: Question, answers: Answers): number | null {
  const given = answers[id];
  if (typeof given !== 'number') return null;
  const range = questionKind(answer).range(answer);
  return reversed && range ? range[0] + range[1] - given : given;
}

const sum = (values: readonly number[]) => values.reduce((total, value) => total + value, 0);

/** Returns the questions of a scale, with repetitions. */
const questionsOf = (questionnaire: Questionnaire, scale: Scale): readonly Question[] =>
  scale.questions.flatMap((id) => questionnaire.questions.find((question) => question.id === id) ?? []);

/** Returns the value of a scale, or null if a question has no answer. */
export function scaleScore(questionnaire: Questionnaire, scale: Scale, answers: Answers): number | null {
  const { method, factor = 1, offset = 0, atLeast = 0, choices = [] } = scale;
  const values: number[] = [];
  for (const question of questionsOf(questionnaire, scale)) {
    const value = counted(question, answers);
    if (value === null) return null;
    values.push(value);
  }
  const result = (value: number) => factor * value + offset;
  switch (method) {
    case 'sum':
      return result(sum(values));
    case 'mean':
      return result(sum(values) / values.length);
    case 'count':
      return result(values.filter((value) => value >= atLeast).length);
    case 'weighted-mean': {
      const chosen = choices.map((id) => answers[id]);
      const weights = scale.questions.map((id) => chosen.filter((choice) => choice === id).length);
      const whole = sum(weights);
      if (whole === 0 || chosen.includes(undefined)) return null;
      return result(sum(values.map((value, index) => value * (weights[index] as number))) / whole);
    }
  }
}

/** Returns the least and the greatest value that a scale can have. */
export function scaleRange(questionnaire: Questionnaire, scale: Scale): readonly [number, number] {
  const ranges = questionsOf(questionnaire, scale).flatMap(({ answer }) => {
    const range = questionKind(answer).range(answer);
    return range ? [range] : [];
  });
  const { method, factor = 1, offset = 0 } = scale;
  const lows = ranges.map(([low]) => low);
  const highs = ranges.map(([, high]) => high);
  const [low, high] = {
    sum: () => [sum(lows), sum(highs)],
    mean: () => [sum(lows) / lows.length, sum(highs) / highs.length],
    count: () => [0, ranges.length],
    'weighted-mean': () => [Math.min(...lows), Math.max(...highs)],
  }[method]() as [number, number];
  const ends = [factor * low + offset, factor * high + offset] as const;
  return ends[0] <= ends[1] ? ends : [ends[1], ends[0]];
}
