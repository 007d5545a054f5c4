import type { ArcheryState } from 'threepoint-games/archery/archery-state';
import { fullScore } from 'threepoint-games/archery/rules';
import { drawText, textWidth } from 'threepoint-ui/canvas-drawing';
import { ink, paintCard } from '../../scene/boards/board-style';
import { paintButton } from '../../scene/boards/sheet';

/** Describes the result of an arrow for the board. */
export function arrowResult(state: ArcheryState, index: number): string {
  const arrow = state.arrows[index];
  if (!arrow) return 'not shot';
  if (!arrow.landing) return 'in flight';
  const { on, target, points } = arrow.landing;
  const hit = target === null ? undefined : state.targets[target];
  if (hit) return points > 0 ? `+${points}` : 'hit before';
  return on === 'wall' ? 'net' : 'grass';
}

export const resultSize = { width: 1024, height: 768 } as const;
/** The restart button on a panel of resultSize [pixels]. */
export const restartButton = { id: 'restart', x: 312, y: 600, width: 400, height: 116 } as const;

const headline: Record<NonNullable<ArcheryState['end']>, string> = {
  targets: 'Every target scored',
  arrows: 'All arrows shot',
  time: 'Time is up',
};

/** Paints the result of a round: score, percentage, each arrow, and the button for another round. */
export function paintResult(context: CanvasRenderingContext2D, state: ArcheryState, hovered: boolean): void {
  const { width, height } = resultSize;
  paintCard(context, width, height);

  const maximum = fullScore(state);
  const percent = maximum > 0 ? Math.round((100 * state.score) / maximum) : 0;
  const ending = state.end ? headline[state.end] : '';
  drawText(context, ending, [width / 2, 92], { font: '700 44px', color: ink.soft, align: 'center' });

  const score = String(state.score);
  const rest = `/ ${maximum}`;
  const share = `${percent} %`;
  const scoreWidth = textWidth(context, score, '800 210px');
  const restWidth = textWidth(context, rest, '700 80px');
  const shareWidth = textWidth(context, share, '800 80px') + 64;
  let x = (width - (scoreWidth + 26 + restWidth + 56 + shareWidth)) / 2;
  drawText(context, score, [x, 296], { font: '800 210px', color: ink.text });
  x += scoreWidth + 26;
  drawText(context, rest, [x, 296], { font: '700 80px', color: ink.soft });
  x += restWidth + 56;
  context.fillStyle = ink.accent;
  context.beginPath();
  context.roundRect(x, 196, shareWidth, 112, 56);
  context.fill();
  drawText(context, share, [x + 32, 281], { font: '800 80px', color: ink.accentInk });

  const count = Math.max(1, state.options.arrows);
  const gap = 16;
  const card = (width - 128 - gap * (count - 1)) / count;
  for (let i = 0; i < count; i++) {
    const left = 64 + i * (card + gap);
    const result = arrowResult(state, i);
    const scored = result.startsWith('+');
    context.fillStyle = scored ? 'rgba(143, 227, 192, 0.16)' : 'rgba(200, 216, 236, 0.08)';
    context.strokeStyle = scored ? ink.good : ink.line;
    context.lineWidth = scored ? 5 : 3;
    context.beginPath();
    context.roundRect(left, 366, card, 176, 20);
    context.fill();
    context.stroke();
    const number = { font: '700 32px', color: ink.soft, align: 'center', most: card - 12 } as const;
    drawText(context, `Arrow ${i + 1}`, [left + card / 2, 418], number);
    const look = scored ? { font: '800 84px', color: ink.text } : { font: '600 40px', color: ink.soft };
    drawText(context, result, [left + card / 2, scored ? 510 : 490], { ...look, align: 'center', maxWidth: card - 16 });
  }

  paintButton(context, restartButton, 'Restart', { primary: true, hovered, font: '800 56px' });
}
