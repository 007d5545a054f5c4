import { element } from 'threepoint-ui';
import { checkedPaperRows, paperDf, paperFrameTimes, paperScores, savedShare } from '../../model/results/paper-tables';
import { paperTable } from '../../model/results/result-tables';
import { tableNode } from '../table';
import { bar, csvButton, fixed, paperAboutOf, pText } from './result-cells';

/** Returns the paper's printed numbers, recomputed from its t values and tables. */
export function paperCheck(): readonly Node[] {
  const rows = checkedPaperRows();
  const wrong = rows.filter(({ follows }) => !follows).map(({ question }) => question);
  return [
    element('h2', {}, 'The paper’s own numbers'),
    element(
      'p',
      {},
      `From the t values of its tables 9 and 10 with ${paperDf} degrees of freedom every p is recomputed. Printed values that do not match their t: ${wrong.join(' and ')}. The paper does not correct its twelve tests; Holm-adjusted values are shown next to it.`,
    ),
    tableNode(
      'Anvari, Park and Kim 2023, tables 9 and 10, recomputed',
      [
        { text: 'Question' },
        { text: 'ours', numeric: true },
        { text: 'IK', numeric: true },
        { text: 't', numeric: true },
        { text: 'printed p', numeric: true },
        { text: 'p from t', numeric: true },
        { text: 'd_z', numeric: true },
        { text: 'Holm p', numeric: true },
        { text: 'printed p follows?' },
      ],
      rows.map(({ question, ours, ik, t, printedP, p, dz, holmP, follows }) => ({
        look: follows ? '' : 'wrong',
        cells: [
          `${question} ${paperAboutOf(question)}`,
          fixed(ours, 2),
          fixed(ik, 2),
          fixed(t, 3),
          fixed(printedP, 3),
          p < 0.001 ? p.toFixed(4) : p.toFixed(3),
          fixed(dz, 2),
          pText(holmP),
          follows ? 'yes' : `no: p = ${p < 0.001 ? p.toFixed(4) : p.toFixed(3)}`,
        ],
      })),
    ),
    bar(csvButton(paperTable(), 'paper-check')),
    element(
      'ul',
      {},
      ...paperScores.map(({ task, maximum, ours, ik, printedPercent }) =>
        element(
          'li',
          {},
          `Score, ${task}: ${ours} and ${ik} of ${maximum} points are ${((100 * ours) / maximum).toFixed(2)} and ${((100 * ik) / maximum).toFixed(2)} %; printed ${printedPercent.ours} and ${printedPercent.ik} %.`,
        ),
      ),
      ...paperFrameTimes.map((times) =>
        element(
          'li',
          {},
          `Frame time, ${times.title}: ${times.ours.meanMs} against ${times.ik.meanMs} ms saves ${(100 * savedShare(times)).toFixed(0)} %; the text says approximately 60 %.`,
        ),
      ),
    ),
  ];
}
