import { checkedPaperRows, paperDf, paperFrameTimes, paperScores, savedShare } from '../../model/results/paper-tables';
import { paperTable } from '../../model/results/result-tables';
import { type Column, numberColumn, Table, textColumn } from '../table';
import { csvButton, fixed, paperAboutOf, pText } from './result-cells';

type PaperRow = ReturnType<typeof checkedPaperRows>[number];

const computedText = (p: number) => p.toFixed(p < 0.001 ? 4 : 3);

const columns: readonly Column<PaperRow>[] = [
  textColumn('Question', ({ question }) => `${question} ${paperAboutOf(question)}`),
  numberColumn('IK', ({ ik }) => fixed(ik, 2)),
  numberColumn('ours', ({ ours }) => fixed(ours, 2)),
  numberColumn('t', ({ t }) => fixed(t, 3)),
  numberColumn('printed p', ({ printedP }) => fixed(printedP, 3)),
  numberColumn('p from t', ({ p }) => computedText(p)),
  numberColumn('d_z', ({ dz }) => fixed(dz, 2)),
  numberColumn('Holm p', ({ holmP }) => pText(holmP)),
  textColumn('printed p follows?', ({ follows, p }) => (follows ? 'yes' : `no: p = ${computedText(p)}`)),
];

/** The paper's printed numbers, recomputed from its t values and tables. */
export function PaperCheck() {
  const rows = checkedPaperRows();
  const wrong = rows.filter(({ follows }) => !follows).map(({ question }) => question);
  return (
    <>
      <h2>The paper’s own numbers</h2>
      <p>
        {`From the t values of its tables 9 and 10 with ${paperDf} degrees of freedom every p is recomputed. Printed values that do not match their t: ${wrong.join(' and ')}. The paper does not correct its twelve tests; Holm-adjusted values are shown next to it.`}
      </p>
      <Table
        caption="Anvari, Park and Kim 2023, tables 9 and 10, recomputed"
        columns={columns}
        rows={rows}
        look={({ follows }) => (follows ? '' : 'wrong')}
      />
      <div class="bar">{csvButton(paperTable(), 'paper-check')}</div>
      <ul>
        {paperScores.map(({ task, maximum, ours, ik, printedPercent }) => (
          <li>
            {`Score, ${task}, IK and ours: ${ik} and ${ours} of ${maximum} points are ${((100 * ik) / maximum).toFixed(2)} and ${((100 * ours) / maximum).toFixed(2)} %; printed ${printedPercent.ik} and ${printedPercent.ours} %.`}
          </li>
        ))}
        {paperFrameTimes.map((times) => (
          <li>
            {`Frame time, ${times.title}, IK and ours: ${times.ik.meanMs} and ${times.ours.meanMs} ms, which saves ${(100 * savedShare(times)).toFixed(0)} %; the text says approximately 60 %.`}
          </li>
        ))}
      </ul>
    </>
  );
}
