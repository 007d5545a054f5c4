import fc from 'fast-check';
import { addScaled, distance, dot, length, normalise, scale, subtract, vec3 } from 'threepoint/math';
import { type Launch, positionAt, velocityAt } from 'threepoint-games';
import { arrowLength, maximumDraw, type Target, walls } from 'threepoint-games/archery';
import { describe, expect, test } from 'vitest';
import { arrowMass, arrowSpeed, efficiency, minimumDraw, stiffness } from '../../../src/games/archery/bow';
import { firstHit, releaseDirection, timeToGround, timeToTarget, timeToWall } from '../../../src/games/archery/flight';
import { gravity, launchDirection } from '../../../src/games/ballistics';
import { direction, evenly, seed } from '../../threepoint/core/arbitraries';

const launch: fc.Arbitrary<Launch> = fc
  .record({
    position: fc.record({ x: evenly(-2, 2), y: evenly(0.2, 2.2), z: evenly(-1, 1) }),
    way: direction,
    speed: evenly(8, 55),
  })
  .map(({ position, way, speed }) => ({ position, velocity: scale(way, speed) }));

/** A disc somewhere ahead that faces the archer more or less. */
const disc: fc.Arbitrary<Target> = fc
  .record({
    centre: fc.record({ x: evenly(-4, 4), y: evenly(0.4, 2.5), z: evenly(-12, -2) }),
    turn: fc.record({ x: evenly(-0.5, 0.5), y: evenly(-0.5, 0.5), z: fc.constant(1) }),
    radius: evenly(0.1, 0.6),
  })
  .map(({ centre, turn, radius }) => ({ centre, normal: normalise(turn), radius, distance: 0, points: 5 }));

const upright = (z: number, radius = 0.5): Target => ({
  centre: vec3(0, 1.5, z),
  normal: vec3(0, 0, 1),
  radius,
  distance: -z,
  points: 5,
});

describe('a flight', () => {
  test('is a parabola: 30 m/s level from 1.5 m is 16.59 m long and 0.553 s', () => {
    const level: Launch = { position: vec3(0, 1.5, 0), velocity: vec3(0, 0, -30) };
    const after = timeToGround(level);
    expect(after).toBeCloseTo(Math.sqrt((2 * 1.5) / gravity), 12);
    expect(positionAt(level, after).z).toBeCloseTo(-30 * Math.sqrt(3 / gravity), 10);
    expect(positionAt(level, after).y).toBeCloseTo(0, 12);
    expect(velocityAt(level, after)).toEqual(vec3(0, -gravity * after, -30));
  });

  test('keeps its energy', () => {
    fc.assert(
      fc.property(launch, evenly(0, 3), (shot, time) => {
        const energy = (at: number) => 0.5 * length(velocityAt(shot, at)) ** 2 + gravity * positionAt(shot, at).y;
        expect(energy(time)).toBeCloseTo(energy(0), 8);
      }),
      { seed },
    );
  });

  test('ends at the same place however often it is cut and begun again', () => {
    fc.assert(
      fc.property(
        launch,
        fc.array(disc, { maxLength: 4 }),
        fc.constantFrom(72, 80, 90, 120, 7),
        (shot, discs, rate) => {
          const whole = firstHit(shot, discs, walls);
          const end = positionAt(shot, whole.after);
          let cut = shot;
          let steps = 0;
          // Frame by frame: a frame in which nothing is hit only moves the arrow on.
          for (; steps < 12 * rate; steps++) {
            const hit = firstHit(cut, discs, walls);
            if (hit.after < 1 / rate) {
              expect(hit.on).toBe(whole.on);
              expect(hit.target).toBe(whole.target);
              expect(distance(positionAt(cut, hit.after), end)).toBeLessThan(1e-3);
              expect(steps / rate + hit.after).toBeCloseTo(whole.after, 6);
              return;
            }
            cut = { position: positionAt(cut, 1 / rate), velocity: velocityAt(cut, 1 / rate) };
          }
          expect.unreachable('the arrow never came down');
        },
      ),
      { seed },
    );
  });
});

