import { differenceLines, type FrameReport, milliseconds, missedFrames } from 'threepoint-ui/overlay';
import { fillRounded, vrColors, vrFont } from 'threepoint-ui/vr-panel';

/** The sheet of the frame times [pixels]. */
export const frameTimesWidth = 520;
export const frameTimesHeight = 530;

interface Row {
  readonly label: string;
  readonly p50: string;
  readonly p95: string;
  readonly color: string;
  readonly font: string;
}

function drawRow(context: CanvasRenderingContext2D, y: number, { label, p50, p95, color, font }: Row): void {
  context.font = font;
  context.fillStyle = color;
  context.textAlign = 'left';
  context.fillText(label, 32, y);
  context.textAlign = 'right';
  context.fillText(p50, 380, y);
  context.fillText(p95, 488, y);
}

/** Frame time by stage, on its sheet in the headset. */
export function drawFrameTimes(context: CanvasRenderingContext2D, report: FrameReport): void {
  const { p50Ms, p95Ms, stages, estimator, provider, fromDevice } = report;
  const times = (p50: number, p95: number) => ({ p50: milliseconds(p50), p95: milliseconds(p95) });
  const { glass, line, inkSoft, accent, ink } = vrColors;
  fillRounded(context, [2, 2, frameTimesWidth - 4, frameTimesHeight - 4], 32, glass, line);
  context.textBaseline = 'middle';
  const head = { label: 'ms per frame', p50: 'p50', p95: 'p95' };
  drawRow(context, 48, { ...head, color: inkSoft, font: `500 26px ${vrFont}` });
  drawRow(context, 92, { label: 'frame', ...times(p50Ms, p95Ms), color: accent, font: `650 34px ${vrFont}` });
  for (const [index, stage] of stages.entries()) {
    const row = { label: stage.name, ...times(stage.p50Ms, stage.p95Ms), color: ink, font: `500 28px ${vrFont}` };
    drawRow(context, 140 + index * 40, row);
  }
  context.textAlign = 'left';
  context.fillStyle = inkSoft;
  context.font = `500 25px ${vrFont}`;
  context.fillText(missedFrames(report), 32, 386, 456);
  context.fillText(`${estimator} · ${provider}`, 32, 424, 456);
  if (!fromDevice) return;
  const [arms, trunk] = differenceLines(fromDevice);
  context.fillText(arms, 32, 462, 456);
  context.fillText(trunk, 32, 500, 456);
}
