import { type MeasuredMethod, measuredMethods } from './drive';
import { type Report, reportNames } from './measures';

/** The measures of all methods side by side, on the terminal. */
export function printReports(title: string, reports: Record<MeasuredMethod, Report>): void {
  console.log(`\n${title}`);
  const row = (label: string, cells: readonly string[]) =>
    console.log(`  ${label.padEnd(34)}${cells.map((cell) => cell.padStart(22)).join('')}`);
  row('', [...measuredMethods]);
  const spreadCell = ({ mean, median, p95 }: Report['mpjpeCm']) =>
    `${mean.toFixed(2)} / ${median.toFixed(2)} / ${p95.toFixed(2)}`;
  const each = (cell: (r: Report) => string) => measuredMethods.map((name) => cell(reports[name]));
  row(
    'MPJPE mean / median / p95 [cm]',
    each((r) => spreadCell(r.mpjpeCm)),
  );
  for (const name of reportNames)
    row(
      `  ${name}`,
      each((r) => spreadCell(r.joints[name])),
    );
  row(
    'network alone, MPJPE [cm]',
    each((r) => r.rawMpjpeCm?.toFixed(2) ?? '–'),
  );
  row(
    'elbow swivel error [°]',
    each((r) => r.swivelDeg.toFixed(1)),
  );
  row(
    'MSE per coordinate [cm²]',
    each((r) => r.mseCm2.toFixed(2)),
  );
  row(
    'MAE per coordinate [cm]',
    each((r) => r.maeCm.toFixed(2)),
  );
  row(
    'jerk against the truth',
    each((r) => `${r.jerkRatio.toFixed(2)} ×`),
  );
  row(
    'bone-length variation [mm]',
    each((r) => r.boneVariationMm.toFixed(3)),
  );
  row(
    'hand error mean / max [mm]',
    each((r) => `${r.handErrorMm.toFixed(3)} / ${r.handErrorMaxMm.toFixed(1)}`),
  );
}
