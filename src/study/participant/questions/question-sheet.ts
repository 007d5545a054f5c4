import { vrColors, vrFont, wrapText } from 'threepoint-ui/vr';
import { questionView } from './question-views';
import { inner, margin, type Target, width } from './sheet-target';
import type { ScreenQuestion } from './study-screen';

/** The most questions for which each has a dot; otherwise their number is in the corner. */
const maxDots = 10;
const usualTextBottom = 390;

function dotTargets(question: ScreenQuestion): readonly Target[] {
  if (question.all.length > maxDots) return [];
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

/** Returns everything of a question that can be pressed, laid out. */
export const questionTargets = (question: ScreenQuestion): readonly Target[] => [
  ...dotTargets(question),
  ...questionView(question.field).sheet.targets(question.field),
];

const sizes = [50, 42, 36, 30] as const;

function paintText(context: CanvasRenderingContext2D, text: string, bottom: number): void {
  const top = 130;
  for (const size of sizes) {
    context.font = `600 ${size}px ${vrFont}`;
    const lines = wrapText(context, text, inner);
    if (lines.length * size * 1.32 > bottom - top && size !== sizes[3]) continue;
    for (const [index, line] of lines.entries()) context.fillText(line, margin, top + (index + 0.6) * size * 1.32);
    return;
  }
}

/** Draws a question apart from its targets; `hovered`: the id of the target that a hand points at. */
export function paintQuestion(
  context: CanvasRenderingContext2D,
  { text, field, all, place, optional, phrases }: ScreenQuestion,
  hovered: string | null,
): void {
  const { sheet } = questionView(field);
  context.fillStyle = vrColors.ink;
  paintText(
    context,
    optional ? `${text} ${phrases.text('question.mayStayOpen')}` : text,
    sheet.textBottom?.(field) ?? usualTextBottom,
  );
  if (all.length > maxDots) {
    context.textAlign = 'right';
    context.fillStyle = vrColors.inkSoft;
    context.font = `600 32px ${vrFont}`;
    context.fillText(place, width - margin, 64);
    context.textAlign = 'left';
  }
  sheet.paint?.(context, field, hovered);
}
