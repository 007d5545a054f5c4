import { fillRoundedRect, vrColors } from 'threepoint-ui/vr';
import { inLanguage } from '../../../model/phrases/localized-text';
import { type SliderForm, sliderValues } from '../../../model/questionnaires/kinds/slider';
import type { QuestionView } from '../question-view';
import { inner, margin, type Target, width } from '../sheet-target';
import { Ends, paintEnds, type ScreenEnds } from './scale-parts';

export interface SliderField {
  readonly kind: 'slider';
  /** Every value that the line distinguishes, in ascending order. */
  readonly values: readonly number[];
  readonly ends: ScreenEnds;
  readonly answer: number | null;
  choose(value: number): void;
}

declare module '../question-view' {
  interface ScreenFields {
    slider: SliderField;
  }
}

const track = { left: margin + 40, wide: inner - 80, y: 470 } as const;

export const sliderView: QuestionView<SliderForm, SliderField> = {
  kind: 'slider',
  field: (form, { phrases: { language }, given, choose }) => ({
    kind: 'slider',
    values: sliderValues(form),
    ends: { low: inLanguage(form.ends.low, language), high: inLanguage(form.ends.high, language) },
    answer: typeof given === 'number' ? given : null,
    choose,
  }),
  card({ values, ends, answer, choose }, name, { text }) {
    const take = ({ currentTarget }: { readonly currentTarget: HTMLInputElement }) =>
      choose(values[currentTarget.valueAsNumber] as number);
    return (
      <>
        <input
          type="range"
          name={name}
          min={0}
          max={values.length - 1}
          step={1}
          value={answer === null ? Math.floor(values.length / 2) : values.indexOf(answer)}
          aria-label={text('question.range', ends)}
          // Without an answer the line is empty: a mark in the middle would suggest one.
          class={answer === null ? 'open' : ''}
          onInput={take}
          // A click at the position of the hidden mark moves nothing, and is an answer.
          onClick={take}
          onKeyDown={(event) => (event.key === 'Enter' || event.key === ' ') && take(event)}
        />
        <Ends {...ends} />
      </>
    );
  },
  sheet: {
    /** Lays out a line of narrow targets, and two buttons for the last step. */
    targets({ values, answer, choose }) {
      const wide = track.wide / values.length;
      const ticks = values.map(
        (value, index): Target => ({
          kind: 'tick',
          id: `answer-${value}`,
          label: '',
          look: 'plain',
          at: [track.left + index * wide, track.y - 60, wide, 120],
          act: () => choose(value),
        }),
      );
      const at = answer === null ? -1 : values.indexOf(answer);
      const nudge = (id: string, label: string, to: number, left: number): Target => {
        const value = at < 0 ? undefined : values[to];
        return {
          kind: 'button',
          id,
          label,
          look: value === undefined ? 'off' : 'plain',
          at: [left, 548, 110, 64],
          act: () => value !== undefined && choose(value),
        };
      };
      return [...ticks, nudge('less', '◀', at - 1, width / 2 - 120), nudge('more', '▶', at + 1, width / 2 + 10)];
    },
    paint(context, { values, answer, ends }, hovered) {
      const { left, wide, y } = track;
      fillRoundedRect(context, [left, y - 5, wide, 10], 5, vrColors.liftMore);
      for (const x of [left, left + wide]) fillRoundedRect(context, [x - 3, y - 30, 6, 60], 3, vrColors.liftMore);
      const mark = (index: number, fill: string, radius: number) => {
        if (index < 0) return;
        context.beginPath();
        context.arc(left + ((index + 0.5) / values.length) * wide, y, radius, 0, 2 * Math.PI);
        context.fillStyle = fill;
        context.fill();
      };
      mark(
        values.findIndex((value) => `answer-${value}` === hovered),
        vrColors.liftMore,
        24,
      );
      mark(answer === null ? -1 : values.indexOf(answer), vrColors.accent, 26);
      paintEnds(context, ends, 580);
    },
  },
};
