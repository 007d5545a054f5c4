import { describe, expect, test } from 'vitest';
import { powerTable, simulatedPower } from '../../../src/study/statistics/power';

const simulation = { seed: 22, studies: 10_000 };
/** Three standard errors of a share of as many studies. */
const tolerance = 0.015;

describe('the power of a study that is yet to be run', () => {
  // R's power.t.test(n, delta = 0.5, type, strict = TRUE).
  test.each([
    ['paired', 20, 0.564504418439084],
    ['paired', 34, 0.80777750127944],
    ['between', 64, 0.801459557922328],
  ] as const)('%s, of %i, is what R computes for the t-test', (design, n, power) => {
    const { t, wilcoxon } = simulatedPower({ design, effect: 0.5, alpha: 0.05 }, n, simulation);
    expect(Math.abs(t - power)).toBeLessThan(tolerance);
    // For normal values Wilcoxon's tests have the power of 3/π of the participants.
    expect(wilcoxon).toBeLessThan(t);
    expect(wilcoxon).toBeGreaterThan(t - 0.05);
  });

  test.each(['paired', 'between'] as const)('%s, without an effect, is alpha; ranks never exceed it', (design) => {
    const { t, wilcoxon } = simulatedPower({ design, effect: 0, alpha: 0.05 }, 15, simulation);
    expect(Math.abs(t - 0.05)).toBeLessThan(0.007);
    expect(wilcoxon).toBeLessThan(0.057);
  });

  test('has a table that ends where both tests reach it, repeatable by its seed', () => {
    const planned = { design: 'paired', effect: 0.8, alpha: 0.05 } as const;
    const rows = powerTable(planned, 0.8, { seed: 3, studies: 2000 });
    expect(rows).toEqual(powerTable(planned, 0.8, { seed: 3, studies: 2000 }));
    // R: power.t.test(delta = 0.8, power = 0.8, type = "paired") says 14.3.
    expect(Math.abs((rows.find(({ t }) => t >= 0.8)?.n ?? 0) - 15)).toBeLessThanOrEqual(1);
    expect(rows.at(-1)?.wilcoxon).toBeGreaterThanOrEqual(0.8);
    expect(rows.at(-2)?.wilcoxon).toBeLessThan(0.8);
  });
});
