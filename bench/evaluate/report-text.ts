import { type MeasuredMethod, measuredMethods } from './drive';
import { type Report, reportNames, type Spread } from './measures';

/** A row of a table of methods side by side. */
export const methodRow = (label: string, cells: readonly string[]): string =>
  `  ${label.padEnd(34)}${cells.map((cell) => cell.padStart(22)).join('')}`.trimEnd();

const spreadCell = ({ mean, median, p95 }: Spread) => `${mean.toFixed(2)} / ${median.toFixed(2)} / ${p95.toFixed(2)}`;

const rows: readonly (readonly [label: string, cell: (report: Report) => string])[] = [
  ['MPJPE mean / median / p95 [cm]', (r) => spreadCell(r.mpjpeCm)],
  ...reportNames.map((name) => [`  ${name}`, (r: Report) => spreadCell(r.joints[name])] as const),
  ['network alone, MPJPE [cm]', (r) => r.rawMpjpeCm?.toFixed(2) ?? '–'],
  ['elbow swivel error [°]', (r) => r.swivelDeg.toFixed(1)],
  ['MSE per coordinate [cm²]', (r) => r.mseCm2.toFixed(2)],
  ['MAE per coordinate [cm]', (r) => r.maeCm.toFixed(2)],
  ['jerk against the truth', (r) => `${r.jerkRatio.toFixed(2)} ×`],
  ['bone-length variation [mm]', (r) => r.boneVariationMm.toFixed(3)],
  ['hand error mean / max [mm]', (r) => `${r.handErrorMm.toFixed(3)} / ${r.handErrorMaxMm.toFixed(1)}`],
];

/** The measures of all methods side by side, on the terminal. */
export function printReports(title: string, reports: Record<MeasuredMethod, Report>): void {
  console.log(`\n${title}`);
  console.log(methodRow('', measuredMethods));
  for (const [label, cell] of rows) {
    const cells = measuredMethods.map((name) => cell(reports[name]));
    console.log(methodRow(label, cells));
  }
}
