import type { Side } from '../../math/side';
import { addScaled, distance, isFiniteVec3, length, type Vec3, vec3 } from '../../math/vec3';
import { fistOf } from '../fist';
import type { GameRules } from '../game-rules';
import type {
  BallAction,
  BallDeed,
  BallEnd,
  BallEvent,
  BallOptions,
  BallPlace,
  BallPlayer,
  BallState,
  Basket,
  Refusal,
  TimedLaunch,
} from './ball-state';
import { basketInHands } from './basket';
import { ballInAir, ballOnFloor, ballRadius, basketRadius, floorBounceOf, meetsBasket, touchesFloor } from './flight';
import { holderStation, rackPosition, stations, zoneRadius } from './stations';

/** The paper's game: 20 balls, 90 s. */
export const defaultBallOptions: BallOptions = { balls: 20, seconds: 90, rotation: 0 };

/** No hand throws a ball faster [m/s]; a professional's baseball does 45, an arm with a controller 15. */
export const fastestThrow = 20;
/** What leaves the hand more slowly [m/s] is let go of, not thrown: it goes back to the rack. */
export const slowestThrow = 0.8;
/** A fist takes a ball from this far [m]; clients ask for less. */
export const grabReach = 0.35;
/** A hand is at most this far from its head [m]. */
export const armReach = 1.4;
/** A ball leaves the hand at most this far from where the hand was last [m]: at 10 m/s it goes that far in 70 ms. */
export const releaseReach = 0.7;
/** What happened longer ago than this [s] happened now minus this. */
export const longestDelay = 0.5;
/** The holder's hands are waited for this long [s]; then the basket stands where it was. */
export const basketPatience = 0.25;
/** A basket faster than this [m/s] has jumped: nothing is caught on the way. */
const fastestBasket = 12;

const tickSeconds = 1 / 60;

const round = (value: number): number => Math.round(value * 1e4) / 1e4;
const rounded = ({ x, y, z }: Vec3): Vec3 => vec3(round(x), round(y), round(z));
const roundedLaunch = ({ time, position, velocity }: TimedLaunch): TimedLaunch => ({
  time: round(time),
  position: rounded(position),
  velocity: rounded(velocity),
});

/** Seconds of the match at the state's tick. */
export const ballMatchTime = (state: BallState): number => state.tick * tickSeconds;

/** Seconds until the bell: all of them before the start, 0 when it has rung. */
export const ballSecondsLeft = (state: BallState): number =>
  state.startedAt === null
    ? state.options.seconds
    : Math.max(0, state.options.seconds - (ballMatchTime(state) - state.startedAt));

/** Balls that may still be caught. */
export const ballsLeft = ({ balls }: BallState): number => balls.filter(isOpen).length;

const isOpen = (place: BallPlace): boolean =>
  place.on === 'rack' || place.on === 'hand' || (place.on === 'air' && !place.missed);

function checkedOptions(options: Partial<BallOptions>): BallOptions {
  const { balls, seconds, rotation } = { ...defaultBallOptions, ...options };
  if (!(Number.isInteger(balls) && balls >= 1 && balls <= 20)) {
    throw new Error(`ball game: balls must be 1 to 20, is ${balls}`);
  }
  if (!(seconds > 0 && seconds <= 3600)) throw new Error(`ball game: seconds must be above 0, is ${seconds}`);
  if (!Number.isInteger(rotation)) throw new Error(`ball game: rotation must be a whole number, is ${rotation}`);
  return { balls, seconds, rotation };
}

/** A basket before anybody holds it. */
const restingBasket: Basket = {
  at: 0,
  position: rounded({ ...addScaled(stations[holderStation]!.position, vec3(0, 0, 1), 0.4), y: 1.1 }),
  normal: vec3(0, 1, 0),
};

type Step = { readonly state: BallState; readonly events: readonly BallEvent[] };

const unchanged = (state: BallState): Step => ({ state, events: [] });

const withPlayer = (state: BallState, index: number, change: Partial<BallPlayer>): BallState => ({
  ...state,
  players: state.players.map((player, i) => (i === index ? { ...player, ...change } : player)),
});

const withBall = (state: BallState, ball: number, place: BallPlace): BallState => ({
  ...state,
  balls: state.balls.map((other, i) => (i === ball ? place : other)),
});

/** The ball in somebody's hand; −1: none. */
export const ballInHand = ({ balls }: BallState, player: number, side: Side): number =>
  balls.findIndex((place) => place.on === 'hand' && place.player === player && place.side === side);

