import { vec3 } from 'threepoint/math';
import type { Arrow, Landing } from 'threepoint-games/archery';
import { describe, expect, it } from 'vitest';
import { eventHaptics } from '../../../src/page/archery/sound/archery-haptics';

const hit = (points: number, target: number | null = 1) => {
  const landing: Landing = {
    time: 1,
    position: vec3(0, 1.4, -6),
    direction: vec3(0, 0, -1),
    on: target === null ? 'ground' : 'target',
    target,
    points,
  };
  const arrow: Arrow = {
    id: 0,
    release: { time: 0.5, position: vec3(0, 1.5, -0.8), velocity: vec3(0, 0, -30) },
    landing,
  };
  return { type: 'landed', arrow, landing } as const;
};

describe('haptics of events', () => {
  it('are stronger for a hit that scores more, in the hand with the bow alone', () => {
    const strengths = [0, 5, 10, 15, 20].map((points) => {
      const pulses = eventHaptics([hit(points)], 'right');
      expect(pulses.map(({ side }) => side)).toEqual(['right']);
      return pulses[0]?.strength ?? 0;
    });
    expect(strengths).toEqual([...strengths].sort((a, b) => a - b));
    expect(new Set(strengths).size).toBe(strengths.length);
    expect(Math.max(...strengths)).toBeLessThanOrEqual(1);
  });

  it('are none for a miss', () => {
    expect(eventHaptics([hit(0, null)], 'left')).toEqual([]);
  });

  it('warn both hands when the archer leaves the zone and when the bell rings', () => {
    const sides = (events: Parameters<typeof eventHaptics>[0]) => eventHaptics(events, 'left').map(({ side }) => side);
    expect(sides([{ type: 'left-zone' }])).toEqual(['left', 'right']);
    expect(sides([{ type: 'ended', end: 'time', score: 0 }])).toEqual(['left', 'right']);
  });
});
