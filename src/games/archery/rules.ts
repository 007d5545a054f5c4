import {
  addScaled,
  clamp,
  createRandom,
  distance,
  isFiniteVec3,
  length,
  normalise,
  scale,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { positionAt, velocityAt } from '../ballistics';
import type { GameRules } from '../game-rules';
import type {
  ArcheryAction,
  ArcheryEvent,
  ArcheryOptions,
  ArcheryState,
  Arrow,
  Landing,
  RoundEnd,
  Target,
} from './archery-state';
import { arrowLength, arrowSpeed, minimumDraw } from './bow';
import { firstHit, type Wall } from './flight';

/** The archer's zone: a rectangle on the floor about the origin [m]. */
export const zone = { width: 1.1, depth: 1 } as const;

/** A head re-enters the zone this far inside the edge [m]. */
const zoneMargin = 0.02;

/** The nets around the range, 5 m high. An arrow that flies over them lands outside. */
export const walls: readonly Wall[] = [
  { axis: 'z', at: -14, inward: 1, height: 5 },
  { axis: 'z', at: 4, inward: -1, height: 5 },
  { axis: 'x', at: -6, inward: 1, height: 5 },
  { axis: 'x', at: 6, inward: -1, height: 5 },
];

/** Radius of every target [m]. */
const targetRadius = 0.45;

const radians = (degrees: number): number => (degrees * Math.PI) / 180;

/**
 * The layout of the range. Bearing: from −Z to the right, seen from the origin. Elevation: that of the centre, seen by
 * eyes above the origin. With these bearings every target is visible from everywhere in the zone.
 */
const layout = [
  { distance: 4.5, points: 5, bearing: radians(-25), elevation: radians(-4.5) },
  { distance: 6.5, points: 10, bearing: radians(18), elevation: radians(-2.5) },
  { distance: 8.5, points: 15, bearing: radians(-8), elevation: radians(-1.2) },
  { distance: 10.5, points: 20, bearing: radians(5), elevation: radians(-0.3) },
] as const;

/** The most by which a match's bearings differ from the layout [rad]; left and right may also be swapped. */
const bearingSpread = radians(1.5);

/** The least clearance of a target above the ground [m]. */
const groundClearance = 0.1;

/** The largest distance of a nock from the head [m]. */
export const reach = 1.2;

/** The largest distance of a head from the origin [m]. */
const farthestHead = 50;

/** The shortest interval between two releases [s]. */
export const releaseInterval = 0.5;

/** The paper's game: five arrows, 70 s, every target once. */
const defaultArcheryOptions: ArcheryOptions = {
  arrows: 5,
  seconds: 70,
  everyHitCounts: false,
  startedBy: 'arrow',
  eyeHeight: 1.6,
};

/** Limits of the eye height by which targets are placed [m]; it is clamped to them. */
const eyeHeightLimits = { min: 0.6, max: 2.4 } as const;

function placeTargets(eyeHeight: number, seed: number): Target[] {
  const chance = createRandom(seed);
  const mirrored = chance() < 0.5 ? -1 : 1;
  const eyes = vec3(0, eyeHeight, 0);
  return layout.map((place): Target => {
    const bearing = mirrored * place.bearing + (2 * chance() - 1) * bearingSpread;
    const centre = vec3(
      place.distance * Math.sin(bearing),
      Math.max(eyeHeight + place.distance * Math.tan(place.elevation), targetRadius + groundClearance),
      -place.distance * Math.cos(bearing),
    );
    return {
      centre,
      normal: normalise(subtract(eyes, centre)),
      radius: targetRadius,
      distance: place.distance,
      points: place.points,
    };
  });
}

function checkedOptions(options: Partial<ArcheryOptions>): ArcheryOptions {
  const { arrows, seconds, everyHitCounts, startedBy, eyeHeight } = { ...defaultArcheryOptions, ...options };
  if (!(Number.isInteger(arrows) && arrows > 0)) throw new Error(`archery: arrows must be 1 or more, is ${arrows}`);
  if (!(seconds > 0 && Number.isFinite(seconds))) throw new Error(`archery: seconds must be above 0, is ${seconds}`);
  if (!Number.isFinite(eyeHeight)) throw new Error(`archery: eyeHeight must be a height in metres, is ${eyeHeight}`);
  return {
    arrows,
    seconds,
    everyHitCounts,
    startedBy,
    eyeHeight: clamp(eyeHeight, eyeHeightLimits.min, eyeHeightLimits.max),
  };
}

const tickSeconds = 1 / 90;

/** Returns the time of the match [s]. */
export const matchTime = (state: ArcheryState): number => state.tick * tickSeconds;

/** Returns when the last arrow landed [s]. */
const lastLanding = ({ arrows }: ArcheryState): number =>
  Math.max(0, ...arrows.map(({ landing }) => landing?.time ?? 0));

/** Returns the seconds until the bell, 0 after it; for a finished round, those left at its end. */
export function secondsLeft(state: ArcheryState): number {
  if (state.phase === 'over' && state.end === 'time') return 0;
  return Math.max(0, state.options.seconds - (state.phase === 'over' ? lastLanding(state) : matchTime(state)));
}

/** Returns the highest possible score: all targets, or with `everyHitCounts` the best one with every arrow. */
export function fullScore({ options, targets }: ArcheryState): number {
  let sum = 0;
  let best = 0;
  for (const { points } of targets) {
    sum += points;
    best = Math.max(best, points);
  }
  return options.everyHitCounts ? options.arrows * best : sum;
}

/** Returns whether there is an arrow to nock: one is left, and the bell has not rung. */
export const isArmed = (state: ArcheryState): boolean =>
  state.phase !== 'over' && state.arrowsLeft > 0 && matchTime(state) < state.options.seconds;

const isAbove = ({ x, z }: Vec3, margin: number): boolean =>
  Math.abs(x) <= zone.width / 2 - margin && Math.abs(z) <= zone.depth / 2 - margin;

/** Returns the action with its delay in the tick [s], which only releases use. */
export const delayed = (action: ArcheryAction, delay: number): ArcheryAction =>
  action.type === 'release' ? { ...action, delay } : action;

type Step = { readonly state: ArcheryState; readonly events: readonly ArcheryEvent[] };

const nothing = (state: ArcheryState): Step => ({ state, events: [] });

function begin(state: ArcheryState): Step {
  if (state.phase !== 'ready') return nothing(state);
  return { state: { ...state, phase: 'running' }, events: [{ type: 'started' }] };
}

function stand(state: ArcheryState, head: Vec3): Step {
  if (!(isFiniteVec3(head) && length(head) <= farthestHead)) return nothing(state);
  const inZone = isAbove(head, state.inZone ? 0 : zoneMargin);
  return {
    state: { ...state, head, inZone },
    events: inZone === state.inZone ? [] : [{ type: inZone ? 'entered-zone' : 'left-zone' }],
  };
}

/** Shoots, and starts a match that is ready. An impossible release changes nothing. */
function release(state: ArcheryState, action: Extract<ArcheryAction, { type: 'release' }>): Step {
  const { position, direction, draw, delay } = action;
  const possible =
    isFiniteVec3(position) &&
    isFiniteVec3(direction) &&
    Math.abs(length(direction) - 1) < 1e-3 &&
    Number.isFinite(draw) &&
    draw >= minimumDraw &&
    delay >= 0 &&
    delay < tickSeconds;
  if (!possible || state.phase === 'over' || state.arrowsLeft === 0) return nothing(state);
  if (state.phase === 'ready' && state.options.startedBy === 'signal') return nothing(state);
  const along = normalise(direction);
  if (!(distance(addScaled(position, along, -arrowLength), state.head) <= reach)) return nothing(state);
  const time = matchTime(state) + delay;
  const last = state.arrows.at(-1);
  if (time >= state.options.seconds || (last && time - last.release.time < releaseInterval)) return nothing(state);

  const begun = begin(state);
  const arrow: Arrow = {
    id: state.arrows.length,
    release: { time, position, velocity: scale(along, arrowSpeed(draw)) },
    landing: null,
  };
  return {
    state: { ...begun.state, arrowsLeft: state.arrowsLeft - 1, arrows: [...state.arrows, arrow] },
    events: [...begun.events, { type: 'released', arrow }],
  };
}

function act(state: ArcheryState, action: ArcheryAction): Step {
  switch (action.type) {
    case 'start':
      return begin(state);
    case 'stand':
      return stand(state, action.head);
    case 'release':
      return release(state, action);
    default:
      return nothing(state);
  }
}

const hasScored = (state: ArcheryState, target: number): boolean =>
  state.arrows.some(({ landing }) => landing?.target === target);

/** Lands the arrows that come down before `time` [s], in order. */
function land(state: ArcheryState, time: number): Step {
  const due = state.arrows
    .filter(({ landing }) => landing === null)
    .map((arrow) => {
      const hit = firstHit(arrow.release, state.targets, walls);
      return { arrow, hit, time: arrow.release.time + hit.after };
    })
    .filter((flight) => flight.time < time)
    .sort((a, b) => a.time - b.time);

  let next = state;
  const events: ArcheryEvent[] = [];
  for (const { arrow, hit, time: landed } of due) {
    const target = hit.target === null ? undefined : next.targets[hit.target];
    const counts = target && (state.options.everyHitCounts || !hasScored(next, hit.target ?? -1));
    const landing: Landing = {
      time: landed,
      position: positionAt(arrow.release, hit.after),
      direction: normalise(velocityAt(arrow.release, hit.after)),
      on: hit.on,
      target: hit.target,
      points: counts ? target.points : 0,
    };
    const stuck: Arrow = { ...arrow, landing };
    next = {
      ...next,
      score: next.score + landing.points,
      arrows: next.arrows.map((other) => (other.id === arrow.id ? stuck : other)),
    };
    events.push({ type: 'landed', arrow: stuck, landing });
  }
  return { state: next, events };
}

/** Returns why the round is over; null: it continues, as it does while an arrow flies. */
function roundEnd(state: ArcheryState, time: number): RoundEnd | null {
  if (state.arrows.some(({ landing }) => landing === null)) return null;
  if (!state.options.everyHitCounts && state.targets.every((_, index) => hasScored(state, index))) return 'targets';
  if (state.arrowsLeft === 0) return 'arrows';
  return time >= state.options.seconds ? 'time' : null;
}

/**
 * The rules of one archer's round (src/games/README.md): four targets, some arrows and a bell. Tick 1/90 s, arena
 * frame. `startedBy` decides what starts the clock. With `everyHitCounts` the round ends only when no arrow is left or
 * the bell rings.
 */
export const archeryRules: GameRules<ArcheryState, ArcheryAction, ArcheryEvent, ArcheryOptions> = {
  tickSeconds,

  start(_players, seed, options = {}) {
    const checked = checkedOptions(options);
    return {
      options: checked,
      tick: 0,
      phase: 'ready',
      end: null,
      score: 0,
      arrowsLeft: checked.arrows,
      targets: placeTargets(checked.eyeHeight, seed),
      arrows: [],
      head: vec3(0, checked.eyeHeight, 0),
      inZone: true,
    };
  },

  step(state, actions) {
    let next = state;
    const events: ArcheryEvent[] = [];
    for (const action of actions) {
      const done = act(next, action);
      next = done.state;
      events.push(...done.events);
    }
    if (next.phase !== 'running') return { state: next, events };

    const time = (next.tick + 1) * tickSeconds;
    const landed = land(next, time);
    next = { ...landed.state, tick: next.tick + 1 };
    events.push(...landed.events);
    const end = roundEnd(next, time);
    if (end) {
      next = { ...next, phase: 'over', end };
      events.push({ type: 'ended', end, score: next.score });
    }
    return { state: next, events };
  },
};

/** How archery is played, a sentence a line. */
export const archeryRulesText: readonly string[] = [
  'Five arrows, four targets from 4.5 to 10.5 m: 5, 10, 15 and 20 points, each target once. 70 seconds from the first arrow.',
  'Hold the bow in one hand. With the other hand press the trigger (or pinch) at the string, draw, and release.',
  'Stay on the deck: only arrows from there count.',
];