/** Everything this player (or anybody) holds goes back to its rack. */
function returnHeld(state: BallState, player: number | null): Step {
  let next = state;
  const events: BallEvent[] = [];
  state.balls.forEach((place, ball) => {
    if (place.on !== 'hand' || (player !== null && place.player !== player)) return;
    next = withBall(next, ball, { on: 'rack' });
    events.push({ type: 'returned', ball, player: place.player });
  });
  return { state: next, events };
}

const forgotten = { head: null, left: null, right: null } as const;

function join(state: BallState, index: number): Step {
  if (state.players[index]!.present) return unchanged(state);
  // A new face counts its deeds from 1 again.
  const change = { present: true, ready: false, at: -1, ...forgotten, sequence: 0, seen: 0 };
  return { state: withPlayer(state, index, change), events: [{ type: 'joined', player: index }] };
}

function leave(state: BallState, index: number): Step {
  if (!state.players[index]!.present) return unchanged(state);
  const returned = returnHeld(state, index);
  return {
    state: withPlayer(returned.state, index, { present: false, ready: false, ...forgotten }),
    events: [...returned.events, { type: 'left', player: index }],
  };
}

/** Before the clock stops: what is held goes back, for hands do not stop; flights go on where they were. */
function pause(state: BallState): Step {
  const returned = returnHeld(state, null);
  const players = returned.state.players.map((player) => ({ ...player, ...forgotten }));
  return { state: { ...returned.state, players }, events: returned.events };
}

function setReady(state: BallState, index: number, ready: boolean): Step {
  const player = state.players[index]!;
  if (!player.present || player.ready === ready || state.phase === 'running') return unchanged(state);
  return { state: withPlayer(state, index, { ready }), events: [{ type: 'ready', player: index, ready }] };
}

/** Everybody who is there is ready, a thrower and the holder among them. */
function canStart({ players, phase }: BallState): boolean {
  const there = players.filter(({ present }) => present);
  return (
    phase === 'ready' &&
    there.every(({ ready }) => ready) &&
    there.some(({ role }) => role === 'thrower') &&
    there.some(({ role }) => role === 'holder')
  );
}

const inZone = (head: Vec3, station: number): boolean => {
  const { x, z } = stations[station]!.position;
  return Math.hypot(head.x - x, head.z - z) <= zoneRadius;
};

/** Where a player is now. The holder's hands move the basket, and what it meets on the way is decided. */
function pose(state: BallState, action: Extract<BallAction, { type: 'pose' }>): Step {
  const player = state.players[action.player]!;
  const now = ballMatchTime(state) + tickSeconds;
  if (!player.present || !isFiniteVec3(action.head) || !Number.isFinite(action.at) || length(action.head) > 50) {
    return unchanged(state);
  }
  const at = round(Math.min(Math.max(action.at, now - longestDelay), now));
  if (at < player.at) return unchanged(state);
  const reachable = (hand: typeof action.left) => {
    if (!hand) return null;
    const fist = fistOf(hand);
    const { x, y, z, w } = hand.orientation;
    return isFiniteVec3(fist) && Number.isFinite(x + y + z + w) && distance(fist, action.head) <= armReach
      ? hand
      : null;
  };
  const left = reachable(action.left);
  const right = reachable(action.right);
  const moved = withPlayer(state, action.player, {
    at,
    head: rounded(action.head),
    left: left && rounded(fistOf(left)),
    right: right && rounded(fistOf(right)),
  });
  if (player.role !== 'holder') return { state: moved, events: [] };
  const opening = inZone(action.head, player.station) ? basketInHands(left, right) : null;
  if (!opening) return { state: moved, events: [] };
  const held = { position: rounded(opening.position), normal: rounded(opening.normal) };
  const before = moved.basket;
  // A pose from before what is decided moves the basket, but not the past.
  if (at <= before.at) return { state: { ...moved, basket: { ...held, at: before.at } }, events: [] };
  const jumped = distance(held.position, before.position) > fastestBasket * (at - before.at);
  const from = jumped ? { ...held, at: before.at } : before;
  return decide({ ...moved, basket: from }, { ...held, at });
}