describe('a target', () => {
  test('is hit where the parabola crosses its plane', () => {
    const shot: Launch = { position: vec3(0, 1.6, 0), velocity: vec3(0, 0, -20) };
    // 0.785 m lower than it began after 0.4 s: 0.685 m below the centre.
    expect(positionAt(shot, 0.4).y).toBeCloseTo(1.6 - 0.5 * gravity * 0.16, 12);
    expect(timeToTarget(shot, upright(-8, 0.68))).toBeNull();
    expect(timeToTarget(shot, upright(-8, 0.69))).toBeCloseTo(0.4, 12);
  });

  test('stops nothing that comes from behind or flies away', () => {
    const fromBehind: Launch = { position: vec3(0, 1.5, -10), velocity: vec3(0, 1, 20) };
    expect(timeToTarget(fromBehind, upright(-8))).toBeNull();
    expect(timeToTarget({ position: vec3(0, 1.5, 0), velocity: vec3(0, 0, 20) }, upright(-8))).toBeNull();
    expect(timeToTarget({ position: vec3(0, 1.5, -8.2), velocity: vec3(0, 0, -20) }, upright(-8))).toBeNull();
  });

  test('is never tunnelled: stepping finely finds the same crossing', () => {
    let hits = 0;
    fc.assert(
      fc.property(
        launch,
        disc,
        // Two of three shots are aimed at the disc, or hardly any would hit.
        fc.constantFrom(true, true, false),
        fc.record({ x: evenly(-0.4, 0.4), y: evenly(-0.4, 0.4), z: fc.constant(0) }),
        (any, target, aimed, miss) => {
          const aim = launchDirection(addScaled(target.centre, miss, 1), any.position, length(any.velocity));
          const shot = aimed && aim ? { ...any, velocity: scale(aim, length(any.velocity)) } : any;
          const found = timeToTarget(shot, target);
          const side = (time: number) => dot(target.normal, subtract(positionAt(shot, time), target.centre));
          const step = 0.0005;
          let marched: number | null = null;
          for (let time = 0; time < 2 && marched === null; time += step) {
            const off = distance(positionAt(shot, time), target.centre);
            if (side(time) >= 0 && side(time + step) < 0 && off < target.radius - 0.03) marched = time;
          }
          if (marched !== null) {
            hits += 1;
            expect(found).not.toBeNull();
            expect(found!).toBeGreaterThanOrEqual(marched - 1e-9);
            expect(found!).toBeLessThanOrEqual(marched + step + 1e-9);
          }
          if (found !== null) {
            expect(Math.abs(side(found))).toBeLessThan(1e-6);
            expect(distance(positionAt(shot, found), target.centre)).toBeLessThanOrEqual(target.radius + 1e-9);
            expect(dot(target.normal, velocityAt(shot, found))).toBeLessThan(0);
          }
        },
      ),
      { seed, numRuns: 300 },
    );
    expect(hits).toBeGreaterThan(20);
  });

  test('a lofted arrow comes down on a disc that lies flat', () => {
    const flat: Target = { ...upright(-5), centre: vec3(0, 1, -5), normal: vec3(0, 1, 0) };
    const time = timeToTarget({ position: vec3(0, 1.5, 0), velocity: vec3(0, 10, -2.4) }, flat);
    expect(time).toBeCloseTo((10 + Math.sqrt(100 + 2 * gravity * 0.5)) / gravity, 10);
  });

  test('the nearer of two in a line is hit', () => {
    const shot: Launch = { position: vec3(0, 1.6, 0), velocity: vec3(0, 0, -50) };
    expect(firstHit(shot, [upright(-9), upright(-5), upright(-7)], walls)).toMatchObject({ on: 'target', target: 1 });
  });
});

