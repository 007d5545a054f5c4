import fc from 'fast-check';
import { dot, length, normalise, scale, subtract, vec3 } from 'threepoint/math';
import { type ArcheryAction, delayed, matchTime, secondsLeft, walls, zone } from 'threepoint-games/archery';
import { describe, expect, test } from 'vitest';
import { arrowSpeed } from '../../../src/games/archery/bow';
import { firstHit } from '../../../src/games/archery/flight';
import { evenly, seed } from '../../threepoint/core/arbitraries';
import { highShot, shotAt, start, tickSeconds, told, wideOf } from './shots';

describe('the range', () => {
  test('has four targets at 4.5, 6.5, 8.5 and 10.5 m worth 5, 10, 15 and 20', () => {
    const { targets } = start();
    expect(targets.map(({ points }) => points)).toEqual([5, 10, 15, 20]);
    expect(targets.map((target) => target.distance)).toEqual([4.5, 6.5, 8.5, 10.5]);
    for (const { centre, distance: far, normal } of targets) {
      expect(Math.hypot(centre.x, centre.z)).toBeCloseTo(far, 9);
      expect(length(normal)).toBeCloseTo(1, 12);
    }
  });

  test('faces the archer, at heights that an archer looks at without effort', () => {
    const { targets } = start({ eyeHeight: 1.6 });
    for (const { centre, normal } of targets) {
      expect(dot(normal, normalise(subtract(vec3(0, 1.6, 0), centre)))).toBeCloseTo(1, 9);
      expect(centre.y).toBeGreaterThan(1.1);
      expect(centre.y).toBeLessThan(1.65);
    }
  });

  test('shows the same picture to seated eyes', () => {
    fc.assert(
      fc.property(fc.integer(), evenly(1, 2.2), evenly(1, 2.2), (matchSeed, a, b) => {
        const elevations = (eyeHeight: number) =>
          start({ eyeHeight }, matchSeed).targets.map(({ centre, distance: far }) => (centre.y - eyeHeight) / far);
        elevations(a).forEach((elevation, i) => {
          expect(elevation).toBeCloseTo(elevations(b)[i]!, 9);
        });
      }),
      { seed },
    );
  });

  test('keeps its targets off the ground even for eyes near the floor', () => {
    for (const { centre, radius } of start({ eyeHeight: 0.2 }).targets) expect(centre.y - radius).toBeGreaterThan(0.05);
  });

  test('hides no target behind another, wherever in the zone the eyes are', () => {
    fc.assert(
      fc.property(
        fc.integer(),
        evenly(-zone.width / 2, zone.width / 2),
        evenly(-zone.depth / 2, zone.depth / 2),
        evenly(1, 2),
        evenly(0.7, 1.1),
        (matchSeed, x, z, eyeHeight, stoop) => {
          const eyes = vec3(x, eyeHeight * stoop, z);
          const seen = start({ eyeHeight }, matchSeed).targets.map(({ centre, radius }) => {
            const to = subtract(centre, eyes);
            return { way: normalise(to), half: Math.asin(radius / length(to)) };
          });
          for (const [i, a] of seen.entries()) {
            for (const b of seen.slice(i + 1)) {
              expect(Math.acos(dot(a.way, b.way))).toBeGreaterThan(a.half + b.half);
            }
          }
        },
      ),
      { seed },
    );
  });

  test('differs a little from seed to seed, never for the same seed', () => {
    expect(start({}, 3)).toEqual(start({}, 3));
    expect(start({}, 3).targets).not.toEqual(start({}, 4).targets);
    const sides = new Set(Array.from({ length: 20 }, (_, i) => Math.sign(start({}, i).targets[0]!.centre.x)));
    expect(sides.size).toBe(2);
  });

  test.each([
    [{ arrows: 0 }, /arrows/],
    [{ arrows: 2.5 }, /arrows/],
    [{ seconds: 0 }, /seconds/],
    [{ seconds: Number.NaN }, /seconds/],
    [{ eyeHeight: Number.NaN }, /eyeHeight/],
  ])('refuses %o loudly at the start', (options, message) => {
    expect(() => start(options)).toThrow(message);
  });
});

