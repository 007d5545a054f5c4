import { checked, integerBetween, numberBetween, ValidationError } from 'threepoint/core';
import * as v from 'valibot';
import { maxSimulated, type PlannedTest, type PowerRow, powerTable } from '../../statistics/power';

const given = <Schema extends v.GenericSchema<number, number>>(schema: Schema, otherwise: string) =>
  v.pipe(v.optional(v.string(), otherwise), v.transform(Number), schema);

const asked = v.object({
  effect: v.pipe(
    v.string('is missing: the difference in standard deviations, as 0.5'),
    v.transform(Number),
    numberBetween(0, 10),
  ),
  margin: v.exactOptional(v.pipe(v.string(), v.transform(Number), numberBetween(0.05, 10))),
  design: v.optional(v.picklist(['paired', 'between'], 'expected paired or between'), 'paired'),
  power: given(numberBetween(0.1, 0.99), '0.8'),
  alpha: given(numberBetween(0.0001, 0.5), '0.05'),
  studies: given(integerBetween(100, 1_000_000), '10000'),
  seed: given(integerBetween(0, 2 ** 31 - 1), '1'),
});

/** The smallest effect for which participants are counted. */
const smallestEffect = 0.05;
/** The distance from the wanted power within which every row is shown; below, every fifth row. */
const closeToIt = 0.05;

/** Throws a ValidationError for an effect that no number of participants shows. */
function rejectUnreachable({ effect, margin, design }: PlannedTest): void {
  if (margin === undefined) {
    if (effect < smallestEffect) throw new ValidationError('effect', `expected at least ${smallestEffect}`);
    return;
  }
  if (design !== 'paired')
    throw new ValidationError('margin', 'equivalence is tested between conditions: design paired');
  if (effect >= margin) throw new ValidationError('effect', `expected less than the margin, ${margin}`);
}

/** Returns the first row at which a test reaches the power, in words. */
function needed(rows: readonly PowerRow[], test: 't' | 'wilcoxon', power: number): string {
  const row = rows.find((one) => (one[test] ?? 0) >= power);
  return row ? `${row.n}` : `more than ${maxSimulated}`;
}

function printTable(): void {
  const { power, seed, studies, ...planned } = checked(asked, JSON.parse(process.argv[2] ?? '{}'));
  rejectUnreachable(planned);
  const rows = powerTable(planned, power, { seed, studies });
  const { margin } = planned;
  const paired = planned.design === 'paired';
  const units = paired ? 'participants' : 'participants in each cohort';
  const tested =
    margin === undefined
      ? `two-sided α = ${planned.alpha}`
      : `two one-sided tests of equivalence within ±${margin}, α = ${planned.alpha}`;
  const byRanks = (text: string) => (margin === undefined ? text : '');
  console.log(
    [
      `${paired ? 'Paired, d_z' : 'Between participants, d_s'} = ${planned.effect}, ${tested}: ${studies} simulated studies a row, normal values, seed ${seed}.`,
      '',
      `${units}   t-test${byRanks('   Wilcoxon')}`,
      ...rows
        .filter((row) => row.n % 5 === 0 || row.t >= power - closeToIt)
        .map(
          ({ n, t, wilcoxon }) =>
            `${String(n).padStart(units.length)}   ${t.toFixed(3).padStart(6)}${byRanks(`   ${wilcoxon?.toFixed(3).padStart(8)}`)}`,
        ),
      '',
      `For a power of ${power}: ${needed(rows, 't', power)} ${units} by the t-test${byRanks(`, ${needed(rows, 'wilcoxon', power)} by Wilcoxon’s`)}.`,
    ].join('\n'),
  );
}

try {
  printTable();
} catch (error) {
  if (!(error instanceof ValidationError)) throw error;
  console.error(`study:power: --${error.message}`);
  process.exitCode = 1;
}