describe('ground and nets', () => {
  test('the net behind the range stops what misses, at 14 m', () => {
    const shot: Launch = { position: vec3(0, 1.6, 0), velocity: vec3(0, 2, -50) };
    const hit = firstHit(shot, [], walls);
    expect(hit.on).toBe('wall');
    expect(positionAt(shot, hit.after).z).toBeCloseTo(-14, 9);
  });

  test('over a net an arrow flies on and comes down on the ground', () => {
    const shot: Launch = { position: vec3(0, 1.6, 0), velocity: vec3(0, 25, -25) };
    const hit = firstHit(shot, [], walls);
    expect(hit.on).toBe('ground');
    expect(positionAt(shot, hit.after).z).toBeLessThan(-100);
  });

  test('a net stops nothing that comes back from outside', () => {
    expect(timeToWall({ position: vec3(0, 1, -15), velocity: vec3(0, 0, 9) }, walls[0]!)).toBeNull();
    expect(timeToWall({ position: vec3(0, 1, -15), velocity: vec3(0, 0, -9) }, walls[0]!)).toBeNull();
  });

  test('a tip in the ground at the release stays there', () => {
    expect(firstHit({ position: vec3(0, -0.1, -0.5), velocity: vec3(0, -20, -20) }, [], walls).after).toBe(0);
  });

  test('every flight ends', () => {
    fc.assert(
      fc.property(launch, (shot) => {
        const hit = firstHit(shot, [], walls);
        expect(hit.after).toBeGreaterThanOrEqual(0);
        expect(hit.after).toBeLessThan(12);
        expect(positionAt(shot, hit.after).y).toBeGreaterThan(-1e-9);
      }),
      { seed },
    );
  });
});

describe('the bow', () => {
  test('gives 72 % of the energy of its spring to the arrow', () => {
    for (const draw of [0.2, 0.45, maximumDraw]) {
      expect(0.5 * arrowMass * arrowSpeed(draw) ** 2).toBeCloseTo(efficiency * 0.5 * stiffness * draw ** 2, 12);
    }
    expect(arrowSpeed(0.5)).toBeCloseTo(37.9, 1);
  });

  test('draws no further than its maximum and pushes nothing', () => {
    expect(arrowSpeed(5)).toBe(arrowSpeed(maximumDraw));
    expect(arrowSpeed(-1)).toBe(0);
  });
});

describe('aiming', () => {
  const within = { x: evenly(-4, 4), y: evenly(0.4, 2), z: evenly(-11, -4) };

  test('a tip launched towards a target flies through it, by the flatter way', () => {
    fc.assert(
      fc.property(fc.record(within), evenly(15, 55), (target, speed) => {
        const from = vec3(0.1, 1.4, -0.6);
        const way = launchDirection(target, from, speed)!;
        expect(length(way)).toBeCloseTo(1, 12);
        const shot: Launch = { position: from, velocity: scale(way, speed) };
        const time = Math.hypot(target.x - from.x, target.z - from.z) / (speed * Math.hypot(way.x, way.z));
        expect(distance(positionAt(shot, time), target)).toBeLessThan(1e-9);
        expect(way.y).toBeLessThan(Math.SQRT1_2 + 0.2);
      }),
      { seed },
    );
  });

  test('an arrow released towards a target hits its middle from any draw that reaches', () => {
    fc.assert(
      fc.property(fc.record(within), evenly(0.25, maximumDraw), evenly(0.5, 1.9), (target, draw, height) => {
        const nock = vec3(0.1, height, 0.1);
        const way = releaseDirection(target, nock, draw)!;
        const shot = { position: addScaled(nock, way, arrowLength), velocity: scale(way, arrowSpeed(draw)) };
        expect(distance(shot.position, nock)).toBeCloseTo(arrowLength, 9);
        const time =
          Math.hypot(target.x - shot.position.x, target.z - shot.position.z) /
          Math.hypot(shot.velocity.x, shot.velocity.z);
        expect(distance(positionAt(shot, time), target)).toBeLessThan(1e-6);
      }),
      { seed },
    );
  });

  test('says so when the target is out of reach', () => {
    expect(releaseDirection(vec3(0, 1.5, -40), vec3(0, 1.5, 0), minimumDraw)).toBeNull();
    expect(launchDirection(vec3(0, 30, 0), vec3(0, 0, 0), 10)).toBeNull();
    expect(launchDirection(vec3(0, 3, 0), vec3(0, 0, 0), 10)).toEqual(vec3(0, 1, 0));
  });
});
