import { fillRounded, vrColors, vrFont, wrap } from 'threepoint-ui/vr-panel';
import { keyTargets } from './sheet-keys';
import { inner, margin, type Target, width } from './sheet-target';
import type { ScreenField, ScreenQuestion } from './study-screen';

type FieldOf<Kind extends ScreenField['kind']> = Extract<ScreenField, { kind: Kind }>;

/** More questions than this have no dot each: their number stands in the corner. */
const mostDots = 10;
/** A scale with more points shows no numbers, only places between its ends, as on the paper form of NASA-TLX. */
export const mostNumbered = 11;
const track = { left: margin + 40, wide: inner - 80, y: 470 } as const;

function dotTargets(question: ScreenQuestion): readonly Target[] {
  if (question.all.length > mostDots) return [];
  const step = 52;
  const left = width - margin - question.all.length * step;
  return question.all.map(({ id, state }, index) => ({
    kind: 'dot',
    id: `go-${id}`,
    label: String(index + 1),
    look: index + 1 === question.number ? 'here' : state === 'optional' ? 'open' : state,
    at: [left + index * step, 40, 44, 44],
    act: () => question.goTo(index),
  }));
}

function likertTargets({ points, ends, answer, choose }: FieldOf<'likert'>): readonly Target[] {
  const gap = points.length > mostNumbered ? 6 : 18;
  const wide = (inner - gap * (points.length - 1)) / points.length;
  return points.map(({ value, label }, index) => ({
    kind: 'scale',
    id: `answer-${value}`,
    label,
    figure: points.length > mostNumbered ? '' : String(value).replace('-', '−'),
    look: answer === value ? 'chosen' : 'plain',
    at: [margin + index * (wide + gap), 410, wide, ends ? 150 : 190],
    act: () => choose(value),
  }));
}

/** A line made of narrow targets, and two buttons for the last step. */
function sliderTargets({ values, answer, choose }: FieldOf<'slider'>): readonly Target[] {
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
}

function choiceTargets({ points, answer, choose }: FieldOf<'choice'>): readonly Target[] {
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
}

function fieldTargets(field: ScreenField): readonly Target[] {
  switch (field.kind) {
    case 'likert':
      return likertTargets(field);
    case 'slider':
      return sliderTargets(field);
    case 'choice':
      return choiceTargets(field);
    case 'number':
    case 'text':
      return keyTargets(field);
  }
}

/** Everything of a question that can be pressed, laid out. */
export const questionTargets = (question: ScreenQuestion): readonly Target[] => [
  ...dotTargets(question),
  ...fieldTargets(question.field),
];

const sizes = [50, 42, 36, 30] as const;

function paintWords(context: CanvasRenderingContext2D, text: string, bottom: number): void {
  const top = 130;
  for (const size of sizes) {
    context.font = `600 ${size}px ${vrFont}`;
    const lines = wrap(context, text, inner);
    if (lines.length * size * 1.32 > bottom - top && size !== sizes[3]) continue;
    for (const [index, line] of lines.entries()) context.fillText(line, margin, top + (index + 0.6) * size * 1.32);
    return;
  }
}

function paintEnds(context: CanvasRenderingContext2D, low: string, high: string, y: number): void {
  context.font = `500 32px ${vrFont}`;
  context.fillStyle = vrColors.inkSoft;
  context.fillText(low, margin, y, inner / 2 - 140);
  context.textAlign = 'right';
  context.fillText(high, width - margin, y, inner / 2 - 140);
  context.textAlign = 'left';
}

function paintSlider(context: CanvasRenderingContext2D, field: FieldOf<'slider'>, hovered: string | null): void {
  const { left, wide, y } = track;
  fillRounded(context, [left, y - 5, wide, 10], 5, vrColors.liftMore);
  for (const x of [left, left + wide]) fillRounded(context, [x - 3, y - 30, 6, 60], 3, vrColors.liftMore);
  const mark = (index: number, fill: string, radius: number) => {
    if (index < 0) return;
    context.beginPath();
    context.arc(left + ((index + 0.5) / field.values.length) * wide, y, radius, 0, 2 * Math.PI);
    context.fillStyle = fill;
    context.fill();
  };
  mark(
    field.values.findIndex((value) => `answer-${value}` === hovered),
    vrColors.liftMore,
    24,
  );
  mark(field.answer === null ? -1 : field.values.indexOf(field.answer), vrColors.accent, 26);
  paintEnds(context, field.ends.low, field.ends.high, 580);
}

function paintTyped(context: CanvasRenderingContext2D, { kind, typed, unit }: FieldOf<'number' | 'text'>): void {
  const wide = kind === 'text' ? inner : 420;
  const y = kind === 'text' ? 256 : 286;
  fillRounded(context, [margin, y, wide, 64], 16, 'rgba(8, 12, 19, 0.6)', vrColors.line);
  context.font = `500 36px ${vrFont}`;
  context.fillStyle = vrColors.ink;
  // What does not fit is the beginning: the end is where one types.
  let shown = `${typed}|`;
  while (shown.length > 1 && context.measureText(shown).width > wide - 40) shown = shown.slice(1);
  context.fillText(shown, margin + 20, y + 34);
  context.fillStyle = vrColors.inkSoft;
  context.fillText(unit, margin + wide + 20, y + 34);
}

/** The question's words and what of its field is not a target; `hovered`: id of the target that a hand points at. */
export function paintQuestion(
  context: CanvasRenderingContext2D,
  { text, field, all, place, optional, phrases }: ScreenQuestion,
  hovered: string | null,
): void {
  context.fillStyle = vrColors.ink;
  const typing = field.kind === 'text' || field.kind === 'number';
  const tall = field.kind === 'choice' && field.points.length > 6;
  paintWords(
    context,
    optional ? `${text} ${phrases.say('question.mayStayOpen')}` : text,
    typing ? 250 : tall ? 310 : 390,
  );
  if (all.length > mostDots) {
    context.textAlign = 'right';
    context.fillStyle = vrColors.inkSoft;
    context.font = `600 32px ${vrFont}`;
    context.fillText(place, width - margin, 64);
    context.textAlign = 'left';
  }
  if (field.kind === 'likert' && field.ends) paintEnds(context, field.ends.low, field.ends.high, 594);
  if (field.kind === 'slider') paintSlider(context, field, hovered);
  if (field.kind === 'number' || field.kind === 'text') paintTyped(context, field);
}