describe('the score', () => {
  test.each([0, 1, 2, 3])('target %d scores its points', (target) => {
    const match = told(start());
    match.shoot(target);
    expect(match.state.score).toBe([5, 10, 15, 20][target]);
    expect(match.happened('landed')[0]!.landing).toMatchObject({ on: 'target', target, points: match.state.score });
  });

  test('each target counts once: all four are 50, and end the round', () => {
    const match = told(start());
    for (const target of [3, 1, 0, 2]) match.shoot(target);
    expect(match.state).toMatchObject({ score: 50, phase: 'over', end: 'targets', arrowsLeft: 1 });
    expect(match.happened('ended')).toEqual([{ type: 'ended', end: 'targets', score: 50 }]);
  });

  test('a second hit sticks and scores nothing', () => {
    const match = told(start());
    match.shoot(3);
    match.shoot(3);
    expect(match.state.score).toBe(20);
    expect(match.state.arrows[1]!.landing).toMatchObject({ on: 'target', target: 3, points: 0 });
  });

  test('with every hit counting, a target scores again, and only arrows end the round', () => {
    const match = told(start({ everyHitCounts: true }));
    for (const target of [0, 1, 2, 3, 3]) match.shoot(target);
    expect(match.state).toMatchObject({ score: 70, phase: 'over', end: 'arrows' });
  });

  test('the first of two arrows to land in one tick comes first, whichever was shot first', () => {
    const match = told(start());
    match.step(highShot(match.state));
    const [high] = match.state.arrows;
    const down = high!.release.time + firstHit(high!.release, match.state.targets, walls).after;
    const flat = shotAt(match.state, 0) as Extract<ArcheryAction, { type: 'release' }>;
    const { after } = firstHit(
      { position: flat.position, velocity: scale(flat.direction, arrowSpeed(0.5)) },
      match.state.targets,
      walls,
    );
    // Into the tick in which the other one lands, but before it.
    const tick = Math.floor(down / tickSeconds);
    const released = (tick * tickSeconds + down) / 2 - after;
    const releaseTick = Math.floor(released / tickSeconds);
    while (match.state.tick < releaseTick) match.step();
    match.step(delayed(flat, released - releaseTick * tickSeconds));
    while (match.state.tick < tick) match.step();
    expect(match.happened('landed')).toEqual([]);
    match.step();
    expect(match.happened('landed').map(({ arrow }) => arrow.id)).toEqual([1, 0]);
  });

  test('an arrow at the edge hits, one just beyond flies on', () => {
    const edge = told(start());
    edge.step(shotAt(edge.state, 2, vec3(0.44, 0, 0)));
    edge.pass(1);
    expect(edge.state.score).toBe(15);
    const beyond = told(start());
    beyond.step(shotAt(beyond.state, 2, vec3(0.48, 0, 0)));
    beyond.pass(2);
    expect(beyond.state.score).toBe(0);
    expect(beyond.happened('landed')[0]!.landing.on).not.toBe('target');
  });
});

describe('the end of a round', () => {
  test('comes when the last arrow has landed, not when it is shot', () => {
    const match = told(start({ arrows: 2 }));
    match.step(wideOf(match.state));
    match.pass(1);
    match.step(wideOf(match.state));
    expect(match.state).toMatchObject({ arrowsLeft: 0, phase: 'running' });
    match.pass(2);
    expect(match.state).toMatchObject({ phase: 'over', end: 'arrows', score: 0 });
    const kinds = match.events.map(({ type }) => type);
    expect(kinds).toEqual(['started', 'released', 'landed', 'released', 'landed', 'ended']);
  });

  test('comes with the bell after 70 s', () => {
    const match = told(start());
    match.step({ type: 'start' });
    match.pass(69.95);
    expect(match.state.phase).toBe('running');
    expect(secondsLeft(match.state)).toBeLessThan(0.05);
    match.pass(0.05);
    expect(match.state).toMatchObject({ phase: 'over', end: 'time', score: 0 });
    expect(secondsLeft(match.state)).toBe(0);
    expect(matchTime(match.state)).toBeCloseTo(70, 1);
  });

  test('waits for an arrow in flight at the bell, which counts', () => {
    const match = told(start({ seconds: 10 }));
    match.step({ type: 'start' });
    match.pass(10 - 5 * tickSeconds);
    match.step(shotAt(match.state, 3));
    match.pass(6 * tickSeconds);
    expect(match.state).toMatchObject({ phase: 'running', score: 0 });
    expect(secondsLeft(match.state)).toBe(0);
    match.pass(1);
    expect(match.state).toMatchObject({ phase: 'over', end: 'time', score: 20 });
  });

  test('is the last moment to shoot, even while an arrow flies', () => {
    const match = told(start({ seconds: 10 }));
    match.step({ type: 'start' });
    match.pass(9.5);
    match.step(highShot(match.state));
    match.pass(1);
    expect(match.state.phase).toBe('running');
    match.step(shotAt(match.state, 0));
    expect(match.state.arrowsLeft).toBe(4);
    match.pass(10);
    expect(match.state).toMatchObject({ phase: 'over', end: 'time', score: 0 });
  });

  test('stands: nothing moves, shoots or starts any more', () => {
    const match = told(start({ arrows: 1 }));
    match.shoot(0);
    const { state } = match;
    match.step({ type: 'start' }, shotAt(state, 1));
    match.pass(2);
    expect(match.state).toEqual(state);
  });
});

describe('the clock', () => {
  test('stands until the start signal', () => {
    const match = told(start());
    match.pass(100);
    expect(match.state).toMatchObject({ phase: 'ready', tick: 0 });
    match.step({ type: 'start' });
    match.step({ type: 'start' });
    expect(match.state).toMatchObject({ phase: 'running', tick: 2 });
    expect(match.happened('started')).toHaveLength(1);
  });

  test('needs the signal where that alone starts it: no arrow flies before', () => {
    const match = told(start({ startedBy: 'signal' }));
    match.step(shotAt(match.state, 1));
    match.pass(100);
    expect(match.state).toMatchObject({ phase: 'ready', tick: 0, arrowsLeft: 5, arrows: [] });
    match.step({ type: 'start' }, shotAt(match.state, 1));
    expect(match.state).toMatchObject({ phase: 'running', arrowsLeft: 4 });
  });

  test('starts with the first release, too', () => {
    const match = told(start());
    match.pass(3);
    match.step(shotAt(match.state, 1));
    expect(match.state).toMatchObject({ phase: 'running', tick: 1, arrowsLeft: 4 });
    expect(match.state.arrows[0]!.release.time).toBe(0);
  });
});
