import { describe, expect, test } from 'vitest';
import {
  checkedPaperRows,
  paperFrameTimes,
  paperRows,
  paperScores,
  savedShare,
} from '../../../src/study/model/results/paper-tables';

describe("the paper's own numbers", () => {
  test('two printed p-values do not follow from their t: Q1 and Q11', () => {
    expect(
      checkedPaperRows()
        .filter(({ follows }) => !follows)
        .map(({ question }) => question),
    ).toEqual(['Q1', 'Q11']);
  });

  test('Q1 is better than printed, Q11 worse', () => {
    const rows = new Map(checkedPaperRows().map((row) => [row.question, row]));
    expect(rows.get('Q1')?.p).toBeCloseTo(0.0004, 4);
    expect(rows.get('Q11')?.p).toBeCloseTo(0.037, 3);
  });

  test('the others are cut off after the third decimal', () => {
    for (const { question, p, printedP } of checkedPaperRows()) {
      if (question === 'Q1' || question === 'Q11') continue;
      expect(Math.floor(p * 1000) / 1000, question).toBe(printedP);
    }
  });

  test('after correction for twelve questions, five of the eleven differences remain', () => {
    const significant = (key: 'p' | 'holmP') =>
      checkedPaperRows()
        .filter((row) => row[key] < 0.05)
        .map(({ question }) => question);
    expect(significant('p')).toHaveLength(11);
    expect(significant('holmP')).toEqual(['Q1', 'Q2', 'Q7', 'Q9', 'Q10']);
  });

  test('every mean difference has the sign of its t', () => {
    for (const { ours, ik, t } of paperRows) expect(Math.sign(ours - ik)).toBe(Math.sign(t));
  });

  test('scores in per cent belong to a maximum of 50 points and of 20 balls', () => {
    for (const { maximum, ours, ik, printedPercent } of paperScores) {
      expect((100 * ours) / maximum).toBeCloseTo(printedPercent.ours, 1);
      expect((100 * ik) / maximum).toBeCloseTo(printedPercent.ik, 1);
    }
  });

  test('the frame takes 34 and 45 per cent less, not 60', () => {
    expect(paperFrameTimes.map((table) => Math.round(100 * savedShare(table)))).toEqual([34, 45]);
  });
});
