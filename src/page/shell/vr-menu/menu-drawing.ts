import { type CalibrationStep, calibrationHeadline, calibrationInstruction } from 'threepoint-ui/calibration-dialog';
import { drawQrCode } from 'threepoint-ui/qr-code';
import { fillRounded, vrColors, vrFont, wrap } from 'threepoint-ui/vr-panel';
import {
  type MenuButton,
  menuHeight,
  menuMargin,
  menuWidth,
  noticesTop,
  otherHeight,
  othersTop,
  type ShownInvitation,
  type VrMenuState,
} from './menu-buttons';

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

/** Code and address as large as the sheet is wide: they are read from a screen that shows what the headset sees. */
function drawInvitation(context: CanvasRenderingContext2D, { room, address, limit, code }: ShownInvitation): void {
  if (typeof code === 'object') drawQrCode(context, code, [menuMargin, 116, inner]);
  else {
    context.fillStyle = vrColors.inkSoft;
    context.font = `500 34px ${vrFont}`;
    const text = code === 'loading' ? 'The code comes in a moment.' : 'The code could not be loaded: use the address.';
    for (const [index, line] of wrap(context, text, inner).entries())
      context.fillText(line, menuMargin, 300 + index * 44);
  }
  context.fillStyle = vrColors.ink;
  context.font = `650 52px ${vrFont}`;
  context.fillText(`Room ${room}`, menuMargin, 732, inner);
  context.font = `500 34px ${vrFont}`;
  context.fillStyle = vrColors.ink;
  // An address has no spaces: it is broken before what it asks for.
  const [place = address, query] = address.split(/(?=\?)/);
  const lines = query === undefined ? [place] : [place, query];
  for (const [index, line] of lines.entries()) context.fillText(line, menuMargin, 794 + index * 46, inner);
  if (limit === null) return;
  context.fillStyle = vrColors.inkSoft;
  context.font = `400 22px ${vrFont}`;
  for (const [index, line] of wrap(context, limit, inner).slice(0, 3).entries())
    context.fillText(line, menuMargin, 888 + index * 28);
}

/** Who else is here; what can be done about them stands below each. */
function drawOthers(context: CanvasRenderingContext2D, { others }: VrMenuState): void {
  context.textAlign = 'left';
  for (const [row, { name, role, said }] of others.entries()) {
    const top = othersTop + row * otherHeight;
    context.fillStyle = vrColors.ink;
    context.font = `650 40px ${vrFont}`;
    context.fillText(name, menuMargin + 4, top + 24, inner - 8);
    context.fillStyle = vrColors.inkSoft;
    context.font = `500 28px ${vrFont}`;
    context.fillText([role, said].filter(Boolean).join(' · '), menuMargin + 4, top + 70, inner - 8);
  }
  if (others.length > 0) return;
  context.fillStyle = vrColors.inkSoft;
  context.font = `500 34px ${vrFont}`;
  context.fillText('No one else is here now.', menuMargin + 4, othersTop + 24, inner);
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
  const { calibration, invitation, listed, notice } = state;
  const heading = calibration ? 'Calibrate' : invitation ? 'Invite others' : listed ? 'Other players' : 'Estimator';
  context.fillText(heading, menuMargin + 4, 72);
  if (calibration) drawCalibration(context, calibration);
  else if (invitation) drawInvitation(context, invitation);
  else if (listed) drawOthers(context, state);
  for (const button of buttons) drawButton(context, button, button.id === hovered);
  if (notice && !calibration && !invitation && !listed) drawNotice(context, notice);
}
