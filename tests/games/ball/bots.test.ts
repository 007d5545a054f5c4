import fc from 'fast-check';
import { createEstimator, type TrackingFrame } from 'threepoint/core';
import { distance, length, rotate, subtract, vec3 } from 'threepoint/math';
import { describe, expect, it } from 'vitest';
import type { BallBot } from '../../../src/games/ball/ball-bot';
import type { BallEvent, BallInput, BallState } from '../../../src/games/ball/ball-state';
import { BallGestures } from '../../../src/games/ball/gestures';
import { ballRules } from '../../../src/games/ball/rules';
import { createSimulatedHolder } from '../../../src/games/ball/simulated-holder';
import { createSimulatedThrower } from '../../../src/games/ball/simulated-thrower';
import { stations, zoneRadius } from '../../../src/games/ball/stations';

interface Match {
  readonly state: BallState;
  readonly events: readonly BallEvent[];
  readonly frames: readonly (readonly TrackingFrame[])[];
}

/** Three bots through the full gestures, frame by frame, until the match is over. */
function play({
  seed = 1,
  rateHz = 72,
  eyeHeights = [1.6, 1.6, 1.6],
  button = 'trigger' as 'trigger' | 'pinch',
}): Match {
  let state = ballRules.start(['ann', 'ben', 'cal'], seed);
  const bots: BallBot[] = stations.map((arenaFromFloor, index) => {
    const body = { eyeHeight: eyeHeights[index] ?? 1.6, arenaFromFloor, button };
    return index === 2 ? createSimulatedHolder(body) : createSimulatedThrower(body, seed + index);
  });
  let time = 0;
  const gestures: BallGestures[] = stations.map(
    (arenaFromFloor, player) => new BallGestures(() => ({ player, state, arenaFromFloor, matchAhead: 0 })),
  );
  const events: BallEvent[] = [];
  const frames: TrackingFrame[][] = [];
  let waiting: BallInput[] = [0, 1, 2].flatMap((player): BallInput[] => [
    { type: 'join', player },
    { type: 'ready', player, ready: true },
  ]);
  for (let frame = 0; state.phase !== 'over' && time < 120; frame++) {
    time = frame / rateHz;
    const seen: TrackingFrame[] = [];
    bots.forEach((bot, player) => {
      const performed = bot.follow(time, { state, player });
      seen.push(performed.frame);
      waiting.push(...(gestures[player]?.follow(performed.frame, performed.buttons).actions ?? []));
    });
    frames.push(seen);
    while ((state.tick + 1) * ballRules.tickSeconds <= time) {
      const done = ballRules.step(state, waiting);
      waiting = [];
      state = done.state;
      events.push(...done.events);
      for (const gesture of gestures) gesture.onEvents(done.events);
    }
  }
  return { state, events, frames };
}

describe('bots', () => {
  it('three of them throw all twenty balls within the 90 s, and most are caught', () => {
    const { state, events } = play({});
    expect(state.phase).toBe('over');
    expect(state.end).toBe('balls');
    expect(events.filter(({ type }) => type === 'thrown')).toHaveLength(20);
    expect(state.score).toBeGreaterThanOrEqual(14);
    expect(events.flatMap((event) => (event.type === 'refused' ? [event.reason] : []))).toEqual([]);
  });

  it('miss now and then: between one throw in twenty and one in five', { tags: ['full'] }, () => {
    const matches = [1, 2, 3, 4, 5, 6].map((match) => play({ seed: 100 * match, rateHz: 60 }));
    const missed = matches.reduce((sum, { state }) => sum + state.options.balls - state.score, 0) / (6 * 20);
    console.log(`missed ${(100 * missed).toFixed(0)} % of 120 throws`);
    expect(missed).toBeGreaterThan(0.05);
    expect(missed).toBeLessThan(0.2);
  });

  it('play the same match again from the same seed, and another one from another', () => {
    const [first, again, other] = [play({}), play({}), play({ seed: 2 })];
    expect(again.events).toEqual(first.events);
    expect(other.events).not.toEqual(first.events);
  });

  it('are tall or small, stand or sit, press a trigger or pinch, at any frame rate', { tags: ['full'] }, () => {
    fc.assert(
      fc.property(
        fc.record({
          seed: fc.integer({ min: 1, max: 1e6 }),
          rateHz: fc.constantFrom(60, 72, 90, 120),
          eyeHeights: fc.array(fc.double({ min: 1.1, max: 1.95, noNaN: true }), { minLength: 3, maxLength: 3 }),
          button: fc.constantFrom('trigger' as const, 'pinch' as const),
        }),
        (who) => {
          const { state, events } = play(who);
          expect(state.end).toBe('balls');
          expect(state.score).toBeGreaterThanOrEqual(8);
          expect(events.filter(({ type }) => type === 'refused')).toEqual([]);
        },
      ),
      { numRuns: 12, seed: 5 },
    );
  });

  it('stand upright however they reach: the solved pelvis is well below the head and faces ahead', () => {
    const { frames } = play({});
    const estimators = [0, 1, 2].map(() => createEstimator('ik', { eyeHeight: 1.6, armSpan: 1.5 }));
    frames.forEach((now, index) => {
      if (index % 3 !== 0) return;
      now.forEach((frame, player) => {
        const { body } = estimators[player]?.update(frame).pose ?? {};
        expect(body && frame.head.position.y - body.hipsPosition.y).toBeGreaterThan(0.45);
        expect(rotate(frame.head.orientation, vec3(0, 0, -1)).z).toBeLessThan(-0.4);
      });
    });
  });

  it('move as a body can: hands within reach, slower than throws, feet near the mark', () => {
    const { frames } = play({});
    let fastest = 0;
    for (const [index, now] of frames.entries()) {
      now.forEach((frame, player) => {
        const { position } = frame.head;
        expect(Math.hypot(position.x, position.z)).toBeLessThan(zoneRadius);
        const before = frames[index - 1]?.[player];
        for (const side of ['leftHand', 'rightHand'] as const) {
          const hand = frame[side];
          const last = before?.[side];
          expect(hand && distance(hand.position, position)).toBeLessThan(1.05);
          if (hand && last) fastest = Math.max(fastest, length(subtract(hand.position, last.position)) * 72);
        }
      });
    }
    expect(fastest).toBeGreaterThan(4);
    expect(fastest).toBeLessThan(9);
  });
});
