import fc from 'fast-check';
import type { Button } from 'threepoint/core';
import {
  add,
  angleBetween,
  distance,
  length,
  nextRandom,
  type RandomState,
  rotate,
  type Side,
  scale,
  subtract,
  up,
  vec3,
} from 'threepoint/math';
import { type ArcheryState, archeryRules, createSimulatedArcher } from 'threepoint-games/archery';
import { describe, expect, test } from 'vitest';
import type { ArcherBody } from '../../../src/games/archery/archer-postures';
import { arrowSpeed } from '../../../src/games/archery/bow';
import { fistOf } from '../../../src/games/fist';
import { evenly, seed } from '../../threepoint/core/arbitraries';
import { playRound, steady } from './playing';

const rates = [72, 80, 90, 120] as const;
const sides: readonly Side[] = ['left', 'right'];

describe('the built-in archer', () => {
  test.each(rates.flatMap((rate) => sides.map((side) => [rate, side] as const)))(
    'wins 50 of 50 at %d Hz, the bow in the %s hand',
    (rate, bowSide) => {
      const round = playRound({ archer: { bowSide, eyeHeight: 1.6 }, times: steady(rate) });
      expect(round.state).toMatchObject({ score: 50, end: 'targets', arrowsLeft: 1 });
      const said = round.cues.map(({ type }) => type).filter((type) => type !== 'creak');
      const shot = ['near-string', 'nocked', 'anchored', 'released'];
      expect(said).toEqual([...shot, ...shot, ...shot, ...shot]);
      expect(round.events.some(({ type }) => type === 'left-zone')).toBe(false);
    },
  );

  test('wins at any height, seed, hand, button and frame rate, standing or seated', { tags: ['full'] }, () => {
    fc.assert(
      fc.property(
        fc.record({
          bowSide: fc.constantFrom<Side>('left', 'right'),
          eyeHeight: evenly(1.1, 1.9),
          // A seated archer has the arms of a taller person.
          seated: fc.boolean(),
          button: fc.constantFrom<Button>('trigger', 'grip', 'pinch'),
        }),
        fc.integer(),
        fc.oneof(fc.constantFrom(...rates), evenly(45, 144)),
        ({ seated, ...standing }, matchSeed, rate) => {
          const archer: ArcherBody = seated
            ? { ...standing, eyeHeight: standing.eyeHeight * 0.72, armLength: 0.36 * standing.eyeHeight }
            : standing;
          const { state } = playRound({ archer, seed: matchSeed, times: steady(rate) });
          expect(state).toMatchObject({ score: 50, end: 'targets' });
          for (const arrow of state.arrows) {
            const { landing } = arrow;
            expect(distance(landing!.position, state.targets[landing!.target!]!.centre)).toBeLessThan(0.03);
          }
        },
      ),
      { seed, numRuns: 24 },
    );
  });

  test('lands each arrow within 1 mm of the same place at every frame rate', () => {
    const landings = (rate: number) =>
      playRound({ archer: { bowSide: 'left', eyeHeight: 1.6 }, times: steady(rate) }).state.arrows.map(
        ({ landing }) => landing!.position,
      );
    const at90 = landings(90);
    for (const rate of rates) {
      landings(rate).forEach((position, i) => {
        expect(distance(position, at90[i]!)).toBeLessThan(1e-3);
      });
    }
  });

  test('shoots at no target twice, however long the frame after a release takes', { tags: ['full'] }, () => {
    const archer: ArcherBody = { bowSide: 'left', eyeHeight: 1.6 };
    const opened = playRound({ archer, times: steady(90) }).gestures.findIndex(({ actions }) =>
      actions.some(({ type }) => type === 'release'),
    );
    expect(opened).toBeGreaterThan(0);
    for (const pause of [0.3, 0.49, 0.66, 0.8, 0.99]) {
      for (const before of [0, 2, 4, 6, 8]) {
        const times = [...steady(90)].map((time, frame) => (frame < opened - before ? time : time + pause));
        const { state } = playRound({ archer, times });
        const targets = state.arrows.map(({ landing }) => landing?.target);
        expect(new Set(targets).size, `${pause} s without a frame, ${before} frames before`).toBe(targets.length);
        expect(state.score).toBe(50);
      }
    }
  });

  test('wins when three of ten frames are dropped and the others come irregularly', () => {
    fc.assert(
      fc.property(fc.integer(), fc.constantFrom(...rates), (chance, rate) => {
        let random: RandomState = { seed: chance };
        const next = () => {
          const { value, state } = nextRandom(random);
          random = state;
          return value;
        };
        function* irregular(): Generator<number> {
          for (const time of steady(rate)) if (next() > 0.3) yield time + (next() * 0.4) / rate;
        }
        const { state } = playRound({ archer: { bowSide: 'right', eyeHeight: 1.7 }, times: irregular() });
        expect(state.score).toBe(50);
      }),
      { seed, numRuns: 5 },
    );
  });

  test('does the same for the same times', () => {
    const play = () => playRound({ archer: { bowSide: 'left', eyeHeight: 1.5 }, seed: 5, times: steady(80) });
    expect(JSON.stringify(play())).toBe(JSON.stringify(play()));
  });

  test('leaves a record that replays to the same end', () => {
    const { state, ticks } = playRound({ archer: { bowSide: 'left', eyeHeight: 1.6 }, seed: 9, times: steady(72) });
    const recorded = JSON.parse(JSON.stringify(ticks)) as typeof ticks;
    const start = archeryRules.start(['archer'], 9, { eyeHeight: 1.6 });
    const replayed = recorded.reduce((at: ArcheryState, actions) => archeryRules.step(at, actions).state, start);
    expect(JSON.stringify(replayed)).toBe(JSON.stringify(state));
  });

  test('shoots again at a target it missed because an arrow was lost', () => {
    // Both hands vanish during the second draw, long enough for the arrow to go back to the quiver.
    const { state, cues } = playRound({
      archer: { bowSide: 'left', eyeHeight: 1.6 },
      times: steady(90),
      spoil: (frame, buttons) => {
        const gone = frame.time - 12.345 > 6.5 && frame.time - 12.345 < 7.6;
        return { frame: gone ? { ...frame, rightHand: null } : frame, buttons };
      },
    });
    expect(cues.map(({ type }) => type)).toContain('cancelled');
    expect(state).toMatchObject({ score: 50, end: 'targets' });
  });

  test('chooses the highest value where every hit counts, and rests after the round', () => {
    const { state } = playRound({
      archer: { bowSide: 'left', eyeHeight: 1.6 },
      options: { everyHitCounts: true },
      times: steady(72),
    });
    expect(state).toMatchObject({ score: 70, end: 'arrows' });
    const archer = createSimulatedArcher({ bowSide: 'left', eyeHeight: 1.6 });
    archer.follow(0, state);
    const a = archer.follow(3, state).frame;
    const b = archer.follow(3.5, state).frame;
    expect(distance(a.leftHand!.position, b.leftHand!.position)).toBeLessThan(0.01);
    expect(a.rightHand!.position.y).toBeLessThan(1);
    // And plays again when there is something to play.
    const again = archeryRules.start(['archer'], 2);
    const pressures = Array.from({ length: 40 }, (_, i) => archer.follow(20 + i / 10, again).buttons.right.trigger);
    expect(pressures[0]).toBe(0);
    expect(Math.max(...pressures)).toBe(1);
  });

  test('waits in its follow-through for an arrow that still flies', () => {
    const state = archeryRules.start(['archer'], 1);
    const flying: ArcheryState = {
      ...state,
      arrows: [{ id: 0, release: { time: 4, position: vec3(0, 1.5, -1), velocity: vec3(0, 50, -1) }, landing: null }],
    };
    const archer = createSimulatedArcher({ bowSide: 'left', eyeHeight: 1.6 });
    const hand = (time: number, at: ArcheryState) => archer.follow(time, at).frame.rightHand!.position;
    for (let time = 0; time < 4.5; time += 0.01) hand(time, state);
    const then = hand(6, flying);
    expect(distance(hand(9, flying), then)).toBeLessThan(0.02);
    hand(9.1, state);
    expect(distance(hand(10, state), then)).toBeGreaterThan(0.2);
  });

  test.each([
    [1.2, 0.29],
    [1.6, 0.41],
    [1.9, 0.5],
  ])('with eyes at %d m draws %d m, the reach of a nearly straight bow arm', (eyeHeight, draw) => {
    const { state } = playRound({ archer: { bowSide: 'left', eyeHeight }, times: steady(72, 6) });
    expect(Math.abs(length(state.arrows[0]!.release.velocity) - arrowSpeed(draw))).toBeLessThan(1);
  });
});

