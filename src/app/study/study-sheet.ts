import { fillRounded, vrColors, vrFont, wrap } from '../../ui/vr-panel';
import type { PanelTarget } from '../../ui/vr-touch';
import type { ScreenButton, ScreenQuestion, StudyScreen } from './study-screen';

/** The sheet [pixels], and how many of them are a metre. */
export const width = 1200;
export const height = 880;
export const pixelsPerMetre = 1000;
const margin = 60;
const inner = width - 2 * margin;

/** What can be pressed on the sheet, and how it looks. */
export interface Target extends PanelTarget {
  readonly kind: 'button' | 'scale' | 'dot';
  readonly label: string;
  readonly look: ScreenButton['look'] | 'chosen' | 'answered' | 'open' | 'missing' | 'here';
  act(): void;
}

/** Everything of a screen that can be pressed, laid out. */
export const targetsOf = ({ question, buttons }: StudyScreen): readonly Target[] => [
  ...(question ? questionTargets(question) : []),
  ...buttonTargets(buttons),
];

function questionTargets(question: ScreenQuestion): readonly Target[] {
  const step = 52;
  const left = width - margin - question.all.length * step;
  const dots = question.all.map(
    ({ id, state }, index): Target => ({
      kind: 'dot',
      id: `go-${id}`,
      label: String(index + 1),
      look: index + 1 === question.number ? 'here' : state,
      at: [left + index * step, 40, 44, 44],
      act: () => question.goTo(index),
    }),
  );
  const gap = 18;
  const wide = (inner - gap * (question.scale.length - 1)) / question.scale.length;
  const answers = question.scale.map(
    ({ value, label }, index): Target => ({
      kind: 'scale',
      id: `answer-${value}`,
      label,
      look: question.answer === value ? 'chosen' : 'plain',
      at: [margin + index * (wide + gap), 410, wide, 190],
      act: () => question.choose(value),
    }),
  );
  return [...dots, ...answers];
}

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

/** Draws a screen with its targets; `hovered`: the id of the target that a hand points at, null: none. */
export function paintSheet(
  context: CanvasRenderingContext2D,
  screen: StudyScreen,
  { targets, hovered }: { readonly targets: readonly Target[]; readonly hovered: string | null },
): void {
  fillRounded(context, [2, 2, width - 4, height - 4], 48, 'rgba(18, 24, 35, 0.96)', vrColors.line);
  context.textBaseline = 'middle';
  context.textAlign = 'left';
  context.fillStyle = screen.trouble ? '#ff8f7d' : vrColors.inkSoft;
  context.font = `600 32px ${vrFont}`;
  context.fillText(screen.kicker, margin, 64, screen.question ? 560 : inner);

  context.fillStyle = vrColors.ink;
  if (screen.question) paintQuestion(context, screen.question);
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
  context.fillText(screen.footnote, margin, 842, inner);
}

function paintQuestion(context: CanvasRenderingContext2D, { text }: ScreenQuestion): void {
  context.font = `600 50px ${vrFont}`;
  for (const [index, line] of wrap(context, text, inner).entries()) context.fillText(line, margin, 180 + index * 66);
}

/** Title, paragraphs, a number to be read from afar, a bar. */
function paintText(context: CanvasRenderingContext2D, { title, text, figure, part }: StudyScreen): void {
  context.font = `650 60px ${vrFont}`;
  context.fillText(title, margin, 150, inner);
  context.font = `400 38px ${vrFont}`;
  let y = 236;
  for (const paragraph of text) {
    for (const line of wrap(context, paragraph, inner)) {
      context.fillText(line, margin, y);
      y += 52;
    }
    y += 14;
  }
  if (figure !== null) {
    context.textAlign = 'center';
    context.fillStyle = vrColors.accent;
    context.font = `650 ${figure.length > 6 ? 84 : 170}px ${vrFont}`;
    context.fillText(figure, width / 2, Math.max(y + 90, 500));
  }
  if (part !== null) {
    fillRounded(context, [margin, 632, inner, 22], 11, vrColors.lift);
    if (part > 0) fillRounded(context, [margin, 632, Math.max(22, inner * part), 22], 11, vrColors.accent);
  }
}

function paintTarget(context: CanvasRenderingContext2D, target: Target, hovered: boolean): void {
  const { kind, look, label } = target;
  const [x, y, w, h] = target.at;
  const outline = look === 'missing' ? vrColors.accent : hovered ? vrColors.ink : undefined;
  fillRounded(context, [x, y, w, h], kind === 'dot' ? 22 : 28, fillOf(look, hovered), outline);
  context.globalAlpha = look === 'off' ? 0.4 : 1;
  context.fillStyle = look === 'chosen' || look === 'primary' ? vrColors.accentInk : vrColors.ink;
  if (kind === 'scale') {
    context.font = `650 72px ${vrFont}`;
    context.fillText(target.id.replace('answer-', ''), x + w / 2, y + 76);
    context.font = `500 34px ${vrFont}`;
    context.fillText(label, x + w / 2, y + 148, w - 16);
  } else {
    context.font = `600 ${kind === 'dot' ? 24 : 44}px ${vrFont}`;
    context.fillText(label, x + w / 2, y + h / 2 + 2, w - 20);
  }
  context.globalAlpha = 1;
}
