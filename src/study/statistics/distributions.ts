/** How far from 1 the last factor of a continued fraction may be. */
const converged = 4 * Number.EPSILON;
/** Replaces a denominator of 0, as Lentz's method requires. */
const tiny = 1e-300;

/** Returns ln Γ(x) of a positive x, by Stirling's series above 10. */
function logGamma(x: number): number {
  let shift = 1;
  let above = x;
  for (; above < 10; above++) shift *= above;
  const square = 1 / above ** 2;
  const terms = [1 / 12, -1 / 360, 1 / 1260, -1 / 1680, 1 / 1188, -691 / 360_360, 1 / 156];
  const series = terms.reduceRight((sum, term) => sum * square + term, 0) / above;
  return (above - 0.5) * Math.log(above) - above + Math.log(2 * Math.PI) / 2 + series - Math.log(shift);
}

/** Returns b(0) + a(1) / (b(1) + a(2) / (b(2) + …)) by Lentz's method. */
function continuedFraction(a: (index: number) => number, b: (index: number) => number): number {
  let value = b(0) || tiny;
  let upper = value;
  let lower = 0;
  let factor = 0;
  for (let index = 1; Math.abs(factor - 1) > converged; index++) {
    lower = 1 / (b(index) + a(index) * lower || tiny);
    upper = b(index) + a(index) / upper || tiny;
    factor = upper * lower;
    value *= factor;
  }
  return value;
}

/** Returns the regularised incomplete beta function I_x(a, b) of positive a and b. */
export function incompleteBeta(x: number, a: number, b: number): number {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  // The fraction converges quickly on this side of the mean.
  if (x > (a + 1) / (a + b + 2)) return 1 - incompleteBeta(1 - x, b, a);
  const front = Math.exp(a * Math.log(x) + b * Math.log1p(-x) + logGamma(a + b) - logGamma(a) - logGamma(b));
  const numerator = (index: number): number => {
    const m = Math.floor(index / 2);
    const even = index % 2 === 0;
    return ((even ? m * (b - m) : -(a + m) * (a + b + m)) * x) / ((a + index - 1) * (a + index));
  };
  return front / (a * continuedFraction(numerator, () => 1));
}

/** Returns the upper regularised incomplete gamma function Q(a, x) of a positive a. */
export function gammaTail(a: number, x: number): number {
  if (x <= 0) return 1;
  const front = Math.exp(a * Math.log(x) - x - logGamma(a));
  if (x >= a + 1)
    return (
      front /
      continuedFraction(
        (index) => index * (a - index),
        (index) => x + 2 * index + 1 - a,
      )
    );
  let term = 1 / a;
  let sum = term;
  for (let index = 1; term > sum * Number.EPSILON; index++) {
    term *= x / (a + index);
    sum += term;
  }
  return 1 - front * sum;
}

/** Returns the probability that a standard normal value is at most z. */
export function normalCdf(z: number): number {
  const tail = gammaTail(0.5, (z * z) / 2) / 2;
  return z < 0 ? tail : 1 - tail;
}

/** Returns the probability that Wilcoxon's V of n pairs without ties is at most v: a share of all sums of ranks. */
export function signedRankCdf(v: number, n: number): number {
  // ways[sum]: the share of the choices among the first ranks that have this sum.
  const ways = new Float64Array((n * (n + 1)) / 2 + 1);
  ways[0] = 1;
  for (let rank = 1; rank <= n; rank++) {
    for (let sum = ways.length - 1; sum >= 0; sum--) {
      ways[sum] = ((ways[sum] as number) + (sum < rank ? 0 : (ways[sum - rank] as number))) / 2;
    }
  }
  return ways.subarray(0, Math.floor(v) + 1).reduce((total, share) => total + share, 0);
}

/** Returns a function that computes each value once. */
export function cached(compute: (at: number) => number): (at: number) => number {
  const known = new Map<number, number>();
  return (at) => {
    const value = known.get(at) ?? compute(at);
    known.set(at, value);
    return value;
  };
}
