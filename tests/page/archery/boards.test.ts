import { Color } from 'three';
import { vec3 } from 'threepoint/math';
import { type ArcheryState, type Arrow, archeryRules, type Landing } from 'threepoint-games/archery';
import { describe, expect, it } from 'vitest';
import { arrowResult, onRestartButton } from '../../../src/page/archery/boards/result-panel';
import { boardText } from '../../../src/page/archery/boards/scoreboard';
import { ringColor, rings } from '../../../src/page/archery/range/target-rings';
import { scoredBy } from '../../../src/page/archery/range/target-stands';

const shot = (id: number, landing: Partial<Landing> | null): Arrow => ({
  id,
  release: { time: 2 * id, position: vec3(0, 1.5, -0.8), velocity: vec3(0, 0, -30) },
  landing: landing && {
    time: 2 * id + 0.3,
    position: vec3(0, 1.4, -6),
    direction: vec3(0, 0, -1),
    on: 'ground',
    target: null,
    points: 0,
    ...landing,
  },
});

const ready = archeryRules.start([], 7);
const withArrows = (arrows: readonly Arrow[], more: Partial<ArcheryState> = {}): ArcheryState => ({
  ...ready,
  phase: 'running',
  arrows,
  arrowsLeft: ready.options.arrows - arrows.length,
  score: arrows.reduce((sum, { landing }) => sum + (landing?.points ?? 0), 0),
  ...more,
});

describe('the scoreboard', () => {
  it('says that every arrow can win the best target where every hit counts', () => {
    const every = archeryRules.start([], 7, { everyHitCounts: true });
    expect(boardText(every, 0).maximum).toBe(100);
  });

  it('says that the highest score is 50 and that the clock stands before the first arrow', () => {
    expect(boardText(ready, 30)).toMatchObject({ score: 0, maximum: 50, arrowsLeft: 5, seconds: 70 });
  });

  it('says what the clock waits for: the first arrow, or in a study the start', () => {
    expect(boardText(ready, 0).line).toBe('First arrow starts the clock');
    expect(boardText(archeryRules.start([], 7, { startedBy: 'signal' }), 0).line).toBe('Wait for the start');
  });

  it('counts whole seconds down and shows 0 only at the bell', () => {
    expect(boardText(withArrows([]), 0.01).seconds).toBe(70);
    expect(boardText(withArrows([]), 69.9).seconds).toBe(1);
    expect(boardText(withArrows([], { phase: 'over', end: 'time' }), 70.02).seconds).toBe(0);
  });

  it('tells what the last arrow did', () => {
    const hit = shot(0, { on: 'target', target: 2, points: 15 });
    expect(boardText(withArrows([hit]), 1).line).toBe('Target at 8.5 m: +15');
    expect(boardText(withArrows([hit, shot(1, { on: 'target', target: 2 })]), 4).line).toBe('Target at 8.5 m: again');
    expect(boardText(withArrows([hit, shot(1, {})]), 4).line).toBe('Into the grass');
    expect(boardText(withArrows([hit, shot(1, { on: 'wall' })]), 4).line).toBe('Into the net');
    expect(boardText(withArrows([hit, shot(1, null)]), 4).line).toBe('Target at 8.5 m: +15');
  });

  it('asks an archer who left the deck to come back before it says anything else', () => {
    expect(boardText({ ...ready, inZone: false }, 0).line).toMatch(/back/);
  });

  it('gives each arrow its own result', () => {
    const state = withArrows([
      shot(0, { on: 'target', target: 1, points: 10 }),
      shot(1, { on: 'target', target: 1 }),
      shot(2, {}),
      shot(3, { on: 'wall' }),
    ]);
    expect([0, 1, 2, 3, 4].map((index) => arrowResult(state, index))).toEqual([
      '+10',
      'hit before',
      'grass',
      'net',
      'not shot',
    ]);
  });
});

describe('a target stand', () => {
  it('is lit by its own points alone, from the moment they are scored', () => {
    const state = withArrows([
      shot(0, { on: 'target', target: 1, points: 10 }),
      shot(1, { on: 'target', target: 1, points: 10 }),
    ]);
    expect(scoredBy(state, 1, 0.2).points).toBe(0);
    expect(scoredBy(state, 1, 1).points).toBe(10);
    expect(scoredBy(state, 1, 5).points).toBe(20);
    expect(scoredBy(state, 0, 5).points).toBe(0);
  });
});

describe('the rings of a target', () => {
  /** Relative luminance, as WCAG has it: three's colours are linear. */
  const luminance = (color: string) => {
    const { r, g, b } = new Color(color);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };

  it('differ in brightness from neighbours at least three to one, for all kinds of colour vision', () => {
    for (let i = 1; i < rings.length; i++) {
      const [a, b] = [luminance(rings[i - 1]?.color ?? ''), luminance(rings[i]?.color ?? '')];
      expect((Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)).toBeGreaterThan(3);
    }
  });

  it('lie inside one another from the rim to the middle', () => {
    expect(ringColor(0.9)).toBe(rings[0].color);
    expect(ringColor(0.7)).toBe(rings[1].color);
    expect(ringColor(0.5)).toBe(rings[2].color);
    expect(ringColor(0.3)).toBe(rings[3].color);
    expect(ringColor(0.1)).toBe(rings[4].color);
  });
});

describe('the restart button', () => {
  it('lies in the lower middle of the panel and nowhere else', () => {
    expect(onRestartButton(0, -0.36)).toBe(true);
    expect(onRestartButton(0, 0)).toBe(false);
    expect(onRestartButton(0.4, -0.36)).toBe(false);
    expect(onRestartButton(0, -0.55)).toBe(false);
  });
});
