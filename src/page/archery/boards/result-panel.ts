import { Group } from 'three';
import type { Vec3 } from 'threepoint/math';
import { type ArcheryState, fullScore } from 'threepoint-games/archery';
import { drawText, textWidth } from 'threepoint-ui/vr';
import { ink, paintCard } from '../../scene/boards/board-style';
import { buttonUnder, createSheet, paintButton, type SheetContent, type SheetSize } from '../../scene/boards/sheet';
import type { Quality } from '../../scene/renderer';

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

const resultSize = { width: 1024, height: 768 } as const;
/** The restart button on a panel of resultSize [pixels]. */
const restartButton = { id: 'restart', x: 312, y: 600, width: 400, height: 116 } as const;

const headline: Record<NonNullable<ArcheryState['end']>, string> = {
  targets: 'Every target scored',
  arrows: 'All arrows shot',
  time: 'Time is up',
};

/** Paints the result of a round: score, percentage, each arrow, and the button for another round. */
function paintResult(context: CanvasRenderingContext2D, state: ArcheryState, hovered: boolean): void {
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
    const number = { font: '700 32px', color: ink.soft, align: 'center', maxWidth: card - 12 } as const;
    drawText(context, `Arrow ${i + 1}`, [left + card / 2, 418], number);
    const look = scored ? { font: '800 84px', color: ink.text } : { font: '600 40px', color: ink.soft };
    drawText(context, result, [left + card / 2, scored ? 510 : 490], { ...look, align: 'center', maxWidth: card - 16 });
  }

  paintButton(context, restartButton, 'Restart', { primary: true, hovered, font: '800 56px' });
}

const size: SheetSize = { ...resultSize, metres: 1.36 };

/** Whether a point of the panel [m, from its middle] lies on the restart button. */
export const onRestartButton = (x: number, y: number): boolean => buttonUnder([restartButton], size, x, y) !== null;

/** Creates the panel at the end of a round: score, percentage, each arrow, a button for another round; arena frame. */
export function createResultPanel(quality: Quality) {
  const object = new Group();
  object.name = 'result panel';
  object.position.z = -2.1;
  const sheet = createSheet<'restart'>(size, quality);
  object.add(sheet.mesh);
  /** The content for the newest result. The arrows of a finished round are the same objects in every frame. */
  let content: SheetContent<'restart'> | null = null;
  let of: ArcheryState | null = null;

  function contentOf(state: ArcheryState): SheetContent<'restart'> {
    if (content && of?.arrows === state.arrows && of.score === state.score && of.end === state.end) return content;
    of = state;
    content = {
      key: JSON.stringify([state.score, state.end, state.arrows]),
      buttons: [restartButton],
      paint: (context, hovered) => paintResult(context, state, hovered !== null),
    };
    return content;
  }

  return {
    object,
    /** Shows the result of a round that is over; hides itself otherwise. `time`: of the match [s]. */
    show(state: ArcheryState, time: number): void {
      // A little below the eyes, standing or seated.
      object.position.y = state.options.eyeHeight - 0.18;
      sheet.show(state.phase === 'over' ? contentOf(state) : null, time);
    },
    /**
     * Distance along a ray [m, floor frame; unit direction] to the restart button; null: it misses, or there is no
     * panel now.
     */
    restartAt: (origin: Vec3, direction: Vec3): number | null => sheet.buttonAt(origin, direction)?.distance ?? null,
    setHovered: (on: boolean): void => sheet.setHovered(on ? 'restart' : null),
  };
}
