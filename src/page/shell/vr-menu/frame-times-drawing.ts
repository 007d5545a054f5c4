import type { TextStyle } from 'threepoint-ui/canvas-drawing';
import { drawText, fillRoundedRect, vrColors } from 'threepoint-ui/canvas-drawing';
import { differenceLines, type FrameReport, milliseconds, missedFrames } from 'threepoint-ui/frame-times-overlay';

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
