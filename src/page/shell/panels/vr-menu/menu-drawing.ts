import {
  type CalibrationStep,
  calibrationHeadline,
  calibrationInstruction,
  differenceLines,
  type FrameReport,
  milliseconds,
  missedFrames,
} from 'threepoint-ui';
import { drawText, drawTextLines, fillRoundedRect, type TextStyle, vrColors } from 'threepoint-ui/vr';
import { type MenuButton, menuHeight, menuMargin, menuWidth } from '../../../activity/activity-menu';
import { noticesTop, type VrMenuState } from './menu-buttons';

const inner = menuWidth - 2 * menuMargin;

function drawCalibration(context: CanvasRenderingContext2D, step: CalibrationStep): void {
  const over = step.kind === 'done' || step.kind === 'failed';
  const middle = { align: 'center', baseline: 'middle' } as const;
  const text = over ? step.text : calibrationInstruction;
  drawTextLines(context, text, [menuWidth / 2, 170, inner], 54, { font: '500 40px', color: vrColors.ink, ...middle });
  const font = step.kind === 'countdown' ? '650 180px' : '650 84px';
  drawText(context, calibrationHeadline(step), [menuWidth / 2, 480], { font, color: vrColors.accent, ...middle });
  if (step.kind !== 'measuring') return;
  fillRoundedRect(context, [menuMargin, 620, inner, 20], 10, vrColors.lift);
  fillRoundedRect(context, [menuMargin, 620, inner * step.part, 20], 10, vrColors.accent);
}

function drawButton(context: CanvasRenderingContext2D, { label, at, look }: MenuButton, hovered: boolean): void {
  const [x, y, w, h] = at;
  const plain = hovered && look !== 'off' ? vrColors.liftMore : vrColors.lift;
  fillRoundedRect(context, [x, y, w, h], 22, look === 'chosen' ? vrColors.accent : plain);
  context.globalAlpha = look === 'off' ? 0.45 : 1;
  const color = look === 'chosen' ? vrColors.accentInk : vrColors.ink;
  const font = w > 300 ? '600 38px' : '600 30px';
  const middle = [x + w / 2, y + h / 2 + 2] as const;
  drawText(context, label, middle, { font, color, align: 'center', baseline: 'middle', maxWidth: w - 24 });
  context.globalAlpha = 1;
}

/** The whole sheet; hovered: the id of the button that a hand points at, or null. */
export function drawMenu(
  context: CanvasRenderingContext2D,
  state: VrMenuState,
  buttons: readonly MenuButton[],
  hovered: string | null,
): void {
  fillRoundedRect(context, [2, 2, menuWidth - 4, menuHeight - 4], 40, vrColors.glass, vrColors.line);
  const { calibration, sheet, notice } = state;
  const soft = { color: vrColors.inkSoft, baseline: 'middle' } as const;
  const heading = calibration ? 'Calibrate' : (sheet?.heading ?? 'How the body moves');
  drawText(context, heading, [menuMargin + 4, 72], { font: '600 30px', ...soft });
  if (calibration) drawCalibration(context, calibration);
  else sheet?.draw(context);
  for (const button of buttons) drawButton(context, button, button.id === hovered);
  if (notice && !calibration && !sheet)
    drawTextLines(context, notice, [menuMargin, noticesTop + 8, inner], 28, { font: '400 22px', ...soft }, 3);
}

/** The sheet of the frame times [pixels]. */
export const frameTimesWidth = 520;
export const frameTimesHeight = 530;

type Row = readonly [label: string, p50: string, p95: string];

function drawRow(context: CanvasRenderingContext2D, y: number, [label, p50, p95]: Row, writing: TextStyle): void {
  drawText(context, label, [32, y], writing);
  drawText(context, p50, [380, y], { ...writing, align: 'right' });
  drawText(context, p95, [488, y], { ...writing, align: 'right' });
}

/** Frame time by stage, on its sheet in the headset. */
export function drawFrameTimes(context: CanvasRenderingContext2D, report: FrameReport): void {
  const { p50Ms, p95Ms, stages, estimator, provider, fromDevice } = report;
  const baseline = 'middle';
  const { glass, line, inkSoft, accent, ink } = vrColors;
  fillRoundedRect(context, [2, 2, frameTimesWidth - 4, frameTimesHeight - 4], 32, glass, line);
  drawRow(context, 48, ['ms per frame', 'p50', 'p95'], { font: '500 26px', color: inkSoft, baseline });
  const whole: Row = ['frame', milliseconds(p50Ms), milliseconds(p95Ms)];
  drawRow(context, 92, whole, { font: '650 34px', color: accent, baseline });
  for (const [index, stage] of stages.entries()) {
    const row: Row = [stage.name, milliseconds(stage.p50Ms), milliseconds(stage.p95Ms)];
    drawRow(context, 140 + index * 40, row, { font: '500 28px', color: ink, baseline });
  }
  const lines = [
    missedFrames(report),
    `${estimator} · ${provider}`,
    ...(fromDevice ? differenceLines(fromDevice) : []),
  ];
  for (const [index, line] of lines.entries())
    drawText(context, line, [32, 386 + index * 38], { font: '500 25px', color: inkSoft, baseline, maxWidth: 456 });
}
