import { add, nextRandom, vec3 } from 'threepoint/math';
import { type BallEvent, type BallInput, type BallState, ballRules, rackPosition } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import { seed } from '../../threepoint/core/arbitraries';
import { numbersIn } from '../../threepoint/core/numbers-in';
import { headOf, hold, inFront, stand, tickSeconds, velocityTo } from './playing';

/** A whole game of random actions, some of them impossible, by tick. */
function randomGame(matchSeed: number, ticks: number): BallInput[][] {
  let random = { seed: matchSeed };
  const chance = (): number => {
    const next = nextRandom(random);
    random = next.state;
    return next.value;
  };
  const below = (end: number) => Math.floor(chance() * end);
  const log: BallInput[][] = [[0, 1, 2].map((player): BallInput => ({ type: 'join', player }))];
  log.push([0, 1, 2].map((player): BallInput => ({ type: 'ready', player, ready: true })));
  const sequence = [0, 0, 0];
  for (let tick = 2; tick < ticks; tick++) {
    const at = tick * tickSeconds;
    const actions: BallInput[] = [];
    if (chance() < 0.5) actions.push(hold(at, add(inFront, vec3(chance() - 0.5, chance() - 0.5, 0.3 * chance()))));
    for (const player of [0, 1]) {
      if (chance() > 0.3) continue;
      const ball = player * 10 + below(10);
      const side = chance() < 0.5 ? 'left' : 'right';
      const from = add(headOf(player), vec3(0, 0, -0.4));
      const sort = chance();
      sequence[player]! += 1;
      const numbered = { player, side, sequence: sequence[player]! } as const;
      if (sort < 0.4) actions.push(stand(player, at, rackPosition(ball, 20)), { type: 'grab', ball, ...numbered });
      else if (sort < 0.9) {
        const velocity = velocityTo(from, add(inFront, vec3(chance() - 0.5, 0, 0)), 0.7 + 0.6 * chance());
        for (let other = player * 10; other < player * 10 + 10; other++) {
          actions.push(stand(player, at, from), {
            type: 'throw',
            ball: other,
            at,
            position: from,
            velocity,
            ...numbered,
          });
          sequence[player]! += 1;
          Object.assign(numbered, { sequence: sequence[player]! });
        }
      } else actions.push({ type: 'drop', ...numbered });
    }
    if (chance() < 0.002) actions.push({ type: 'leave', player: below(3) });
    if (chance() < 0.02) actions.push({ type: 'join', player: below(3) });
    log.push(actions);
  }
  return log;
}

const play = (log: readonly (readonly BallInput[])[], from?: BallState) => {
  let state = from ?? ballRules.start(['a', 'b', 'c'], 5);
  const events: BallEvent[] = [];
  for (const actions of log) {
    const done = ballRules.step(state, actions);
    state = done.state;
    events.push(...done.events);
  }
  return { state, events };
};

describe('a record of a match', () => {
  test('plays the same again, also from the middle through JSON', () => {
    let points = 0;
    for (let matchSeed = 1; matchSeed <= 6; matchSeed++) {
      const log = randomGame(matchSeed, 900);
      const whole = play(log);
      points += whole.state.score;
      expect(play(log)).toEqual(whole);
      const half = play(log.slice(0, 450));
      const rest = play(log.slice(450), JSON.parse(JSON.stringify(half.state)) as BallState);
      expect(rest.state).toEqual(whole.state);
      expect([...half.events, ...rest.events]).toEqual(whole.events);
      expect(numbersIn(whole.state).every(Number.isFinite)).toBe(true);
    }
    expect(points).toBeGreaterThan(5);
  });

  test('counts no point twice in 100,000 actions repeated and out of order', () => {
    let repeated = 0;
    let points = 0;
    let random = { seed };
    const chance = (): number => {
      const next = nextRandom(random);
      random = next.state;
      return next.value;
    };
    for (let matchSeed = 1; repeated < 100_000; matchSeed++) {
      const log = randomGame(matchSeed, 700);
      const past: BallInput[] = [];
      const noisy = log.map((tick) => {
        const actions = tick.filter(({ type }) => type === 'grab' || type === 'throw' || type === 'drop');
        past.push(...actions);
        const again = Array.from({ length: 20 }, () => past[Math.floor(chance() * past.length)]).filter(
          (action) => action !== undefined,
        );
        repeated += again.length;
        return [...tick, ...actions, ...again];
      });
      const { state, events } = play(noisy);
      const caught = events.flatMap((event) => (event.type === 'caught' ? [event.ball] : []));
      expect(new Set(caught).size).toBe(caught.length);
      expect(state.score).toBe(caught.length);
      points += state.score;
      const inBasket = state.balls.filter(({ on }) => on === 'basket').length;
      expect(state.score).toBe(inBasket);
    }
    console.log(`ball game: ${repeated} actions repeated or out of order, ${points} points, none twice`);
    expect(points).toBeGreaterThan(20);
  });
});
