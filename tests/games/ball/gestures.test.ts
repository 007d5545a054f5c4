import fc from 'fast-check';
import { allReleased, type Button, type HandButtons, type TrackingFrame } from 'threepoint/core';
import {
  add,
  addScaled,
  distance,
  fromAxisAngle,
  identity,
  invertTransform,
  scale,
  type TrackedPose,
  transformPoint,
  transformPose,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import type { BallInput, BallState } from '../../../src/games/ball/ball-state';
import { ballRadius } from '../../../src/games/ball/flight';
import { BallGestures, holdSeconds } from '../../../src/games/ball/gestures';
import { HandVelocity, throwWindow } from '../../../src/games/ball/hand-velocity';
import { ballRules } from '../../../src/games/ball/rules';
import { rackPosition, stations } from '../../../src/games/ball/stations';
import { ballInPalm, fistOf, wristAround } from '../../../src/games/fist';
import { reportFigures } from '../../reliability/report-figures';
import { evenly, seed, vector } from '../../threepoint/core/arbitraries';
import { holder, leftThrower, told } from './playing';

const arenaFromFloor = stations[leftThrower]!;
const floorFromArena = invertTransform(arenaFromFloor);
const other = { left: 'right', right: 'left' } as const;
type Side = 'left' | 'right';

/** A player with one fist at given places of the arena; the other hand hangs. */
function throwing(options: { side?: Side; button?: Button; state?: BallState; player?: number } = {}) {
  const { side = 'right', button = 'trigger', player = leftThrower } = options;
  const match = told();
  let time = 100;
  const settings = { player, matchAhead: -100, arenaFromFloor, state: options.state ?? match.state };
  const gestures = new BallGestures(() => settings);
  const tracked = (fist: Vec3, hand: Side): TrackedPose => ({
    ...transformPose(floorFromArena, wristAround<'arena'>(hand, fist, vec3(0, 0, -1), vec3(0, 1, 0))),
    tracking: 'tracked',
  });
  /** How far behind the mark the head is [m]. */
  const aside = { back: 0 };
  const frame = (fist: Vec3 | null, pressed: number, kind?: HandButtons['kind'], seconds = 1 / 90) => {
    time += seconds;
    const hanging = transformPoint(arenaFromFloor, vec3(side === 'right' ? -0.25 : 0.25, 0.8, 0));
    const hands = {
      [`${side}Hand`]: fist && tracked(fist, side),
      [`${other[side]}Hand`]: tracked(hanging, other[side]),
    } as unknown as Pick<TrackingFrame, 'leftHand' | 'rightHand'>;
    const head: TrackedPose = { position: vec3(0, 1.6, aside.back), orientation: identity, tracking: 'tracked' };
    const buttons: Partial<Record<Side, HandButtons>> = {
      [side]: { ...allReleased, [button]: pressed, ...(kind && { kind }) },
    };
    const done = gestures.follow({ time, head, ...hands }, { left: allReleased, right: allReleased, ...buttons });
    const { state, events } = ballRules.step(settings.state, done.actions);
    settings.state = state;
    gestures.onEvents(events);
    return done;
  };
  const actions = (done: { readonly actions: readonly BallInput[] }) =>
    done.actions.filter(({ type }) => type !== 'pose');
  return { frame, aside, actions, gestures, settings, ball: rackPosition(0, 20), now: () => time - 100 };
}

const ahead = transformPoint(arenaFromFloor, vec3(0.2, 1.5, -0.3));

/** Takes ball 0 and carries it ahead. */
function carrying(options: Parameters<typeof throwing>[0] = {}) {
  const player = throwing(options);
  player.frame(player.ball, 0);
  const taken = player.frame(player.ball, 1);
  for (let i = 0; i < 10; i++) player.frame(ahead, 1);
  return { ...player, taken };
}

describe('a hand', () => {
  test.each([
    ['left', 'trigger'],
    ['right', 'grip'],
    ['left', 'pinch'],
  ] as const)('takes and throws: the %s one with its %s', (side, button) => {
    const { frame, actions, taken, settings, now } = carrying({ side, button });
    expect(actions(taken)).toEqual([{ type: 'grab', player: leftThrower, sequence: 1, side, ball: 0 }]);
    expect(settings.state.balls[0]).toEqual({ on: 'hand', player: leftThrower, side });
    const velocity = vec3(0.5, 3, -4);
    const fist = (i: number) => addScaled(ahead, velocity, i / 90);
    for (let i = 1; i < 12; i++) frame(fist(i), 1);
    let done = frame(fist(12), 0);
    if (button === 'pinch') done = frame(fist(13), 0);
    const [thrown] = actions(done);
    if (thrown?.type !== 'throw') throw new Error('nothing thrown');
    expect(distance(thrown.velocity, velocity)).toBeLessThan(1e-9);
    // From where it is drawn.
    const wrist = wristAround<'arena'>(side, fist(12), vec3(0, 0, -1), up);
    expect(distance(thrown.position, ballInPalm(wrist, ballRadius))).toBeLessThan(1e-9);
    expect(thrown.at).toBeCloseTo(button === 'pinch' ? now() - 1 / 90 : now(), 9);
    expect(settings.state.balls[0]?.on).toBe('air');
    expect(done.held).toEqual({ left: null, right: null });
  });

  test('feels the ball that a press would take, and takes nothing from far away', () => {
    const { frame, actions, ball } = throwing();
    expect(frame(add(ball, vec3(0, 0.5, 0)), 0).near.right).toBeNull();
    const near = frame(add(ball, vec3(0, 0.1, 0)), 0);
    expect(near.near.right).toBe(0);
    expect(near.haptics.length).toBe(1);
    expect(frame(add(ball, vec3(0, 0.1, 0)), 0).haptics.length).toBe(0);
    frame(add(ball, vec3(0, 0.5, 0)), 0);
    expect(actions(frame(add(ball, vec3(0, 0.5, 0)), 1))).toEqual([]);
    // Coming near with the button down is no press.
    expect(actions(frame(ball, 1))).toEqual([]);
  });

  test('puts the ball back when it lets go at rest', () => {
    const { frame, actions, settings } = carrying();
    for (let i = 0; i < 10; i++) frame(ahead, 1);
    expect(actions(frame(ahead, 0))).toEqual([{ type: 'drop', player: leftThrower, sequence: 2, side: 'right' }]);
    expect(settings.state.balls[0]).toEqual({ on: 'rack' });
  });

  test('keeps its ball when lost for a moment, puts it back later, and never throws', () => {
    const { frame, actions } = carrying();
    for (let i = 0; i < 20; i++) expect(actions(frame(null, 0))).toEqual([]);
    expect(actions(frame(ahead, 1))).toEqual([]);
    const dropped = Array.from({ length: Math.ceil(90 * holdSeconds) + 3 }, () => actions(frame(null, 0))).flat();
    expect(dropped).toEqual([{ type: 'drop', player: leftThrower, sequence: 2, side: 'right' }]);
  });

  test('has not thrown when it returns with its button released', () => {
    const { frame, actions } = carrying();
    frame(null, 1);
    expect(actions(frame(addScaled(ahead, vec3(0, 1, -1), 0.3), 0)).map(({ type }) => type)).toEqual(['drop']);
  });

  test('lets go when its device changes', () => {
    const player = throwing();
    player.frame(player.ball, 0, 'controller');
    player.frame(player.ball, 1, 'controller');
    player.frame(ahead, 1, 'controller');
    expect(player.actions(player.frame(ahead, 1, 'hand')).map(({ type }) => type)).toEqual(['drop']);
  });

  test('lets go in a pause: no ball is thrown across a menu', () => {
    const { frame, actions } = carrying();
    expect(actions(frame(addScaled(ahead, vec3(0, 0, -1), 0.5), 0, undefined, 2)).map(({ type }) => type)).toEqual([
      'drop',
    ]);
  });

  test('is empty after its grab was refused, and says so', () => {
    const { frame, gestures } = carrying();
    gestures.onEvents([{ type: 'refused', player: leftThrower, sequence: 1, reason: 'taken' }]);
    const done = frame(ahead, 1);
    expect(done.held.right).toBeNull();
    expect(done.cues.map(({ type }) => type)).toEqual(['slipped']);
  });

  test('lets go of the ball after its throw was refused, and can take another', () => {
    const { frame, aside, actions, settings, ball } = carrying();
    // Behind the line no ball is thrown.
    aside.back = 1.4;
    for (let i = 1; i < 12; i++) frame(addScaled(ahead, vec3(0, 3, -4), i / 90), 1);
    expect(actions(frame(addScaled(ahead, vec3(0, 3, -4), 12 / 90), 0)).map(({ type }) => type)).toEqual(['throw']);
    expect(settings.state.balls[0]?.on).toBe('hand');
    const after = frame(ahead, 0);
    expect(actions(after)).toEqual([{ type: 'drop', player: leftThrower, sequence: 3, side: 'right' }]);
    expect(after.cues.map(({ type }) => type)).toEqual(['slipped']);
    expect(settings.state.balls[0]).toEqual({ on: 'rack' });
    aside.back = 0;
    frame(ball, 0);
    frame(ball, 1);
    expect(settings.state.balls[0]).toEqual({ on: 'hand', player: leftThrower, side: 'right' });
  });

  test('takes no balls if it is the basket holder’s, but reports its place', () => {
    const { frame, ball, actions, settings } = throwing({ player: holder });
    frame(ball, 0);
    const done = frame(ball, 1);
    expect(actions(done)).toEqual([]);
    const pose = done.actions[0];
    if (pose?.type !== 'pose') throw new Error('no pose');
    expect(pose.at).toBeCloseTo(2 / 90, 9);
    expect(distance(fistOf(pose.right!), ball)).toBeLessThan(1e-9);
    expect(settings.state.players[holder]?.at).toBeCloseTo(2 / 90, 3);
  });
});

describe('the speed of a hand', () => {
  const follow = (path: (time: number) => Vec3, times: readonly number[]): Vec3 => {
    const speed = new HandVelocity();
    for (const time of times) speed.follow(time, path(time));
    return speed.velocity();
  };
  const times = (hz: number, seconds = 0.3) => Array.from({ length: Math.round(seconds * hz) + 1 }, (_, i) => i / hz);

  test('an even pull has one speed at every frame rate, with dropped frames and jittering times', () => {
    fc.assert(
      fc.property(
        vector(10),
        fc.constantFrom(60, 72, 80, 90, 120),
        fc.array(fc.record({ kept: fc.integer({ min: 0, max: 9 }), jitter: evenly(-0.3, 0.3) }), {
          minLength: 40,
          maxLength: 40,
        }),
        (velocity, hz, luck) => {
          const kept = times(hz).flatMap((time, i) =>
            luck[i]!.kept < 7 || i === 0 ? [time + luck[i]!.jitter / hz] : [],
          );
          fc.pre(kept.length > 2);
          expect(
            distance(
              follow((time) => scale(velocity, time), kept),
              velocity,
            ),
          ).toBeLessThan(1e-6);
        },
      ),
      { seed },
    );
  });

  test('an overhand throw lands within 10 cm at every frame rate with 30 % of frames dropped', () => {
    // An arm of 65 cm about the shoulder, 9 rad/s and faster.
    const path = (time: number): Vec3 => {
      const angle = 9 * time + 4 * time * time - 2.2;
      return vec3(0.1 * time, 1.4 + 0.65 * Math.cos(angle), -0.65 * Math.sin(angle));
    };
    const reference = follow(path, times(1000));
    expect(distance(reference, vec3(0, 0, 0))).toBeGreaterThan(4);
    let worst = 0;
    for (const hz of [72, 80, 90, 120]) {
      for (let dropped = 0; dropped < 10; dropped++) {
        const kept = times(hz).filter((time, i) => (i * 7 + dropped) % 10 > 2 || time >= 0.3 - 1e-9 || i === 0);
        const last = kept.at(-1)!;
        const velocity = follow(path, kept);
        const same = follow(path, times(1000, last));
        // After one second of flight.
        worst = Math.max(worst, distance(velocity, same));
      }
    }
    reportFigures('rates', { 'throws of a hand': `${(100 * worst).toFixed(1)} cm/s apart` });
    expect(worst).toBeLessThan(0.1);
  });

  test('looks back 80 ms and no further', () => {
    const turned = (time: number) => (time < 0.2 ? vec3(5 * time, 0, 0) : vec3(1, 0, -4 * (time - 0.2)));
    expect(distance(follow(turned, times(1000, 0.2 + throwWindow)), vec3(0, 0, -4))).toBeLessThan(1e-6);
  });

  test('is none of a hand that has just come, or of times that do not rise', () => {
    expect(follow(() => vec3(1, 1, 1), [])).toEqual(vec3(0, 0, 0));
    expect(follow((time) => vec3(time, 1, 1), [1])).toEqual(vec3(0, 0, 0));
    expect(follow((time) => vec3(time, 1, 1), [1, 1, 0.5])).toEqual(vec3(0, 0, 0));
    expect(follow((time) => vec3(time, 1, 1), [1, 1.5])).toEqual(vec3(0, 0, 0));
  });

  test('is none of a floor that turns at once, as by the stick', () => {
    const { frame, actions, gestures } = carrying();
    for (let i = 0; i < 12; i++) frame(ahead, 1);
    gestures.discontinuity();
    const aside = add(ahead, vec3(0.3, 0, 0));
    frame(aside, 1);
    frame(aside, 1);
    expect(actions(frame(aside, 0)).map(({ type }) => type)).toEqual(['drop']);
  });

  test('turns with the person', () => {
    fc.assert(
      fc.property(vector(5), evenly(-Math.PI, Math.PI), (velocity, yaw) => {
        const turn = { position: vec3(1, 0, 2), orientation: fromAxisAngle(up, yaw) };
        const there = (time: number) => transformPoint(turn, scale(velocity, time));
        const turned = transformPoint({ ...turn, position: vec3(0, 0, 0) }, velocity);
        expect(distance(follow(there, times(90)), turned)).toBeLessThan(1e-9);
      }),
      { seed },
    );
  });
});
