import { describe, expect, test } from 'vitest';
import { nextRandom, type RandomState } from '../../../../src/threepoint/core/math/random';

function draw(seed: number, count: number): number[] {
  const values: number[] = [];
  let state: RandomState = { seed };
  for (let i = 0; i < count; i++) {
    const next = nextRandom(state);
    values.push(next.value);
    state = next.state;
  }
  return values;
}

describe('the generator', () => {
  test('equal seeds give equal numbers, another seed others', () => {
    expect(draw(7, 20)).toEqual(draw(7, 20));
    expect(draw(7, 20)).not.toEqual(draw(8, 20));
  });

  test('numbers lie in [0, 1) and fill it evenly', () => {
    const values = draw(1, 20_000);
    expect(Math.min(...values)).toBeGreaterThanOrEqual(0);
    expect(Math.max(...values)).toBeLessThan(1);
    const tenths = new Array<number>(10).fill(0);
    for (const value of values) tenths[Math.floor(value * 10)]! += 1;
    // Five standard deviations of a binomial count: 2000 ± 212.
    for (const count of tenths) expect(Math.abs(count - 2000)).toBeLessThan(212);
  });

  test('one number says nothing about the next', () => {
    const values = draw(3, 20_000);
    let sum = 0;
    for (let i = 1; i < values.length; i++) sum += (values[i]! - 0.5) * (values[i - 1]! - 0.5);
    expect(Math.abs((sum / values.length) * 12)).toBeLessThan(0.035);
  });

  test('the state is a plain number that survives JSON', () => {
    const { state } = nextRandom({ seed: 5 });
    expect(nextRandom(JSON.parse(JSON.stringify(state)))).toEqual(nextRandom(state));
  });
});
