import type { ArcheryState } from 'threepoint-games/archery/archery-state';
import { fullScore, secondsLeft } from 'threepoint-games/archery/rules';
import { drawText, textWidth } from 'threepoint-ui/vr-panel';
import { ink, paintCard, paintGround } from '../../scene/boards/board-style';
import { paintScoreHeading } from '../../scene/boards/score-heading';
import { paintButton } from '../../scene/boards/sheet';

/** The texts of the board; equal boards are drawn once. */
export interface BoardText {
  readonly score: number;
  readonly maximum: number;
  readonly arrows: number;
  readonly arrowsLeft: number;
  /** Whole seconds left, rounded up as a clock that ends at 0. */
  readonly seconds: number;
  readonly phase: ArcheryState['phase'];
  readonly inZone: boolean;
  /** The last sentence: what the last arrow did, or what to do. */
  readonly line: string;
}

/** How an arrow's end reads on a board. */
export function arrowResult(state: ArcheryState, index: number): string {
  const arrow = state.arrows[index];
  if (!arrow) return 'not shot';
  if (!arrow.landing) return 'in flight';
  const { on, target, points } = arrow.landing;
  const hit = target === null ? undefined : state.targets[target];
  if (hit) return points > 0 ? `+${points}` : 'hit before';
  return on === 'wall' ? 'net' : 'grass';
}

/** The last sentence of the board at a time of the match [s]. */
export function statusLine(state: ArcheryState, time: number): string {
  if (!state.inZone) return 'Step back onto the deck';
  if (state.phase === 'ready')
    return state.options.startedBy === 'signal' ? 'Wait for the start' : 'First arrow starts the clock';
  const landed = state.arrows.filter(({ landing }) => landing && landing.time <= time);
  const last = landed.reduce<(typeof landed)[number] | null>(
    (latest, arrow) => (!latest || (arrow.landing?.time ?? 0) >= (latest.landing?.time ?? 0) ? arrow : latest),
    null,
  );
  if (!last?.landing) return state.options.everyHitCounts ? 'Every hit counts' : 'Each target counts once';
  const { target, points, on } = last.landing;
  const distance = target === null ? undefined : state.targets[target]?.distance;
  if (distance !== undefined) {
    return points > 0 ? `Target at ${distance} m: +${points}` : `Target at ${distance} m: again`;
  }
  return on === 'wall' ? 'Into the net' : 'Into the grass';
}

export function boardText(state: ArcheryState, time: number): BoardText {
  const left =
    state.phase === 'over'
      ? secondsLeft(state)
      : Math.max(0, state.options.seconds - (state.phase === 'ready' ? 0 : time));
  return {
    score: state.score,
    maximum: fullScore(state),
    arrows: state.options.arrows,
    arrowsLeft: state.arrowsLeft,
    seconds: Math.ceil(left),
    phase: state.phase,
    inZone: state.inZone,
    line: statusLine(state, time),
  };
}

export const boardSize = { width: 1024, height: 640 } as const;

/** An arrow as a mark, pointing up: full where it is left, an outline where it was shot. */
function pip(context: CanvasRenderingContext2D, x: number, y: number, height: number, left: boolean): void {
  context.save();
  context.translate(x, y);
  context.lineWidth = 7;
  context.lineCap = context.lineJoin = 'round';
  context.strokeStyle = left ? ink.accent : ink.line;
  context.fillStyle = left ? ink.accent : 'transparent';
  context.beginPath();
  context.moveTo(0, height);
  context.lineTo(0, 26);
  for (const y of [height - 2, height - 16]) {
    context.moveTo(-12, y + 6);
    context.lineTo(0, y - 8);
    context.lineTo(12, y + 6);
  }
  context.stroke();
  context.beginPath();
  context.moveTo(0, -4);
  context.lineTo(11, 28);
  context.lineTo(-11, 28);
  context.closePath();
  context.fill();
  context.stroke();
  context.restore();
}

/** Score, arrows, time and the last sentence, on boardSize. */
export function paintBoard(context: CanvasRenderingContext2D, text: BoardText): void {
  const { width, height } = boardSize;
  paintGround(context, width, height);
  const { score, maximum, seconds, phase } = text;
  paintScoreHeading(context, { score, of: maximum, seconds, running: phase === 'running' });

  drawText(context, 'ARROWS', [64, 444], { font: '700 54px', color: ink.soft });
  for (let i = 0; i < text.arrows; i++)
    pip(context, 370 + i * Math.min(66, 330 / text.arrows), 378, 100, i < text.arrowsLeft);
  const left = `${text.arrowsLeft} of ${text.arrows}`;
  drawText(context, left, [width - 64, 452], { font: '800 76px', color: ink.text, align: 'right' });

  if (!text.inZone) {
    context.fillStyle = ink.warning;
    context.fillRect(0, 516, width, height - 516);
  }
  const [line, color] = text.inZone ? [text.line, ink.text] : [`⚠ ${text.line}`, ink.accentInk];
  drawText(context, line, [64, 598], { font: '700 64px', color, maxWidth: width - 128 });
}

export const resultSize = { width: 1024, height: 768 } as const;

/** The restart button on a panel of resultSize [pixels]. */
export const restartButton = { id: 'restart', x: 312, y: 600, width: 400, height: 116 } as const;

const headline: Record<NonNullable<ArcheryState['end']>, string> = {
  targets: 'Every target scored',
  arrows: 'All arrows shot',
  time: 'Time is up',
};

/** What a round came to: score, percentage, each arrow, and the way to another round. */
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
