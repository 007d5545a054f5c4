import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type {
  ArcheryAction,
  ArcheryEvent,
  ArcheryOptions,
  ArcheryState,
} from '../../../../src/core/games/archery/archery-state';
import { arrowLength, arrowSpeed, maximumDraw, minimumDraw } from '../../../../src/core/games/archery/bow';
import { firstHit, releaseTowards } from '../../../../src/core/games/archery/flight';
import {
  archeryRules,
  delayed,
  matchTime,
  releaseInterval,
  secondsLeft,
  walls,
  zone,
} from '../../../../src/core/games/archery/rules';
import { createMatch } from '../../../../src/core/games/match';
import {
  add,
  addScaled,
  distance,
  dot,
  length,
  normalise,
  scale,
  subtract,
  type Vec3,
  vec3,
} from '../../../../src/core/math/vec3';
import { evenly, seed } from '../../arbitraries';

const { tickSeconds } = archeryRules;

const start = (options: Partial<ArcheryOptions> = {}, matchSeed = 7) =>
  archeryRules.start(['archer'], matchSeed, options);

const nockOf = (state: ArcheryState): Vec3 => add(state.head, vec3(0.1, -0.1, -0.1));

/** A release that hits the middle of a target, or `miss` [m] beside it. */
function shotAt(state: ArcheryState, target: number, miss = vec3(0, 0, 0), draw = 0.5): ArcheryAction {
  const nock = nockOf(state);
  const direction = releaseTowards(add(state.targets[target]!.centre, miss), nock, draw)!;
  return { type: 'release', position: addScaled(nock, direction, arrowLength), direction, draw, delay: 0 };
}

/** Past everything, into the net. */
const wideOf = (state: ArcheryState): ArcheryAction => shotAt(state, 0, vec3(0, 0.8, 0));

/** Up into the sky: 9 s of flight. */
function highShot(state: ArcheryState): ArcheryAction {
  const direction = normalise(vec3(0, 1, -0.05));
  const position = addScaled(nockOf(state), direction, arrowLength);
  return { type: 'release', position, direction, draw: 0.6, delay: 0 };
}

/** Every number somewhere in a state. */
const numbersIn = (value: unknown): number[] =>
  typeof value === 'number'
    ? [value]
    : typeof value === 'object' && value !== null
      ? Object.values(value).flatMap(numbersIn)
      : [];

/** A match told tick by tick. */
function told(first: ArcheryState) {
  const events: ArcheryEvent[] = [];
  let state = first;
  const step = (...actions: ArcheryAction[]) => {
    const done = archeryRules.step(state, actions);
    state = done.state;
    events.push(...done.events);
  };
  const pass = (seconds: number) => {
    for (let i = 0; i < Math.round(seconds / tickSeconds); i++) step();
  };
  return {
    get state() {
      return state;
    },
    events,
    step,
    pass,
    shoot(target: number) {
      step(shotAt(state, target));
      pass(1);
    },
    happened: <T extends ArcheryEvent['type']>(type: T) =>
      events.filter((event): event is Extract<ArcheryEvent, { type: T }> => event.type === type),
  };
}

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

  test('of two arrows that land in one tick, the first to land comes first, whichever was shot first', () => {
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

  test('and where the signal alone starts it, no arrow flies before', () => {
    const match = told(start({ startedBy: 'signal' }));
    match.step(shotAt(match.state, 1));
    match.pass(100);
    expect(match.state).toMatchObject({ phase: 'ready', tick: 0, arrowsLeft: 5, arrows: [] });
    match.step({ type: 'start' }, shotAt(match.state, 1));
    expect(match.state).toMatchObject({ phase: 'running', arrowsLeft: 4 });
  });

  test('or until the first release', () => {
    const match = told(start());
    match.pass(3);
    match.step(shotAt(match.state, 1));
    expect(match.state).toMatchObject({ phase: 'running', tick: 1, arrowsLeft: 4 });
    expect(match.state.arrows[0]!.release.time).toBe(0);
  });
});