/** Follows every ball in the air while the basket moves from where it is to `to`. */
function decide(state: BallState, to: Basket): Step {
  const from = state.basket;
  let next: BallState = { ...state, basket: to };
  const events: BallEvent[] = [];
  state.balls.forEach((first, ball) => {
    let place = first;
    while (place.on === 'air') {
      const { thrower, launch } = place;
      const meeting = place.missed ? null : meetsBasket(launch, from, to);
      if (meeting?.kind === 'caught') {
        place = { on: 'basket', thrower };
        next = { ...next, score: next.score + 1 };
        events.push({ type: 'caught', ball, player: thrower, at: round(meeting.time), score: next.score });
      } else if (meeting) {
        const bounced = settled(roundedLaunch(meeting.launch), launch);
        place = { ...place, launch: bounced };
        events.push({ type: 'bounced', ball, off: 'basket', launch: bounced });
      } else {
        const time = touchesFloor(launch);
        if (time > to.at) break;
        const { launch: after, rolls } = floorBounceOf(launch, Math.max(time, launch.time));
        const bounced = settled(roundedLaunch(after), launch);
        if (!place.missed) events.push({ type: 'missed', ball, player: thrower });
        place = rolls
          ? { on: 'floor', launch: bounced, thrower }
          : { on: 'air', launch: bounced, thrower, missed: true };
        events.push(
          rolls ? { type: 'rolls', ball, launch: bounced } : { type: 'bounced', ball, off: 'floor', launch: bounced },
        );
      }
    }
    if (place !== first) next = withBall(next, ball, place);
  });
  return { state: next, events };
}

/** A bounce is never earlier than the flight before it, whatever the rounding, and each takes a little time. */
const settled = (bounce: TimedLaunch, flight: TimedLaunch): TimedLaunch =>
  bounce.time > flight.time ? bounce : { ...bounce, time: round(flight.time + 1e-4) };

/** Whether this number is new; and the memory of it. */
function countOnce({ sequence, seen }: BallPlayer, number: number): { sequence: number; seen: number } | null {
  if (!(Number.isInteger(number) && number > 0 && number < 2 ** 31)) return null;
  if (number > sequence) {
    const shift = number - sequence;
    return { sequence: number, seen: ((shift < 31 ? seen << shift : 0) | 1) & 0x7fffffff };
  }
  const age = sequence - number;
  if (age >= 31 || (seen >> age) & 1) return null;
  return { sequence, seen: seen | (1 << age) };
}

/** What the deed does, or why it does nothing. */
function deedOf(state: BallState, index: number, deed: BallDeed): Step | Refusal {
  const player = state.players[index]!;
  const fist = player[deed.side];
  if (state.phase !== 'running' || state.startedAt === null) return 'phase';
  if (player.role !== 'thrower') return 'role';
  const bell = state.startedAt + state.options.seconds;
  if (deed.type === 'grab') {
    const place = state.balls[deed.ball];
    if (!place) return 'no-such-ball';
    if (place.on !== 'rack') return 'taken';
    if (ballInHand(state, index, deed.side) >= 0) return 'hand-full';
    if (!fist || distance(fist, rackPosition(deed.ball, state.options.balls)) > grabReach) return 'reach';
    if (ballMatchTime(state) >= bell) return 'time';
    return {
      state: withBall(state, deed.ball, { on: 'hand', player: index, side: deed.side }),
      events: [{ type: 'grabbed', ball: deed.ball, player: index, side: deed.side }],
    };
  }
  const ball = ballInHand(state, index, deed.side);
  if (ball < 0) return 'not-held';
  const back: Step = {
    state: withBall(state, ball, { on: 'rack' }),
    events: [{ type: 'returned', ball, player: index }],
  };
  if (deed.type === 'drop') return back;
  if (ball !== deed.ball) return 'not-held';
  const { position, velocity } = deed;
  if (!isFiniteVec3(position) || !isFiniteVec3(velocity) || !Number.isFinite(deed.at)) return 'speed';
  const speed = length(velocity);
  if (speed > fastestThrow) return 'speed';
  if (!player.head || !inZone(player.head, player.station)) return 'zone';
  if (distance(position, player.head) > armReach) return 'reach';
  if (fist && distance(position, fist) > releaseReach) return 'reach';
  const now = ballMatchTime(state) + tickSeconds;
  const time = Math.min(Math.max(deed.at, now - longestDelay, state.startedAt), now);
  if (time >= bell) return 'time';
  if (speed < slowestThrow) return back;
  const launch = roundedLaunch({ time, position: { ...position, y: Math.max(position.y, ballRadius) }, velocity });
  return {
    state: withBall(state, ball, { on: 'air', launch, thrower: index, missed: false }),
    events: [{ type: 'thrown', ball, player: index, launch }],
  };
}

