import { inLanguage } from '../../../model/phrases/localized-text';
import { type LikertForm, likertPoints } from '../../../model/questionnaires/kinds/likert';
import type { QuestionView } from '../question-view';
import { inner, margin } from '../sheet-target';
import { Ends, maxNumberedPoints, paintEnds, Radio, type ScreenEnds, type ScreenPoint } from './scale-parts';

export interface LikertField {
  readonly kind: 'likert';
  readonly points: readonly ScreenPoint<number>[];
  readonly ends: ScreenEnds | null;
  readonly answer: number | null;
  choose(value: number): void;
}

declare module '../question-view' {
  interface ScreenFields {
    likert: LikertField;
  }
}

export const likertView: QuestionView<LikertForm, LikertField> = {
  kind: 'likert',
  field: (form, { phrases: { language }, given, choose }) => ({
    kind: 'likert',
    points: likertPoints(form).map((value, index) => {
      const label = form.labels?.[index];
      return { value, label: label === undefined ? '' : inLanguage(label, language) };
    }),
    ends: form.ends ? { low: inLanguage(form.ends.low, language), high: inLanguage(form.ends.high, language) } : null,
    answer: typeof given === 'number' ? given : null,
    choose,
  }),
  card({ points, ends, answer, choose }, name) {
    const many = points.length > maxNumberedPoints;
    const endOf = (index: number) => (index === 0 ? ends?.low : index === points.length - 1 ? ends?.high : undefined);
    const nameOf = (value: number, end: string | undefined) =>
      end ? `${value} ${end}` : many ? String(value) : undefined;
    const point = ({ value, label }: ScreenPoint<number>, index: number) => {
      const state = { checked: value === answer, onChange: () => choose(value) };
      return (
        <Radio key={value} name={name} value={value} aria-label={nameOf(value, endOf(index))} {...state}>
          {!many && <b>{value}</b>}
          {label && <span>{label}</span>}
        </Radio>
      );
    };
    return (
      <>
        <div class={many ? 'points many' : 'points'} style={{ '--points': String(points.length) }}>
          {points.map(point)}
        </div>
        {ends && <Ends {...ends} />}
      </>
    );
  },
  sheet: {
    targets({ points, ends, answer, choose }) {
      const gap = points.length > maxNumberedPoints ? 6 : 18;
      const wide = (inner - gap * (points.length - 1)) / points.length;
      return points.map(({ value, label }, index) => ({
        kind: 'scale',
        id: `answer-${value}`,
        label,
        figure: points.length > maxNumberedPoints ? '' : String(value).replace('-', '−'),
        look: answer === value ? 'chosen' : 'plain',
        at: [margin + index * (wide + gap), 410, wide, ends ? 150 : 190],
        act: () => choose(value),
      }));
    },
    paint(context, { ends }) {
      if (ends) paintEnds(context, ends, 594);
    },
  },
};