describe('what no archer can do', () => {
  const shot = (state: ArcheryState) => shotAt(state, 1) as Extract<ArcheryAction, { type: 'release' }>;
  const far = addScaled(vec3(0, 1.6, 0), vec3(0, 0, -1), 3);

  test.each<[string, (state: ArcheryState) => ArcheryAction]>([
    ['a position that is no number', (s) => ({ ...shot(s), position: vec3(Number.NaN, 1, 0) })],
    ['an endless direction', (s) => ({ ...shot(s), direction: vec3(0, 0, Number.NEGATIVE_INFINITY) })],
    ['a direction that makes arrows faster', (s) => ({ ...shot(s), direction: vec3(0, 0, -3) })],
    ['no direction', (s) => ({ ...shot(s), direction: vec3(0, 0, 0) })],
    ['a draw that is no number', (s) => ({ ...shot(s), draw: Number.NaN })],
    ['an endless draw', (s) => ({ ...shot(s), draw: Number.POSITIVE_INFINITY })],
    ['a draw too short to shoot', (s) => ({ ...shot(s), draw: minimumDraw - 0.01 })],
    ['a push', (s) => ({ ...shot(s), draw: -0.5 })],
    ['a delay before the tick', (s) => ({ ...shot(s), delay: -0.001 })],
    ['a delay beyond the tick', (s) => ({ ...shot(s), delay: tickSeconds })],
    ['a delay that is no number', (s) => ({ ...shot(s), delay: Number.NaN })],
    ['a release far from the head', (s) => ({ ...shot(s), position: far })],
  ])('%s shoots nothing', (_, action) => {
    const match = told(start());
    match.step({ type: 'start' }, action(match.state));
    expect(match.state).toMatchObject({ arrowsLeft: 5, arrows: [] });
    expect(match.happened('released')).toEqual([]);
  });

  test('a draw beyond the bow shoots as fast as the bow can', () => {
    const match = told(start());
    match.step({ ...shot(match.state), draw: 3 });
    expect(length(match.state.arrows[0]!.release.velocity)).toBeCloseTo(75.894 * maximumDraw, 2);
  });

  test('arrows follow each other at half a second at the earliest', () => {
    const match = told(start());
    match.step(shot(match.state), shot(match.state));
    match.pass(releaseInterval - 3 * tickSeconds);
    match.step(shot(match.state));
    expect(match.state.arrowsLeft).toBe(4);
    match.pass(3 * tickSeconds);
    match.step(shot(match.state));
    expect(match.state.arrowsLeft).toBe(3);
  });

  test('a sixth arrow', () => {
    const match = told(start());
    for (let i = 0; i < 4; i++) match.shoot(0);
    // The fifth is shot so high that it still flies.
    match.step(highShot(match.state));
    match.pass(1);
    match.step(shotAt(match.state, 1));
    expect(match.state.arrows).toHaveLength(5);
    expect(match.state.phase).toBe('running');
  });

  test('moves with the head: the same hand is in reach when the head is there', () => {
    const match = told(start());
    const there: ArcheryAction = { ...shot(match.state), position: addScaled(far, vec3(0, 0, -1), arrowLength) };
    match.step({ type: 'stand', head: far }, { ...there, direction: vec3(0, 0, -1) });
    expect(match.state.arrowsLeft).toBe(4);
  });

  test('nothing that is sent breaks the state', () => {
    const wild = fc.oneof(fc.double(), fc.constantFrom(Number.NaN, Number.POSITIVE_INFINITY, -1e308, 0, 1));
    const anywhere = fc.record({ x: wild, y: wild, z: wild });
    const action: fc.Arbitrary<ArcheryAction> = fc.oneof(
      fc.constant({ type: 'start' } as const),
      fc.record({ type: fc.constant('stand' as const), head: anywhere }),
      fc.record({
        type: fc.constant('release' as const),
        position: anywhere,
        direction: anywhere,
        draw: wild,
        delay: wild,
      }),
    );
    fc.assert(
      fc.property(fc.array(fc.array(action, { maxLength: 4 }), { maxLength: 60 }), (ticks) => {
        let state = start();
        for (const actions of ticks) {
          state = archeryRules.step(state, actions).state;
          for (const value of numbersIn(state)) expect(Number.isFinite(value)).toBe(true);
          expect(state.arrowsLeft).toBe(5 - state.arrows.length);
        }
      }),
      { seed, numRuns: 200 },
    );
  });
});

describe('the zone', () => {
  const at = (x: number, z: number): ArcheryAction => ({ type: 'stand', head: vec3(x, 1.6, z) });

  test('is 1.10 m wide and 1.00 m deep, and says when it is left and entered', () => {
    const match = told(start());
    match.step(at(0.549, 0.499));
    expect(match.state.inZone).toBe(true);
    match.step(at(0.551, 0));
    expect(match.state.inZone).toBe(false);
    match.step(at(0, 0));
    match.step(at(0, -0.501));
    expect(match.events.map(({ type }) => type)).toEqual(['left-zone', 'entered-zone', 'left-zone']);
  });

  test('does not flicker at its edge', () => {
    const match = told(start());
    for (let i = 0; i < 50; i++) match.step(at(0.55 + (i % 2 ? 0.005 : -0.005), 0));
    expect(match.events.map(({ type }) => type)).toEqual(['left-zone']);
  });

  test('warns before and after the round too, and ignores heads that are nowhere', () => {
    const match = told(start());
    match.step({ type: 'stand', head: vec3(Number.NaN, 0, 0) }, at(60, 0));
    expect(match.state).toMatchObject({ inZone: true, head: vec3(0, 1.6, 0) });
    match.step(at(2, 0));
    expect(match.happened('left-zone')).toHaveLength(1);
    expect(match.state.phase).toBe('ready');
  });
});