describe('its movements', () => {
  const bodies: readonly ArcherBody[] = [
    { bowSide: 'left', eyeHeight: 1.6 },
    { bowSide: 'right', eyeHeight: 1.9 },
    { bowSide: 'left', eyeHeight: 1.1 },
    { bowSide: 'right', eyeHeight: 1.15, armLength: 0.57 },
  ];

  test.each(bodies)(
    '$bowSide, eyes at $eyeHeight m: hands at human speed, within reach, never through the head',
    (body) => {
      const rate = 90;
      const { frames } = playRound({ archer: body, times: steady(rate) });
      const arm = body.armLength ?? 0.36 * body.eyeHeight;
      for (const side of sides) {
        const hands = frames.map((frame) => frame[`${side}Hand`]!);
        const speeds = hands.slice(1).map((hand, i) => scale(subtract(hand.position, hands[i]!.position), rate));
        const accelerations = speeds.slice(1).map((speed, i) => length(subtract(speed, speeds[i]!)) * rate);
        expect(Math.max(...speeds.map(length))).toBeLessThan(4 * arm + 0.5);
        expect(Math.max(...accelerations)).toBeLessThan(40);
        const turns = hands.slice(1).map((hand, i) => angleBetween(hand.orientation, hands[i]!.orientation) * rate);
        expect(Math.max(...turns)).toBeLessThan(9);
        // The neck lies below and behind the eyes; both shoulders within their own half width of it.
        const reaches = hands.map(({ position }, i) =>
          distance(position, add(frames[i]!.head.position, vec3(0, -0.35 * arm, 0))),
        );
        expect(Math.max(...reaches)).toBeLessThan(arm * (1 + 0.32 + 0.19));
        const toSkull = hands.map((hand, i) => {
          const { head } = frames[i]!;
          return distance(fistOf(hand), add(head.position, rotate(head.orientation, vec3(0, 0.02, 0.08))));
        });
        expect(Math.min(...toSkull)).toBeGreaterThan(0.1);
      }
      const gazes = frames
        .slice(1)
        .map(({ head }, i) => angleBetween(head.orientation, frames[i]!.head.orientation) * rate);
      expect(Math.max(...gazes)).toBeLessThan(4);
    },
  );

  test.each(bodies)('$bowSide, eyes at $eyeHeight m: the bow is raised and the nock comes to the chin', (body) => {
    const { gestures, frames } = playRound({ archer: body, times: steady(90) });
    const anchored = gestures.flatMap(({ bow }, i) =>
      bow?.stage === 'anchored' ? [{ bow, head: frames[i]!.head }] : [],
    );
    expect(anchored.length).toBeGreaterThan(100);
    for (const { bow, head } of anchored) {
      expect(distance(bow.nockPoint, head.position)).toBeLessThan(0.3 * (body.armLength ?? 0.36 * body.eyeHeight));
      expect(bow.nockPoint.y).toBeLessThan(head.position.y);
      expect(rotate(bow.bow.orientation, up).y).toBeGreaterThan(0.95);
      expect(bow.draw).toBeGreaterThan(0.25);
    }
  });
});
