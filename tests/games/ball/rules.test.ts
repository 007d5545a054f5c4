import fc from 'fast-check';
import { add, distance, length, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { armReach, fastestThrow, maxDelay } from '../../../src/games/ball/action-rules';
import type { BallInput } from '../../../src/games/ball/ball-state';
import { basketInHands, gripRadius } from '../../../src/games/ball/basket';
import { ballRadius } from '../../../src/games/ball/flight';
import { ballRules } from '../../../src/games/ball/rules';
import { ballPosition, ballSecondsLeft, ballsLeft } from '../../../src/games/ball/state-selectors';
import { rackPosition, stations, throwingDistance } from '../../../src/games/ball/stations';
import { wristAround } from '../../../src/games/fist';
import { evenly, seed, vector } from '../../threepoint/core/arbitraries';
import { headOf, hold, holder, inFront, leftThrower, rightThrower, stand, tickSeconds, told } from './playing';

test.each([0, -1, 3601, Number.NaN])('a round of %s s is refused with the bounds of one', (seconds) => {
  expect(() => ballRules.start(['Ann'], 0, { seconds })).toThrow(
    `ball game: seconds must be between 0 and 3600, is ${seconds}`,
  );
});

describe('the court', () => {
  test('has both throwers 5 m from the basket holder, who face each other', () => {
    for (const thrower of [leftThrower, rightThrower]) {
      expect(distance(stations[thrower]!.position, stations[holder]!.position)).toBeCloseTo(throwingDistance, 9);
    }
  });

  test('has every ball in the reach of its thrower and none inside another', () => {
    for (let ball = 0; ball < 20; ball++) {
      const thrower = ball < 10 ? leftThrower : rightThrower;
      const shoulder = add(stations[thrower]!.position, vec3(0, 1.4, 0));
      expect(distance(rackPosition(ball, 20), shoulder)).toBeLessThan(0.95);
      for (let other = 0; other < ball; other++) {
        expect(distance(rackPosition(ball, 20), rackPosition(other, 20))).toBeGreaterThan(2 * ballRadius);
      }
    }
  });
});

describe('a match', () => {
  test('has 20 balls and 90 s, and starts when all players are ready', () => {
    const match = told({}, false);
    expect(match.state.balls.length).toBe(20);
    match.step({ type: 'join', player: 0 }, { type: 'join', player: 1 }, { type: 'join', player: 2 });
    match.step({ type: 'ready', player: 0, ready: true }, { type: 'ready', player: 2, ready: true });
    expect(match.state.phase).toBe('ready');
    expect(ballSecondsLeft(match.state)).toBe(90);
    match.step({ type: 'ready', player: 1, ready: true });
    expect(match.state.phase).toBe('running');
    match.pass(10);
    expect(ballSecondsLeft(match.state)).toBeCloseTo(80, 1);
  });

  test('does not start without a thrower or without a holder', () => {
    for (const there of [[0, 1], [2]]) {
      const match = told({}, false);
      for (const player of there) match.step({ type: 'join', player }, { type: 'ready', player, ready: true });
      expect(match.state.phase).toBe('ready');
    }
  });

  test('lets the roles move on', () => {
    const roles = [0, 1, 2].map((rotation) =>
      ballRules.start(['a', 'b', 'c'], 1, { rotation }).players.map((p) => p.role),
    );
    expect(roles).toEqual([
      ['thrower', 'thrower', 'holder'],
      ['thrower', 'holder', 'thrower'],
      ['holder', 'thrower', 'thrower'],
    ]);
  });

  test('takes a request to rotate in every phase, each number once', () => {
    const match = told({ seconds: 1 }, false);
    match.step(...[leftThrower, holder].map((player): BallInput => ({ type: 'join', player })));
    const first = match.action(leftThrower, { type: 'rotate', rotate: true });
    match.step(first);
    expect([match.state.phase, match.state.rotate]).toEqual(['ready', true]);
    match.step(...[leftThrower, holder].map((player): BallInput => ({ type: 'ready', player, ready: true })));
    match.step(match.action(holder, { type: 'rotate', rotate: false }), first);
    expect([match.state.phase, match.state.rotate]).toEqual(['running', false]);
    expect(match.refusals()).toEqual(['seen-before']);
    match.pass(2);
    match.step(match.action(holder, { type: 'rotate', rotate: true }));
    expect([match.state.phase, match.state.rotate]).toEqual(['over', true]);
    expect(match.happened('rotate').map(({ player, rotate }) => [player, rotate])).toEqual([
      [leftThrower, true],
      [holder, false],
      [holder, true],
    ]);
  });

  test('gives a point for a ball that comes down in the basket', () => {
    const match = told();
    match.take(leftThrower, 3);
    match.toss(leftThrower, 3, inFront);
    match.pass(1.5);
    expect(match.happened('caught')).toEqual([expect.objectContaining({ ball: 3, player: leftThrower, score: 1 })]);
    expect(match.state.score).toBe(1);
    expect(ballsLeft(match.state)).toBe(19);
  });

  test('gives no point for a ball that bounces beside the basket, misses once and rolls away', () => {
    const match = told();
    match.take(rightThrower, 12);
    match.toss(rightThrower, 12, add(inFront, vec3(0.6, 0, 0)));
    match.pass(8);
    expect(match.state.score).toBe(0);
    expect(match.happened('missed')).toEqual([{ type: 'missed', ball: 12, player: rightThrower }]);
    expect(match.happened('bounced').length).toBeGreaterThan(1);
    expect(match.state.balls[12]?.on).toBe('floor');
    expect(match.state.balls[12]).not.toHaveProperty('missed');
  });

  test('gives no point for a ball that has touched the floor', () => {
    const match = told();
    match.take(leftThrower, 0);
    const floor = add(stations[holder]!.position, vec3(0, ballRadius, 1.6));
    match.toss(leftThrower, 0, floor, 0.6);
    for (let i = 0; i < 90; i++) {
      const ball = ballPosition(match.state, 0, match.now())!;
      // The basket waits where the ball comes down again.
      match.step(hold(match.now(), vec3(ball.x, Math.max(ball.y - 0.1, 0.5), ball.z)));
    }
    expect(match.happened('missed').length).toBe(1);
    expect(match.state.score).toBe(0);
  });

  test('is over with 20 points when all 20 balls are caught', () => {
    const match = told();
    for (let ball = 0; ball < 20; ball++) {
      const thrower = ball < 10 ? leftThrower : rightThrower;
      match.take(thrower, ball, ball % 2 ? 'left' : 'right');
      match.toss(thrower, ball, inFront, 0.9, ball % 2 ? 'left' : 'right');
      match.pass(1.4);
    }
    expect(match.refusals()).toEqual([]);
    expect(match.state.score).toBe(20);
    expect(match.happened('ended')).toEqual([{ type: 'ended', end: 'balls', score: 20 }]);
  });

  test('ends with the bell, counts a ball in the air, and returns held balls soon after', () => {
    const match = told({ seconds: 5 });
    match.pass(4.4);
    match.take(leftThrower, 1);
    match.take(rightThrower, 11);
    match.toss(leftThrower, 1, inFront);
    match.pass(0.6);
    expect(match.state.phase).toBe('running');
    match.take(leftThrower, 2);
    match.toss(rightThrower, 11, inFront);
    expect(match.refusals()).toEqual(['time', 'time']);
    expect(match.happened('returned')).toEqual([]);
    match.pass(maxDelay);
    expect(match.happened('returned')).toEqual([{ type: 'returned', ball: 11, player: rightThrower }]);
    match.pass(2);
    expect(match.happened('ended')).toEqual([{ type: 'ended', end: 'time', score: 1 }]);
  });

  test('counts a throw from before the bell that arrives after it', () => {
    const match = told({ seconds: 5 });
    match.pass(4.5);
    match.take(leftThrower, 1);
    match.pass(0.7);
    expect(match.now()).toBeGreaterThan(5);
    match.hurl(leftThrower, 1, { at: 4.9 });
    expect(match.refusals()).toEqual([]);
    match.pass(1);
    expect(match.happened('ended')).toEqual([{ type: 'ended', end: 'time', score: 1 }]);
  });

  test('goes on without the hands of an unseen holder: the basket stays in place', () => {
    const match = told();
    match.take(leftThrower, 5);
    match.toss(leftThrower, 5, inFront);
    for (let i = 0; i < 120; i++) match.step();
    expect(match.state.score).toBe(1);
  });

  test('takes the balls from a player who leaves, and knows their hands when they return', () => {
    const match = told();
    match.take(leftThrower, 2);
    match.step({ type: 'leave', player: leftThrower });
    expect(match.state.balls[2]).toEqual({ on: 'rack' });
    expect(match.state.players[leftThrower]?.present).toBe(false);
    match.step(match.action(leftThrower, { type: 'grab', side: 'right', ball: 2 }));
    expect(match.refusals()).toEqual(['absent']);
    match.step({ type: 'join', player: leftThrower });
    expect(match.state.phase).toBe('running');
    match.take(leftThrower, 2);
    expect(match.state.balls[2]).toEqual({ on: 'hand', player: leftThrower, side: 'right' });
  });
});

describe('a ball', () => {
  test('has one owner when two grab it in one tick, and the loser is notified', () => {
    fc.assert(
      fc.property(fc.boolean(), fc.integer({ min: 0, max: 19 }), (leftFirst, ball) => {
        const match = told();
        const place = rackPosition(ball, 20);
        const between = { ...place, y: 1.6, z: 0 };
        const near = (player: number): BallInput => ({
          ...(stand(player, match.now(), place) as Extract<BallInput, { type: 'pose' }>),
          head: vec3((between.x + stations[player]!.position.x) / 2, 1.4, -0.2),
        });
        const [first, second] = leftFirst ? [leftThrower, rightThrower] : [rightThrower, leftThrower];
        match.step(near(first), near(second));
        match.step(
          match.action(first, { type: 'grab', side: 'right', ball }),
          match.action(second, { type: 'grab', side: 'left', ball }),
        );
        expect(match.state.balls[ball]).toEqual({ on: 'hand', player: first, side: 'right' });
        expect(match.happened('refused')).toEqual([{ type: 'refused', player: second, sequence: 1, reason: 'taken' }]);
      }),
      { seed, numRuns: 60 },
    );
  });

  test('in the hand is followed by none in that hand, but by one in the other', () => {
    const match = told();
    match.take(leftThrower, 0, 'right');
    match.take(leftThrower, 1, 'right');
    match.take(leftThrower, 1, 'left');
    expect(match.refusals()).toEqual(['hand-full']);
    expect(match.state.balls[1]).toEqual({ on: 'hand', player: leftThrower, side: 'left' });
  });

  test('let go of without speed goes back to the rack', () => {
    const match = told();
    match.take(leftThrower, 4);
    match.hurl(leftThrower, 4, { velocity: vec3(0.1, 0.2, -0.3) });
    expect(match.state.balls[4]).toEqual({ on: 'rack' });
    expect(match.happened('returned').length).toBe(1);
  });
});

describe('what no body can do is refused', () => {
  const holding = () => {
    const match = told();
    match.take(leftThrower, 0);
    return match;
  };
  const thrown = (
    match: ReturnType<typeof told>,
    { ball = 0, ...change }: { position?: Vec3; velocity?: Vec3; at?: number; ball?: number },
  ) => {
    match.hurl(leftThrower, ball, change);
    return match.refusals();
  };

  test('a throw at 100 m/s, and any above 20', () => {
    expect(thrown(holding(), { velocity: vec3(0, 0, -100) })).toEqual(['speed']);
    fc.assert(
      fc.property(
        vector(1).filter((v) => length(v) > 0.01),
        evenly(1.001, 1e6),
        (v, factor) => {
          const speed = (fastestThrow * factor) / length(v);
          const velocity = vec3(v.x * speed, v.y * speed, v.z * speed);
          expect(thrown(holding(), { velocity })).toEqual(['speed']);
        },
      ),
      { seed, numRuns: 50 },
    );
  });

  test('a release 10 m from the hand, and any out of reach', () => {
    const from = headOf(leftThrower);
    expect(thrown(holding(), { position: add(from, vec3(0, 0, -10)) })).toEqual(['reach']);
    expect(thrown(holding(), { position: add(from, vec3(0, 0, -armReach - 0.01)) })).toEqual(['reach']);
    // Within the arm's reach, but far from where the hand is.
    expect(thrown(holding(), { position: add(from, vec3(0, -0.9, 0.6)) })).toEqual(['reach']);
  });

  test('anything that is not a number', () => {
    for (const bad of [Number.NaN, Number.POSITIVE_INFINITY]) {
      expect(thrown(holding(), { velocity: vec3(bad, 0, -5) })).toEqual(['speed']);
      expect(thrown(holding(), { position: vec3(0, bad, 0) })).toEqual(['speed']);
      expect(thrown(holding(), { at: bad })).toEqual(['speed']);
    }
  });

  test('another ball than the one in the hand', () => {
    expect(thrown(holding(), { ball: 7 })).toEqual(['not-held']);
  });

  test('a grab from out of reach, of a missing ball, or by the holder', () => {
    const match = told();
    match.step(stand(leftThrower, match.now(), headOf(leftThrower)));
    match.step(match.action(leftThrower, { type: 'grab', side: 'left', ball: 19 }));
    match.step(match.action(leftThrower, { type: 'grab', side: 'left', ball: 20 }));
    match.step(match.action(leftThrower, { type: 'grab', side: 'left', ball: -1 }));
    match.step(match.action(holder, { type: 'grab', side: 'left', ball: 1 }));
    expect(match.refusals()).toEqual(['reach', 'no-such-ball', 'no-such-ball', 'role']);
  });

  test('a throw from beside the basket', () => {
    const match = holding();
    const there = add(stations[holder]!.position, vec3(0, 1.6, 1));
    match.step({ type: 'pose', player: leftThrower, at: match.now(), head: there, left: null, right: null });
    match.step(
      match.action(leftThrower, {
        type: 'throw',
        side: 'right',
        ball: 0,
        at: match.now(),
        position: add(there, vec3(0, -0.3, -0.2)),
        velocity: vec3(0, 1, -1),
      }),
    );
    expect(match.refusals()).toEqual(['zone']);
  });

  test('a basket faster than hands go, or from out of the holder’s zone', () => {
    const match = told();
    match.take(leftThrower, 0);
    match.toss(leftThrower, 0, add(inFront, vec3(0.7, 0, 0)));
    match.pass(0.8);
    for (let i = 0; i < 40; i++) {
      const ball = ballPosition(match.state, 0, match.now() + tickSeconds)!;
      // Every other tick far away, every other just under the ball.
      match.step(hold(match.now() + tickSeconds, i % 2 ? inFront : add(ball, vec3(0, -0.02, 0))));
    }
    expect(match.state.score).toBe(0);
    const walker = told();
    walker.take(leftThrower, 0);
    walker.toss(leftThrower, 0, vec3(0, 1, -2), 0.5);
    for (let i = 0; i < 60; i++) {
      const pose = hold(walker.now(), vec3(0, 1, -2)) as Extract<BallInput, { type: 'pose' }>;
      walker.step({ ...pose, head: vec3(0, 1.6, -2.4) });
    }
    expect(walker.state.score).toBe(0);
  });
});

describe('the basket', () => {
  test('hangs between two hands that hold it by its rim, and opens where the thumbs point', () => {
    fc.assert(
      fc.property(vector(2), evenly(-Math.PI, Math.PI), evenly(-0.8, 0.8), (centre, yaw, tilt) => {
        const across = vec3(Math.cos(yaw), 0, -Math.sin(yaw));
        const ahead = vec3(-Math.sin(yaw), 0, -Math.cos(yaw));
        const thumb = vec3(ahead.x * Math.sin(tilt), Math.cos(tilt), ahead.z * Math.sin(tilt));
        const knuckles = vec3(ahead.x * Math.cos(tilt), -Math.sin(tilt), ahead.z * Math.cos(tilt));
        const fist = (sign: number) => add(centre, vec3(across.x * sign, 0, across.z * sign));
        const left = wristAround('left', fist(-gripRadius), knuckles, thumb);
        const right = wristAround('right', fist(gripRadius), knuckles, thumb);
        for (const opening of [basketInHands(left, right), basketInHands(left, null), basketInHands(null, right)]) {
          expect(distance(opening!.position, centre)).toBeLessThan(1e-9);
          expect(distance(opening!.normal, thumb)).toBeLessThan(1e-9);
        }
      }),
      { seed },
    );
  });

  test('needs a hand', () => {
    expect(basketInHands(null, null)).toBeNull();
  });
});