/** Ticks of an archer who moves about and shoots now and then, mostly well. */
const playing = fc.array(
  fc.record({
    idle: fc.integer({ min: 20, max: 200 }),
    target: fc.integer({ min: 0, max: 3 }),
    miss: fc.record({ x: evenly(-0.7, 0.7), y: evenly(-0.7, 0.7), z: fc.constant(0) }),
    draw: evenly(0.3, maximumDraw),
    delay: evenly(0, tickSeconds * 0.999),
    head: fc.record({ x: evenly(-0.7, 0.7), y: evenly(1.2, 1.8), z: evenly(-0.6, 0.6) }),
  }),
  { minLength: 1, maxLength: 8 },
);

describe('a recorded match', () => {
  test('replays to the same state, by way of JSON and from any tick on', () => {
    fc.assert(
      fc.property(fc.integer(), playing, evenly(0, 1), (matchSeed, moves, cut) => {
        const first = start({ seconds: 12 }, matchSeed);
        const ticks: ArcheryAction[][] = [];
        const states: ArcheryState[] = [first];
        const step = (...actions: ArcheryAction[]) => {
          ticks.push(actions);
          states.push(archeryRules.step(states.at(-1)!, actions).state);
        };
        step({ type: 'start' });
        for (const { idle, target, miss, draw, delay, head } of moves) {
          step({ type: 'stand', head });
          step(delayed(shotAt(states.at(-1)!, target, miss, draw), delay));
          for (let i = 0; i < idle; i++) step();
        }
        const middle = Math.floor(cut * ticks.length);
        let replayed = JSON.parse(JSON.stringify(states[middle])) as ArcheryState;
        for (const actions of JSON.parse(JSON.stringify(ticks.slice(middle))) as ArcheryAction[][]) {
          replayed = archeryRules.step(replayed, actions).state;
        }
        expect(JSON.stringify(replayed)).toBe(JSON.stringify(states.at(-1)));
      }),
      { seed, numRuns: 40 },
    );
  });

  test('never changes a state once it is made', () => {
    const freeze = <T>(value: T): T => {
      if (typeof value === 'object' && value !== null)
        for (const part of Object.values(freezeShallow(value))) freeze(part);
      return value;
    };
    const freezeShallow = <T extends object>(value: T): T => Object.freeze(value);
    let state = freeze(start());
    for (let i = 0; i < 300; i++) {
      const actions = i % 60 === 0 ? [shotAt(state, (i / 60) % 4)] : [];
      state = freeze(archeryRules.step(state, freeze(actions)).state);
    }
    expect(state.score).toBe(50);
  });

  test('lands its arrows in the same places at 72, 80, 90 and 120 Hz, dropped frames or not', () => {
    const play = (rate: number, dropped: (frame: number) => boolean) => {
      const match = createMatch(archeryRules, start({}, 11), { delayed });
      const wanted = [0.4, 1.4, 2.5, 3.7].map((time, target) => ({ time, target }));
      for (let i = 0; i < 6 * rate; i++) {
        if (dropped(i)) continue;
        const due = wanted.filter(({ time }) => time <= i / rate);
        wanted.splice(0, due.length);
        match.advance(100 + i / rate, [
          { type: 'stand', head: vec3(0, 1.6, 0) },
          ...due.map(({ target }) => shotAt(match.state, target, vec3(0.1, -0.2, 0))),
        ]);
      }
      expect(match.state.score).toBe(50);
      return match.state.arrows;
    };
    const at90 = play(90, () => false);
    for (const rate of [72, 80, 90, 120]) {
      for (const arrows of [play(rate, () => false), play(rate, (i) => (i * 7) % 10 < 3)]) {
        arrows.forEach((arrow, i) => {
          expect(distance(arrow.landing!.position, at90[i]!.landing!.position)).toBeLessThan(1e-3);
          expect(arrow.landing!.time - arrow.release.time).toBeCloseTo(
            at90[i]!.landing!.time - at90[i]!.release.time,
            9,
          );
        });
      }
    }
  });
});
