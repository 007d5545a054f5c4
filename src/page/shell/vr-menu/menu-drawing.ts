import { type CalibrationStep, calibrationHeadline, calibrationInstruction } from 'threepoint-ui/calibration-dialog';
import { fillRounded, vrColors, vrFont, wrap } from 'threepoint-ui/vr-panel';
import { type MenuButton, menuHeight, menuMargin, menuWidth } from '../../activity/activity-menu';
import { noticesTop, type VrMenuState } from './menu-buttons';

const inner = menuWidth - 2 * menuMargin;

function drawCalibration(context: CanvasRenderingContext2D, step: CalibrationStep): void {
  const over = step.kind === 'done' || step.kind === 'failed';
  context.textAlign = 'center';
  context.fillStyle = vrColors.ink;
  context.font = `500 40px ${vrFont}`;
  const lines = wrap(context, over ? step.text : calibrationInstruction, inner);
  for (const [index, line] of lines.entries()) context.fillText(line, menuWidth / 2, 170 + index * 54);
  context.fillStyle = vrColors.accent;
  context.font = `650 ${step.kind === 'countdown' ? 180 : 84}px ${vrFont}`;
  context.fillText(calibrationHeadline(step), menuWidth / 2, 480);
  if (step.kind !== 'measuring') return;
  fillRounded(context, [menuMargin, 620, inner, 20], 10, vrColors.lift);
  fillRounded(context, [menuMargin, 620, inner * step.part, 20], 10, vrColors.accent);
}

function drawButton(context: CanvasRenderingContext2D, { label, at, look }: MenuButton, hovered: boolean): void {
  const [x, y, w, h] = at;
  const plain = hovered && look !== 'off' ? vrColors.liftMore : vrColors.lift;
  fillRounded(context, [x, y, w, h], 22, look === 'chosen' ? vrColors.accent : plain);
  context.globalAlpha = look === 'off' ? 0.45 : 1;
  context.fillStyle = look === 'chosen' ? vrColors.accentInk : vrColors.ink;
  context.font = `600 ${w > 300 ? 38 : 30}px ${vrFont}`;
  context.textAlign = 'center';
  context.fillText(label, x + w / 2, y + h / 2 + 2, w - 24);
  context.globalAlpha = 1;
}

function drawNotice(context: CanvasRenderingContext2D, notice: string): void {
  context.textAlign = 'left';
  context.fillStyle = vrColors.inkSoft;
  context.font = `400 22px ${vrFont}`;
  const lines = wrap(context, notice, inner).slice(0, 3);
  for (const [index, line] of lines.entries()) context.fillText(line, menuMargin, noticesTop + 8 + index * 28);
}

/** The whole sheet; hovered: the id of the button that a hand points at, or null. */
export function drawMenu(
  context: CanvasRenderingContext2D,
  state: VrMenuState,
  buttons: readonly MenuButton[],
  hovered: string | null,
): void {
  fillRounded(context, [2, 2, menuWidth - 4, menuHeight - 4], 40, vrColors.glass, vrColors.line);
  context.textBaseline = 'middle';
  context.textAlign = 'left';
  context.fillStyle = vrColors.inkSoft;
  context.font = `600 30px ${vrFont}`;
  const { calibration, sheet, notice } = state;
  const heading = calibration ? 'Calibrate' : (sheet?.heading ?? 'Estimator');
  context.fillText(heading, menuMargin + 4, 72);
  if (calibration) drawCalibration(context, calibration);
  else sheet?.draw(context);
  for (const button of buttons) drawButton(context, button, button.id === hovered);
  if (notice && !calibration && !sheet) drawNotice(context, notice);
}
