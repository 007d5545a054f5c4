// @module-tag full
import { spawnSync } from 'node:child_process';
import { normalNumbers } from 'threepoint/core/math/random';
import { rankSumTest, welchTest } from 'threepoint-study/statistics/between-tests';
import { pairedTTest, signedRankTest } from 'threepoint-study/statistics/paired-tests';
import { meanOf } from 'threepoint-study/statistics/summaries';
import { expect, test } from 'vitest';
import { installed } from '../../server/installed';
import { expectAsInR } from './as-in-r';
import { chicks, depression, insectSprays, ozone, placenta, plantGrowth, sleep, threeRounds } from './data-sets';

/** R's own figures of two samples, a line each: name and value, 17 digits. Ranks by nine digits, from R 4.1 on. Intervals of d by uniroot over pt with a noncentrality. */
const program = `
said <- function(name, value) cat(name, sprintf("%.17g", value), "\\n")
ends <- function(t, df, unit) vapply(c(0.975, 0.025), function(share) {
  below <- function(delta) suppressWarnings(pt(t, df, delta)) - share
  uniroot(below, c(-37, 37), tol = 1e-13, maxiter = 10000)$root * unit
}, 0)
n <- c(length(a), length(b))
welch <- t.test(a, b)
said("t", welch$statistic); said("df", welch$parameter); said("p", welch$p.value)
said("low", welch$conf.int[1]); said("high", welch$conf.int[2])
ds <- (mean(a) - mean(b)) / sqrt(((n[1] - 1) * var(a) + (n[2] - 1) * var(b)) / (sum(n) - 2))
unit <- sqrt(sum(1 / n))
of_ds <- ends(ds / unit, sum(n) - 2, unit)
said("ds", ds); said("lowDs", of_ds[1]); said("highDs", of_ds[2])
ranks <- suppressWarnings(wilcox.test(a, b, digits.rank = 9))
said("w", ranks$statistic); said("ranksP", ranks$p.value)
if (n[1] == n[2]) {
  paired <- t.test(a, b, paired = TRUE)
  signed <- suppressWarnings(wilcox.test(a, b, paired = TRUE, digits.rank = 9))
  of_dz <- ends(paired$statistic, n[1] - 1, 1 / sqrt(n[1]))
  said("pairedT", paired$statistic); said("pairedP", paired$p.value); said("v", signed$statistic); said("signedP", signed$p.value)
  said("dz", mean(a - b) / sd(a - b)); said("lowDz", of_dz[1]); said("highDz", of_dz[2])
}
`;

const drawn = (seed: number, count: number, mean: number) => {
  const normal = normalNumbers(seed);
  return Array.from({ length: count }, () => mean + normal());
};
const column = (rows: readonly (readonly number[])[], at: number) => rows.map((row) => row[at] as number);

const samples: readonly (readonly [string, readonly number[], readonly number[]])[] = [
  ['sleep', sleep.first, sleep.second],
  ['depression', depression.first, depression.second],
  ['placenta', placenta.term, placenta.early],
  ['airquality, ozone in May and August', ozone.may, ozone.august],
  ['PlantGrowth, control and second treatment', plantGrowth[0] as number[], plantGrowth[2] as number[]],
  ['InsectSprays A and B', insectSprays[0] as number[], insectSprays[1] as number[]],
  ['ChickWeight after 20 days, diets 1 and 3', column(chicks[0] as number[][], 2), column(chicks[2] as number[][], 2)],
  ['means of three rounds', threeRounds.first.map(meanOf), threeRounds.second.map(meanOf)],
  ['drawn, equal sizes', drawn(3, 30, 0.6), drawn(4, 30, 0)],
  ['drawn, unequal sizes', drawn(5, 12, -1), drawn(6, 49, 0)],
  ['drawn, more than are ranked exactly', drawn(7, 60, 0.4), drawn(8, 60, 0)],
];

const r = installed('Rscript');
const comparing = r === null ? test.skip : test;

comparing.each(samples)(
  `two samples as the installed R has them: %s${r ? '' : ' (left out: R is not installed)'}`,
  (_, a, b) => {
    const vectors = `a <- c(${a.join(', ')})\nb <- c(${b.join(', ')})\n`;
    const { stdout, stderr, status } = spawnSync(r as string, ['-'], { input: vectors + program, encoding: 'utf8' });
    expect(status, stderr).toBe(0);
    const figures = new Map(
      stdout
        .trim()
        .split('\n')
        .map((line) => line.trim().split(' '))
        .map(([name = '', value]) => [name, Number(value)]),
    );
    const asInR = (name: string, ours: number | null | undefined) => expectAsInR(ours, figures.get(name) ?? Number.NaN);
    const welch = welchTest(a, b);
    asInR('t', welch.t);
    asInR('df', welch.df);
    asInR('p', welch.p);
    asInR('low', welch.interval?.low);
    asInR('high', welch.interval?.high);
    asInR('ds', welch.ds);
    asInR('lowDs', welch.dsInterval?.low);
    asInR('highDs', welch.dsInterval?.high);
    const ranks = rankSumTest(a, b);
    asInR('w', ranks.w);
    asInR('ranksP', ranks.p);
    if (a.length !== b.length) return;
    const paired = pairedTTest(a, b);
    const signed = signedRankTest(a, b);
    asInR('pairedT', paired.t);
    asInR('pairedP', paired.p);
    asInR('dz', paired.dz);
    asInR('lowDz', paired.dzInterval?.low);
    asInR('highDz', paired.dzInterval?.high);
    asInR('v', signed.v);
    asInR('signedP', signed.p);
  },
);
