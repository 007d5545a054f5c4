import { describe, expect, test } from 'vitest';
import { holderStation, rotationForRound } from '../../../src/games/ball/stations';

describe('another round', () => {
  test('needs a thrower and the holder, who stay where roles do not move on', () => {
    expect(rotationForRound([0, holderStation], false)).toBe(0);
    expect(rotationForRound([0, 1], false)).toBeNull();
  });

  test('gives three players the next role each', () => {
    expect(rotationForRound([0, 1, holderStation], true)).toBe(1);
  });

  test('gives two players the first move that makes one of them hold the basket', () => {
    expect(rotationForRound([0, 1], true)).toBe(1);
    expect(rotationForRound([0, holderStation], true)).toBe(2);
    expect(rotationForRound([1, holderStation], true)).toBe(1);
  });

  test('is none for one player', () => {
    expect(rotationForRound([holderStation], true)).toBeNull();
    expect(rotationForRound([], true)).toBeNull();
  });
});