function act(state: BallState, action: BallAction): Step {
  if (action.type === 'pause') return pause(state);
  const player = state.players[action.player];
  if (!player) return unchanged(state);
  switch (action.type) {
    case 'join':
      return join(state, action.player);
    case 'leave':
      return leave(state, action.player);
    case 'ready':
      return setReady(state, action.player, action.ready);
    case 'silent':
      return { state: withPlayer(state, action.player, forgotten), events: [] };
    case 'pose':
      return pose(state, action);
    case 'grab':
    case 'drop':
    case 'throw': {
      const refused = (after: BallState, reason: Refusal): Step => ({
        state: after,
        events: [{ type: 'refused', player: action.player, sequence: action.sequence, reason }],
      });
      if (!player.present) return refused(state, 'absent');
      const counted = countOnce(player, action.sequence);
      if (!counted) return refused(state, 'seen-before');
      const remembered = withPlayer(state, action.player, counted);
      const done = deedOf(remembered, action.player, action);
      return typeof done === 'string' ? refused(remembered, done) : done;
    }
    default:
      return unchanged(state);
  }
}

/** Why the round is over; null: it goes on. While a ball is in the air that may be caught, it does. */
function roundEnd(state: BallState): BallEnd | null {
  const flying = state.balls.some((place) => place.on === 'air' && !place.missed);
  if (flying) return null;
  if (ballsLeft(state) === 0) return 'balls';
  return ballSecondsLeft(state) <= 0 ? 'time' : null;
}

/**
 * Three players, two throwers and a basket holder 5 m away, a point for every catch (the paper's section 5.3). Tick 1/60 s, arena
 * frame. What the players do carries its own time: a flight and the basket are compared as the holder saw them, however late
 * either arrives.
 */
export const ballRules: GameRules<BallState, BallAction, BallEvent, BallOptions> = {
  tickSeconds,

  start(players, seed, options = {}) {
    const checked = checkedOptions(options);
    if (players.length !== stations.length) {
      throw new Error(`ball game: it takes ${stations.length} players, not ${players.length}`);
    }
    return {
      options: checked,
      random: { seed },
      tick: 0,
      phase: 'ready',
      startedAt: null,
      end: null,
      score: 0,
      players: players.map((id, index): BallPlayer => {
        const count = stations.length;
        const station = (((index + checked.rotation) % count) + count) % count;
        return {
          id,
          role: station === holderStation ? 'holder' : 'thrower',
          station,
          present: false,
          ready: false,
          at: -1,
          head: null,
          left: null,
          right: null,
          sequence: 0,
          seen: 0,
        };
      }),
      balls: Array.from({ length: checked.balls }, () => ({ on: 'rack' as const })),
      basket: restingBasket,
    };
  },

  step(state, actions) {
    let next = state;
    const events: BallEvent[] = [];
    const take = (done: Step) => {
      next = done.state;
      events.push(...done.events);
    };
    for (const action of actions) take(act(next, action));
    if (canStart(next)) {
      const startedAt = round(ballMatchTime(next));
      next = { ...next, phase: 'running', startedAt };
      events.push({ type: 'started', at: startedAt });
    }
    const decided = round(ballMatchTime(next) + tickSeconds - basketPatience);
    if (next.basket.at < decided) take(decide(next, { ...next.basket, at: decided }));
    next = { ...next, tick: next.tick + 1 };
    if (next.phase === 'running') {
      if (ballSecondsLeft(next) <= 0) take(returnHeld(next, null));
      const end = roundEnd(next);
      if (end) {
        next = { ...next, phase: 'over', end, players: next.players.map((player) => ({ ...player, ready: false })) };
        events.push({ type: 'ended', end, score: next.score });
      }
    }
    return { state: next, events };
  },
};

/** Where a ball is drawn at a time [s of the match]; in a hand: null, it goes with the hand; in the basket: at its bottom. */
export function ballPosition(state: BallState, ball: number, time: number): Vec3 | null {
  const place = state.balls[ball];
  switch (place?.on) {
    case 'rack':
      return rackPosition(ball, state.options.balls);
    case 'air': {
      const position = ballInAir(place.launch, time);
      return position.y >= ballRadius ? position : { ...position, y: ballRadius };
    }
    case 'floor':
      return ballOnFloor(place.launch, time);
    case 'basket':
      return addScaled(state.basket.position, state.basket.normal, -basketRadius);
    default:
      return null;
  }
}
