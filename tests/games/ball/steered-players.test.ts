import { distance, normalise, subtract, transformPoint, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import type { BallBot } from '../../../src/games/ball/ball-bot';
import type { BallState, TimedLaunch } from '../../../src/games/ball/ball-state';
import { BallGestures } from '../../../src/games/ball/gestures';
import type { PlayerBody } from '../../../src/games/ball/player-postures';
import { ballRules } from '../../../src/games/ball/rules';
import { createSimulatedHolder } from '../../../src/games/ball/simulated-holder';
import { createSimulatedThrower } from '../../../src/games/ball/simulated-thrower';
import { stations } from '../../../src/games/ball/stations';
import {
  type BallSteering,
  createSteeredHolder,
  createSteeredThrower,
  type SteeredPlayer,
} from '../../../src/games/ball/steered-players';
import { fallTime, positionAt } from '../../../src/games/ballistics';

const bodyAt = (player: number): PlayerBody => ({ eyeHeight: 1.6, arenaFromFloor: stations[player]! });

/** From a camera behind and above the player, at a point in front of them (own floor frame). */
function pointingAt(x: number, y: number, z: number): BallSteering['ray'] {
  const origin = vec3(-0.8, 2, 3.5);
  return { origin, direction: normalise(subtract(vec3(x, y, z), origin)) };
}

const released: Omit<BallSteering, 'ray'> = { pressed: false, cancelled: false };

interface Seen {
  readonly time: number;
  readonly state: BallState;
  readonly player: SteeredPlayer;
}

/**
 * A match at 60 frames a second with one seat at the mouse, the other thrower idle and a built-in player for the third.
 */
function playing(seat: number, steer: (seen: Seen) => BallSteering, others: 'idle' | 'built-in' = 'idle') {
  let state = ballRules.start(['a', 'b', 'c'], 1);
  const told: { now: BallSteering } = { now: { ray: pointingAt(0, 1, -4.5), ...released } };
  const player = (seat === 2 ? createSteeredHolder : createSteeredThrower)(bodyAt(seat), () => told.now);
  const seats = [0, 1, 2].map((index) => {
    const bot: BallBot =
      index === seat
        ? player
        : index === 2
          ? createSimulatedHolder(bodyAt(2))
          : createSimulatedThrower(bodyAt(index), 3);
    const gestures = new BallGestures(() => ({
      player: index,
      state,
      arenaFromFloor: stations[index]!,
      matchAhead: 0,
    }));
    return { index, bot, gestures };
  });
  const playingSeats = seats.filter(({ index }) => index === seat || index === 2 || others === 'built-in');
  state = ballRules.step(
    state,
    playingSeats.map(({ index }) => ({ type: 'join' as const, player: index })),
  ).state;
  state = ballRules.step(
    state,
    playingSeats.map(({ index }) => ({ type: 'ready' as const, player: index, ready: true })),
  ).state;
  const refused: string[] = [];
  const launches: TimedLaunch[] = [];
  let time = 0;
  return {
    player,
    refused,
    launches,
    get state() {
      return state;
    },
    pass(seconds: number) {
      for (let i = 0; i < seconds * 60; i++) {
        time += 1 / 60;
        told.now = steer({ time, state, player });
        const actions = playingSeats.flatMap(({ index, bot, gestures }) => {
          const { frame, buttons } = bot.follow(time, { state, player: index });
          return gestures.follow(frame, buttons).actions;
        });
        const done = ballRules.step(state, actions);
        state = done.state;
        for (const { gestures } of playingSeats) gestures.onEvents(done.events);
        for (const event of done.events) {
          if (event.type === 'refused') refused.push(event.reason);
          if (event.type === 'thrown') launches.push(event.launch);
        }
      }
    },
  };
}

const thrown = (state: BallState) => state.balls.filter(({ on }) => on !== 'rack' && on !== 'hand').length;

describe.each([0, 1])('with a mouse on seat %i', (seat) => {
  test('a player who holds until the dots end in the basket scores with most throws', () => {
    const match = playing(seat, ({ state, player }) => {
      const basket = state.basket.position;
      const { aim } = player;
      // A person lets go as soon as the dots reach the opening.
      const lands = aim && positionAt(aim, fallTime(aim, basket.y));
      const far = lands !== null && Math.hypot(lands.x - basket.x, lands.z - basket.z) < 0.12;
      const at = transformPoint(
        { position: vec3(-stations[seat]!.position.x, 0, 0), orientation: stations[seat]!.orientation },
        basket,
      );
      return { ray: pointingAt(at.x, at.y, at.z), pressed: !far, cancelled: false };
    });
    match.pass(40);
    expect(thrown(match.state)).toBeGreaterThanOrEqual(10);
    expect(match.state.score).toBeGreaterThanOrEqual(8);
    expect(match.refused).toEqual([]);
  });

  test('the ball goes where the dots showed', () => {
    let shown: SteeredPlayer['aim'] = null;
    const match = playing(seat, ({ time, player }) => {
      shown = player.aim ?? shown;
      return { ray: pointingAt(0.5, 1.4, -4.5), pressed: time < 2.5, cancelled: false };
    });
    match.pass(2.9);
    const [launch] = match.launches;
    if (!launch || !shown) throw new Error('nothing thrown');
    const there = (of: typeof launch) => positionAt(of, fallTime(of, 1));
    expect(distance(there(launch), there({ ...launch, ...(shown as object) }))).toBeLessThan(0.1);
  });

  test('a longer hold throws further, and the pointer decides how far to the side', () => {
    const landing = (hold: number, x: number) => {
      let began: number | null = null;
      const match = playing(seat, ({ time, player }) => {
        if (player.aim) began ??= time;
        return { ray: pointingAt(x, 1, -4.5), pressed: began === null || time - began < hold, cancelled: false };
      });
      match.pass(4);
      const [launch] = match.launches;
      if (!launch) throw new Error('nothing thrown');
      return launch;
    };
    const speed = (launch: ReturnType<typeof landing>) => Math.hypot(launch.velocity.x, launch.velocity.z);
    expect(speed(landing(0.9, 0))).toBeGreaterThan(1.2 * speed(landing(0.3, 0)));
    expect(landing(0.6, 1.5).velocity.x).toBeGreaterThan(landing(0.6, -1.5).velocity.x + 1);
  });

  test('Escape keeps the ball in the hand, and the same press throws it no more', () => {
    const match = playing(seat, ({ time, player }) => {
      return { ray: pointingAt(0, 1, -4.5), pressed: time < 4, cancelled: player.aim !== null && time > 2 };
    });
    match.pass(5);
    expect(thrown(match.state)).toBe(0);
    expect(match.state.balls.filter(({ on }) => on === 'hand')).toHaveLength(1);
  });

  test('a player who never presses never throws', () => {
    const match = playing(seat, () => ({ ray: pointingAt(0, 1, -4.5), ...released }));
    match.pass(10);
    expect(thrown(match.state)).toBe(0);
    expect(match.refused).toEqual([]);
  });
});

describe('with a mouse at the basket', () => {
  test('a player who points at where the balls come down catches most of them', { tags: ['full'] }, () => {
    const home = vec3(0, 1, -0.5);
    const match = playing(
      2,
      ({ state }) => {
        const now = state.tick / 60;
        const coming = state.balls.find(
          (place) => place.on === 'air' && !place.missed && now - place.launch.time < 1.1,
        );
        let at = home;
        if (coming?.on === 'air') {
          const { launch } = coming;
          const arena = positionAt(launch, fallTime(launch, state.basket.position.y));
          const { position } = stations[2]!;
          // The holder looks back at the throwers.
          at = vec3(position.x - arena.x, arena.y, position.z - arena.z);
        }
        return { ray: pointingAt(at.x, at.y, at.z), ...released };
      },
      'built-in',
    );
    match.pass(70);
    expect(thrown(match.state)).toBe(20);
    expect(match.state.score).toBeGreaterThanOrEqual(12);
  });

  test('the basket goes as far as arms and a step do, wherever the pointer is', () => {
    const match = playing(2, ({ time }) => ({
      ray: { origin: vec3(-0.8, 2, 3.5), direction: normalise(vec3(Math.sin(3 * time), Math.cos(5 * time), -1)) },
      ...released,
    }));
    for (let i = 0; i < 60; i++) {
      match.pass(0.1);
      const { position } = match.state.basket;
      expect(Math.hypot(position.x - stations[2]!.position.x, position.z - stations[2]!.position.z)).toBeLessThan(1.3);
    }
  });
});
