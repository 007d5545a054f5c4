import { element } from './element';

/** One stage of the frame and what it costs [ms]. */
interface StageCost {
  readonly name: string;
  readonly p50Ms: number;
  readonly p95Ms: number;
}

/** The content of the overlay, measured over the last seconds. */
export interface FrameReport {
  readonly p50Ms: number;
  readonly p95Ms: number;
  readonly stages: readonly StageCost[];
  readonly missed: number;
  readonly frames: number;
  readonly rateHz: number;
  readonly estimator: string;
  readonly provider: string;
  /** The distance of the drawn joints from those of the device's own body [cm]; null: it has none now. */
  readonly fromDevice: readonly { readonly name: string; readonly cm: number }[] | null;
}

/** Formats milliseconds with two or three significant digits. */
export function milliseconds(ms: number): string {
  if (!Number.isFinite(ms)) return '–';
  return ms < 0.995 ? ms.toFixed(2) : ms < 9.95 ? ms.toFixed(1) : ms.toFixed(0);
}

/** Describes how many frames were late: a count is clearer than a percentage while they are few. */
export function missedFrames(report: Pick<FrameReport, 'missed' | 'frames' | 'rateHz'>): string {
  const share = report.frames === 0 ? 0 : (100 * report.missed) / report.frames;
  return `${share.toFixed(share > 0 && share < 9.95 ? 1 : 0)} % missed at ${Math.round(report.rateHz)} Hz`;
}

/** Formats the distance of the drawn joints from the device's in two lines; left before right. */
export function differenceLines(fromDevice: NonNullable<FrameReport['fromDevice']>): readonly [string, string] {
  const of = (joint: string) => {
    const found = fromDevice.filter(({ name }) => name.endsWith(joint)).map(({ cm }) => cm.toFixed(1));
    return `${joint}${found.length > 1 ? 's' : ''} ${found.join(', ')}`;
  };
  return [`cm from the device’s: ${of('elbow')}`, `${of('shoulder')} · ${of('spine')} · ${of('pelvis')}`];
}

/** Frame time by stage, as a card on the desktop. Call `show` a few times a second, not per frame. */
export function createFrameTimesOverlay(region: HTMLElement) {
  const total = element('strong', {}, '–');
  const tail = element('span', {}, '');
  const missed = element('p', { class: 'missed' });
  const method = element('p', { class: 'method' });
  const bar = element('div', { class: 'stage-bar', 'aria-hidden': 'true' });
  const rows = element('tbody');
  const difference = element('p', { class: 'difference' });
  const cells = new Map<string, { part: HTMLElement; p50: HTMLElement; p95: HTMLElement }>();
  region.append(
    element('p', { class: 'total' }, total, tail),
    bar,
    element(
      'table',
      {},
      element(
        'thead',
        {},
        element(
          'tr',
          {},
          element('th', { scope: 'col' }, 'ms per frame'),
          element('th', { scope: 'col' }, 'p50'),
          element('th', { scope: 'col' }, 'p95'),
        ),
      ),
      rows,
    ),
    missed,
    method,
    difference,
  );

  function cellsOf(name: string) {
    const known = cells.get(name);
    if (known) return known;
    const p50 = element('td');
    const p95 = element('td');
    const row = element('tr', {}, element('th', { scope: 'row', class: `stage ${name}` }, name), p50, p95);
    const part = element('i', { class: `stage ${name}` });
    rows.append(row);
    bar.append(part);
    const made = { part, p50, p95 };
    cells.set(name, made);
    return made;
  }

  return {
    setVisible(visible: boolean): void {
      region.hidden = !visible;
    },
    show(report: FrameReport): void {
      if (region.hidden) return;
      total.textContent = `${milliseconds(report.p50Ms)} ms`;
      tail.textContent = ` p95 ${milliseconds(report.p95Ms)} ms`;
      for (const stage of report.stages) {
        const { part, p50, p95 } = cellsOf(stage.name);
        part.style.flexGrow = String(Math.max(stage.p50Ms, 0.0001));
        p50.textContent = milliseconds(stage.p50Ms);
        p95.textContent = milliseconds(stage.p95Ms);
      }
      missed.textContent = missedFrames(report);
      method.textContent = `${report.estimator} · ${report.provider}`;
      difference.hidden = report.fromDevice === null;
      if (report.fromDevice) difference.textContent = differenceLines(report.fromDevice).join(' · ');
    },
  };
}
