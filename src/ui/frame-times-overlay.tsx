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

/** Frame time by stage, as a card on the desktop. Render it a few times a second, not per frame. */
export const FrameTimes = ({ report }: { readonly report: FrameReport }) => (
  <>
    <p class="total">
      <strong>{`${milliseconds(report.p50Ms)} ms`}</strong>
      <span>{` p95 ${milliseconds(report.p95Ms)} ms`}</span>
    </p>
    <div class="stage-bar" aria-hidden>
      {report.stages.map(({ name, p50Ms }) => (
        <i class={`stage ${name}`} style={{ flexGrow: String(Math.max(p50Ms, 0.0001)) }} />
      ))}
    </div>
    <table>
      <thead>
        <tr>
          <th scope="col">ms per frame</th>
          <th scope="col">p50</th>
          <th scope="col">p95</th>
        </tr>
      </thead>
      <tbody>
        {report.stages.map(({ name, p50Ms, p95Ms }) => (
          <tr>
            <th scope="row" class={`stage ${name}`}>
              {name}
            </th>
            <td>{milliseconds(p50Ms)}</td>
            <td>{milliseconds(p95Ms)}</td>
          </tr>
        ))}
      </tbody>
    </table>
    <p class="missed">{missedFrames(report)}</p>
    <p class="method">{`${report.estimator} · ${report.provider}`}</p>
    {report.fromDevice && <p class="difference">{differenceLines(report.fromDevice).join(' · ')}</p>}
  </>
);
