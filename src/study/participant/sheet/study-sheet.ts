import { fillRoundedRect, vrColors, vrFont, wrapText } from 'threepoint-ui/vr';
import { paintQuestion, questionTargets } from '../questions/question-sheet';
import { height, inner, margin, type Target, width } from '../questions/sheet-target';
import type { ScreenButton, StudyScreen } from '../questions/study-screen';

/** Returns everything of a screen that can be pressed, laid out. */
export const targetsOf = ({ question, buttons }: StudyScreen): readonly Target[] => [
  ...(question ? questionTargets(question) : []),
  ...buttonTargets(buttons),
];

function buttonTargets(buttons: readonly ScreenButton[]): readonly Target[] {
  const gap = 24;
  const alone = buttons.length === 1;
  const wide = alone ? 560 : (inner - gap * (buttons.length - 1)) / Math.max(1, buttons.length);
  const left = alone ? (width - wide) / 2 : margin;
  return buttons.map(({ id, label, look, act }, index) => ({
    kind: 'button',
    id,
    label,
    look,
    at: [left + index * (wide + gap), 692, wide, 116],
    act,
  }));
}

const fillOf = (look: Target['look'], hovered: boolean): string => {
  if (look === 'chosen') return vrColors.accent;
  if (look === 'primary') return hovered ? '#ffc98e' : vrColors.accent;
  if (look === 'answered') return 'rgba(255, 180, 104, 0.42)';
  return hovered || look === 'here' ? vrColors.liftMore : vrColors.lift;
};

/** Draws a screen with its targets; `hovered` is the id of the target that a hand points at, or null. */
export function paintSheet(
  context: CanvasRenderingContext2D,
  screen: StudyScreen,
  { targets, hovered }: { readonly targets: readonly Target[]; readonly hovered: string | null },
): void {
  fillRoundedRect(context, [2, 2, width - 4, height - 4], 48, 'rgba(18, 24, 35, 0.96)', vrColors.line);
  context.textBaseline = 'middle';
  context.textAlign = 'left';
  context.fillStyle = screen.trouble ? '#ff8f7d' : vrColors.inkSoft;
  context.font = `600 32px ${vrFont}`;
  context.fillText(screen.kicker, margin, 64, screen.question ? 560 : inner);

  context.fillStyle = vrColors.ink;
  if (screen.question) paintQuestion(context, screen.question, hovered);
  else paintText(context, screen);

  context.textAlign = 'center';
  for (const target of targets) paintTarget(context, target, target.id === hovered && target.look !== 'off');
  context.textAlign = 'left';
  if (screen.hint !== null) {
    context.fillStyle = vrColors.accent;
    context.font = `500 34px ${vrFont}`;
    context.fillText(screen.hint, margin, 650, inner);
  }
  context.fillStyle = vrColors.inkSoft;
  context.font = `400 26px ${vrFont}`;
  const foot = wrapText(context, screen.footnote, inner);
  for (const [index, line] of foot.entries()) {
    context.fillText(line, margin, foot.length === 1 ? 842 : 828 + 28 * index, inner);
  }
}

/** Text sizes of a sheet's paragraphs [pixels]; the largest that fits is used. */
const textSizes = [38, 34, 30, 26] as const;

/** Draws paragraphs from y = 236 to `bottom` at most; returns their lower end. */
function paintParagraphs(context: CanvasRenderingContext2D, text: readonly string[], bottom: number): number {
  for (const size of textSizes) {
    context.font = `400 ${size}px ${vrFont}`;
    const step = Math.round(1.37 * size);
    const paragraphs = text.map((paragraph) => wrapText(context, paragraph, inner));
    const end = 236 + step * paragraphs.flat().length + 14 * paragraphs.length;
    if (end > bottom && size !== textSizes.at(-1)) continue;
    let y = 236;
    for (const lines of paragraphs) {
      for (const line of lines) {
        context.fillText(line, margin, y, inner);
        y += step;
      }
      y += 14;
    }
    return y;
  }
  return bottom;
}

/** Draws the title, the paragraphs, a large number and a progress bar. */
function paintText(context: CanvasRenderingContext2D, { title, text, figure, part, hint }: StudyScreen): void {
  context.font = `650 60px ${vrFont}`;
  context.fillText(title, margin, 150, inner);
  const y = paintParagraphs(context, text, figure !== null ? 410 : part !== null || hint !== null ? 630 : 690);
  if (figure !== null) {
    context.textAlign = 'center';
    context.fillStyle = vrColors.accent;
    context.font = `650 ${figure.length > 6 ? 84 : 170}px ${vrFont}`;
    context.fillText(figure, width / 2, Math.max(y + 90, 500));
  }
  if (part !== null) {
    fillRoundedRect(context, [margin, 632, inner, 22], 11, vrColors.lift);
    if (part > 0) fillRoundedRect(context, [margin, 632, Math.max(22, inner * part), 22], 11, vrColors.accent);
  }
}

const fontOf = ({ kind, at: [, , wide, high] }: Target): string => {
  const size = {
    dot: 24,
    key: 30,
    button: Math.min(44, high * 0.45),
    option: Math.min(40, high * 0.4),
    scale: 34,
    tick: 0,
  };
  return `${kind === 'scale' ? 500 : 600} ${Math.min(size[kind], wide)}px ${vrFont}`;
};

function paintTarget(context: CanvasRenderingContext2D, target: Target, hovered: boolean): void {
  const { kind, look, label, figure } = target;
  if (kind === 'tick') return;
  const [x, y, w, h] = target.at;
  const outline = look === 'missing' ? vrColors.accent : hovered ? vrColors.ink : undefined;
  const radius = kind === 'dot' ? 22 : kind === 'key' ? 12 : 28;
  fillRoundedRect(context, [x, y, w, h], Math.min(radius, w / 3), fillOf(look, hovered), outline);
  context.globalAlpha = look === 'off' ? 0.4 : 1;
  context.fillStyle = look === 'chosen' || look === 'primary' ? vrColors.accentInk : vrColors.ink;
  if (figure) {
    context.font = `650 ${Math.min(72, w * 0.5)}px ${vrFont}`;
    context.fillText(figure, x + w / 2, y + (label ? 76 : h / 2));
  }
  if (label) {
    // Narrow points have small text that is wrapped.
    context.font = kind === 'scale' && w < 180 ? `500 26px ${vrFont}` : fontOf(target);
    let lines = kind === 'scale' || kind === 'option' || kind === 'button' ? wrapText(context, label, w - 16) : [label];
    if (kind === 'button' && lines.length > 1) {
      // Long labels wrap into two smaller lines, which are easier to read than one condensed line.
      context.font = `600 34px ${vrFont}`;
      lines = wrapText(context, label, w - 16);
    }
    const middle = figure ? y + 148 : y + h / 2 + 2;
    const step = 30;
    for (const [index, line] of lines.entries()) {
      context.fillText(
        line,
        x + w / 2,
        middle + (index - (lines.length - 1) / 2) * (figure ? step : step + 12),
        w - 16,
      );
    }
  }
  context.globalAlpha = 1;
}
