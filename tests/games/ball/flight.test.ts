import fc from 'fast-check';
import {
  add,
  addScaled,
  cross,
  distance,
  dot,
  length,
  lerp,
  normalise,
  scale,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import type { Basket, TimedLaunch } from '../../../src/games/ball/ball-state';
import { basketDepth, basketRadius } from '../../../src/games/ball/basket';
import { firstBasketContact } from '../../../src/games/ball/basket-collision';
import { ballInAir, ballOnFloor, ballRadius, floorBounceOf, floorContactTime } from '../../../src/games/ball/flight';
import { gravity, positionAt, velocityAt } from '../../../src/games/ballistics';
import { direction, evenly, seed, vector } from '../../threepoint/core/arbitraries';

const still = (position: Vec3, normal = vec3(0, 1, 0), seconds = 5): [Basket, Basket] => [
  { at: 0, position, normal },
  { at: seconds, position, normal },
];

const falling = (position: Vec3, velocity = vec3(0, 0, 0)): TimedLaunch => ({ time: 0, position, velocity });

const energyOf = ({ position, velocity }: TimedLaunch): number => 0.5 * dot(velocity, velocity) + gravity * position.y;

describe('a basket that stands still', () => {
  const [from, to] = still(vec3(0, 1, 0));

  test('catches what falls into its opening, when it goes through', () => {
    const meeting = firstBasketContact(falling(vec3(0.1, 2, 0.05)), from, to);
    expect(meeting?.kind).toBe('caught');
    expect(meeting?.kind === 'caught' && meeting.time).toBeCloseTo(Math.sqrt(2 / gravity), 3);
  });

  test('does not see what falls past it', () => {
    expect(firstBasketContact(falling(vec3(basketRadius + ballRadius + 0.01, 2, 0)), from, to)).toBeNull();
  });

  test('throws off its rim what hits it from outside: upward and away, with less speed', () => {
    const launch = falling(vec3(basketRadius + 0.03, 2, 0));
    const meeting = firstBasketContact(launch, from, to);
    if (meeting?.kind !== 'bounced') throw new Error('no bounce');
    expect(meeting.launch.velocity.y).toBeGreaterThan(0);
    expect(meeting.launch.velocity.x).toBeGreaterThan(0);
    expect(energyOf(meeting.launch)).toBeLessThan(energyOf(launch));
    expect(distance(meeting.launch.position, vec3(basketRadius, 1, 0))).toBeCloseTo(ballRadius, 2);
  });

  test('throws off its wall what comes from the side', () => {
    const meeting = firstBasketContact(falling(vec3(2, 0.95, 0), vec3(-15, 0, 0)), from, to);
    if (meeting?.kind !== 'bounced') throw new Error('no bounce');
    expect(meeting.launch.velocity.x).toBeGreaterThan(0);
    expect(meeting.launch.position.x).toBeCloseTo(basketRadius + ballRadius, 2);
  });

  test('cannot be filled from below', () => {
    const meeting = firstBasketContact(falling(vec3(0, 0.2, 0), vec3(0, 12, 0)), from, to);
    if (meeting?.kind !== 'bounced') throw new Error('no bounce');
    expect(meeting.launch.position.y).toBeCloseTo(1 - basketDepth - ballRadius, 2);
    expect(meeting.launch.velocity.y).toBeLessThan(0);
  });

  test('catches nothing upside down', () => {
    expect(firstBasketContact(falling(vec3(0, 2, 0)), ...still(vec3(0, 1, 0), vec3(0, -1, 0)))?.kind).toBe('bounced');
  });

  test('catches a flat throw when it looks at the thrower', () => {
    const launch = falling(vec3(0, 1.1, 5), vec3(0, 1.2, -18));
    expect(firstBasketContact(launch, ...still(vec3(0, 1, 0), vec3(0, 0, 1)))?.kind).toBe('caught');
  });
});

describe('a basket that moves', () => {
  /** Through a place inside the opening at some moment, going in as seen from the basket. */
  const through = fc
    .record({
      normal: direction.filter(({ y }) => y > 0.2),
      place: fc.tuple(evenly(0, 0.95), evenly(-Math.PI, Math.PI)),
      basketVelocity: vector(4),
      into: evenly(0.5, 15),
      sideways: vector(3),
      before: evenly(0.001, 1 / 30),
      after: evenly(0.001, 1 / 30),
    })
    .map(({ normal, place: [share, angle], basketVelocity, into, sideways, before, after }) => {
      const u = normalise(cross(normal, Math.abs(normal.x) < 0.8 ? vec3(1, 0, 0) : vec3(0, 0, 1)));
      const v = cross(normal, u);
      const r = share * basketRadius;
      const opening = vec3(0, 1.5, 0);
      const ball = add(opening, add(scale(u, r * Math.cos(angle)), scale(v, r * Math.sin(angle))));
      const along = addScaled(sideways, normal, -dot(sideways, normal));
      const velocity = add(basketVelocity, addScaled(along, normal, -into));
      const moved = (seconds: number): Basket => ({
        at: 1 + seconds,
        position: addScaled(opening, basketVelocity, seconds),
        normal,
      });
      // Back in time to the launch, 40 ms before.
      const launch: TimedLaunch = {
        time: 0.96,
        position: positionAt({ position: ball, velocity }, -0.04),
        velocity: velocityAt({ position: ball, velocity }, -0.04),
      };
      return { launch, from: moved(-before), to: moved(after) };
    });

  test('never lets a ball through: it is caught, or has touched the basket before', () => {
    let caught = 0;
    fc.assert(
      fc.property(through, ({ launch, from, to }) => {
        const meeting = firstBasketContact(launch, from, to);
        expect(meeting).not.toBeNull();
        if (meeting?.kind === 'caught') {
          caught += 1;
          expect(meeting.time).toBeGreaterThanOrEqual(from.at);
          expect(meeting.time).toBeLessThanOrEqual(1 + 1e-3);
        }
      }),
      { seed, numRuns: 3000 },
    );
    expect(caught).toBeGreaterThan(2000);
  });

  test('agrees with looking every 20 microseconds', { tags: ['full'] }, () => {
    const scene = fc.record({
      start: vector(0.6).map((v) => add(v, vec3(0, 1.9, 0))),
      noise: vector(3),
      seconds: evenly(0.02, 0.06),
      opening: vector(0.25).map((v) => add(v, vec3(0, 1.5, 0))),
      moved: vector(0.15),
      normal: direction.filter(({ y }) => y > 0),
      turned: vector(0.3),
    });
    let agreed = 0;
    let met = 0;
    let runs = 0;
    fc.assert(
      fc.property(scene, ({ start, noise, seconds, opening, moved, normal, turned }) => {
        const velocity = add(noise, scale(subtract(opening, start), 1 / seconds));
        const launch: TimedLaunch = { time: 0, position: start, velocity };
        const from: Basket = { at: 0, position: opening, normal };
        const to: Basket = { at: 1 / 20, position: add(opening, moved), normal: normalise(add(normal, turned)) };
        const looked = lookOften(launch, from, to, 2e-5);
        if (looked === 'inside') return;
        runs += 1;
        const found = firstBasketContact(launch, from, to)?.kind ?? null;
        if (found) met += 1;
        if (found === looked) agreed += 1;
      }),
      { seed, numRuns: 2000 },
    );
    expect(met).toBeGreaterThan(runs / 10);
    // What grazes by a tenth of a millimetre may go either way.
    expect(agreed / runs).toBeGreaterThan(0.995);
  });

  /** Finds the catch by brute force. */
  function lookOften(launch: TimedLaunch, from: Basket, to: Basket, every: number): string | null {
    let above: number | null = null;
    for (let time = from.at; time <= to.at; time += every) {
      const share = (time - from.at) / (to.at - from.at);
      const position = lerp(from.position, to.position, share);
      const normal = normalise(lerp(from.normal, to.normal, share));
      const ball = ballInAir(launch, time);
      const offset = subtract(ball, position);
      const height = dot(offset, normal);
      const radial = length(addScaled(offset, normal, -height));
      const overOpening = radial <= basketRadius && height > 0;
      if (above !== null && above > 0 && height <= 0 && radial <= basketRadius) return 'caught';
      const aside = Math.max(radial - basketRadius, 0);
      const over = Math.max(height, -basketDepth - height, 0);
      if (!overOpening && Math.hypot(aside, over) < ballRadius) return above === null ? 'inside' : 'bounced';
      above = overOpening ? height : 0;
    }
    return null;
  }

  test('catches a ball when it comes up under it', () => {
    const launch = falling(vec3(0, 1.3, 0));
    const from: Basket = { at: 0, position: vec3(0, 1.2, 0), normal: vec3(0, 1, 0) };
    const to: Basket = { at: 1 / 30, position: vec3(0, 1.4, 0), normal: vec3(0, 1, 0) };
    expect(firstBasketContact(launch, from, to)?.kind).toBe('caught');
  });

  test('passes its speed on to a ball that its wall hits', () => {
    const launch = falling(vec3(0.4, 1.4, 0));
    const from: Basket = { at: 0, position: vec3(0, 1.5, 0), normal: vec3(0, 1, 0) };
    const to: Basket = { at: 1 / 30, position: vec3(0.2, 1.5, 0), normal: vec3(0, 1, 0) };
    const meeting = firstBasketContact(launch, from, to);
    if (meeting?.kind !== 'bounced') throw new Error('no bounce');
    expect(meeting.launch.velocity.x).toBeGreaterThan(6);
  });
});

describe('the floor', () => {
  test('is touched by the skin of the ball, not by its middle', () => {
    fc.assert(
      fc.property(vector(8), evenly(0.2, 2), (velocity, height) => {
        const launch: TimedLaunch = { time: 3, position: vec3(1, height, 2), velocity };
        expect(ballInAir(launch, floorContactTime(launch)).y).toBeCloseTo(ballRadius, 9);
      }),
      { seed },
    );
  });

  test('takes speed with every bounce, until the ball rolls and comes to rest', () => {
    let launch: TimedLaunch = { time: 0, position: vec3(0, 2, 0), velocity: vec3(1, 3, -4) };
    let rolls = false;
    let bounces = 0;
    while (!rolls) {
      const next = floorBounceOf(launch, floorContactTime(launch));
      expect(energyOf(next.launch)).toBeLessThan(energyOf(launch));
      expect(next.launch.time).toBeGreaterThan(launch.time);
      ({ launch, rolls } = next);
      bounces += 1;
      expect(bounces).toBeLessThan(20);
    }
    expect(bounces).toBeGreaterThan(2);
    const end = ballOnFloor(launch, launch.time + 60);
    expect(end.y).toBeCloseTo(ballRadius, 9);
    expect(distance(end, ballOnFloor(launch, launch.time + 120))).toBeLessThan(1e-9);
    expect(distance(end, launch.position)).toBeLessThan(6);
  });
});
