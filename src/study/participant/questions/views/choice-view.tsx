import { inLanguage } from '../../../model/phrases/localized-text';
import type { ChoiceForm } from '../../../model/questionnaires/kinds/choice';
import type { QuestionView } from '../question-view';
import { inner, margin } from '../sheet-target';
import { Radio, type ScreenPoint } from './scale-parts';

export interface ChoiceField {
  readonly kind: 'choice';
  readonly points: readonly ScreenPoint<string>[];
  readonly answer: string | null;
  choose(value: string): void;
}

declare module '../question-view' {
  interface ScreenFields {
    choice: ChoiceField;
  }
}

export const choiceView: QuestionView<ChoiceForm, ChoiceField> = {
  kind: 'choice',
  field: ({ options }, { phrases: { language }, given, choose }) => ({
    kind: 'choice',
    points: options.map(({ value, label }) => ({ value, label: inLanguage(label, language) })),
    answer: typeof given === 'string' ? given : null,
    choose,
  }),
  card: ({ points, answer, choose }, name) => (
    <div class="choices">
      {points.map(({ value, label }) => (
        <Radio key={value} name={name} value={value} checked={value === answer} onChange={() => choose(value)}>
          <span>{label}</span>
        </Radio>
      ))}
    </div>
  ),
  sheet: {
    targets({ points, answer, choose }) {
      const columns = points.length <= 3 ? points.length : 2;
      const rows = Math.ceil(points.length / columns);
      const gap = 16;
      const top = rows > 3 ? 320 : 400;
      const wide = (inner - gap * (columns - 1)) / columns;
      const high = Math.min(150, (620 - top - gap * (rows - 1)) / rows);
      return points.map(({ value, label }, index) => ({
        kind: 'option',
        id: `answer-${value}`,
        label,
        look: answer === value ? 'chosen' : 'plain',
        at: [margin + (index % columns) * (wide + gap), top + Math.floor(index / columns) * (high + gap), wide, high],
        act: () => choose(value),
      }));
    },
    textBottom: ({ points }) => (points.length > 6 ? 310 : 390),
  },
};
