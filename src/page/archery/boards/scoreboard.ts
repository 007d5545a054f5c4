import { Group } from 'three';
import { type ArcheryState, fullScore, secondsLeft } from 'threepoint-games/archery';
import { drawText } from 'threepoint-ui/vr';
import { ink, paintGround } from '../../scene/boards/board-style';
import { paintScoreHeading } from '../../scene/boards/score-heading';
import { createWoodenBoard } from '../../scene/boards/wooden-board';
import { createCanvasTexture } from '../../scene/canvas-texture';
import type { Quality } from '../../scene/renderer';

/** The texts of the board; equal boards are drawn once. */
interface BoardText {
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

/** Returns the last line of the board at a match time [s]. */
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

const boardSize = { width: 1024, height: 640 } as const;

/** Draws an arrow that points up: filled if it is left, an outline if it was shot. */
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
function paintBoard(context: CanvasRenderingContext2D, text: BoardText): void {
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

const place = { x: -4.9, z: -9 };
const boardWidth = 3;
const boardHeight = (boardWidth * boardSize.height) / boardSize.width;

/** Creates a board on two posts next to the field: score, arrows, time, the last hit; arena frame. */
export function createScoreboard(quality: Quality) {
  const object = new Group();
  object.name = 'scoreboard';
  // High beside the field, turned to the archer: a glance away from the targets, in front of none.
  object.position.set(place.x, 0, place.z);
  object.rotation.y = Math.atan2(-place.x, -place.z);
  const { texture, draw } = createCanvasTexture(boardSize.width, boardSize.height, quality);
  object.add(createWoodenBoard({ width: boardWidth, height: boardHeight, middle: 3.6 }, texture));
  let shown = '';
  return {
    object,
    /** Updates the board to a match time [s]. Redraws only after a change. */
    show(state: ArcheryState, time: number): void {
      const text = boardText(state, time);
      const key = JSON.stringify(text);
      if (key === shown) return;
      shown = key;
      draw((context) => paintBoard(context, text));
    },
  };
}
