import fc from 'fast-check';
import { add, nextRandom, type Vec3, vec3 } from 'threepoint/math';
import { type BallInput, ballRules, rackPosition } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { ballMatchTime } from '../../../src/games/ball/state-selectors';
import { evenly, seed } from '../../threepoint/core/arbitraries';
import { headOf, hold, inFront, leftThrower, stand, tickSeconds, told, velocityTo } from './playing';

test('1,000 throws end the same at round trips of 0 to 200 ms as at none', { tags: ['full'] }, () => {
  let random = { seed };
  const chance = (): number => {
    const next = nextRandom(random);
    random = next.state;
    return next.value;
  };
  let same = 0;
  let caught = 0;
  const throws = 1000;
  for (let i = 0; i < throws; i++) {
    const phases = [chance() * 7, chance() * 7, 0.25 + 0.6 * chance()];
    const opening = (time: number): Vec3 =>
      add(inFront, vec3(0.3 * Math.sin(3 * time + phases[0]!), 0.15 * Math.sin(4 * time + phases[1]!), 0));
    const from = add(headOf(leftThrower), vec3(0, 0, -0.5));
    const releaseAt = 0.5 + chance() * 0.01;
    const flight = 0.7 + 0.5 * chance();
    const target = add(opening(releaseAt + flight), vec3((chance() - 0.5) * phases[2]!, 0, 0));
    const velocity = velocityTo(from, target, flight);
    const verdict = (thrower: number, holding: number): boolean => {
      let state = ballRules.start(['a', 'b', 'c'], 1);
      const late: { readonly due: number; readonly action: BallInput }[] = [
        ...[0, 1, 2].flatMap((player): { due: number; action: BallInput }[] => [
          { due: 0, action: { type: 'join', player } },
          { due: 0, action: { type: 'ready', player, ready: true } },
        ]),
        { due: 0.1, action: stand(leftThrower, 0.05, rackPosition(0, 20)) },
        { due: 0.12, action: { type: 'grab', player: leftThrower, sequence: 1, side: 'right', ball: 0 } },
        { due: releaseAt + thrower, action: stand(leftThrower, releaseAt, from) },
        {
          due: releaseAt + thrower,
          action: {
            type: 'throw',
            player: leftThrower,
            sequence: 2,
            side: 'right',
            ball: 0,
            at: releaseAt,
            position: from,
            velocity,
          },
        },
        // 30 poses a second, as they were sent.
        ...Array.from({ length: 75 }, (_, n) => ({ due: n / 30 + holding, action: hold(n / 30, opening(n / 30)) })),
      ];
      for (let tick = 0; tick < 140; tick++) {
        const now = tick * tickSeconds;
        const due = late.filter(({ due: when }) => when <= now && when > now - tickSeconds);
        state = ballRules.step(
          state,
          due.map(({ action }) => action),
        ).state;
      }
      return state.score === 1;
    };
    const without = verdict(0, 0);
    if (without) caught += 1;
    if (without === verdict(chance() * 0.1, chance() * 0.1)) same += 1;
  }
  console.log(`ball game: ${same} of ${throws} verdicts the same at round trips of 0 to 200 ms (${caught} caught)`);
  expect(caught).toBeGreaterThan(throws / 5);
  expect(caught).toBeLessThan((throws * 4) / 5);
  expect(same).toBeGreaterThanOrEqual(0.99 * throws);
});

test('a decided time stays decided, whatever times the poses give', () => {
  fc.assert(
    fc.property(fc.array(evenly(-5, 5), { minLength: 1, maxLength: 20 }), (times) => {
      const match = told();
      for (const at of times) {
        const before = match.state.basket.at;
        match.step(hold(at, inFront));
        expect(match.state.basket.at).toBeGreaterThanOrEqual(before);
        expect(match.state.basket.at).toBeLessThanOrEqual(ballMatchTime(match.state) + 1e-4);
      }
    }),
    { seed },
  );
});
