import { distance, isFiniteVec3, length, type MutableVec3, type Vec3, vec3 } from 'threepoint/math';
import { fistOf } from '../fist';
import type { GameRules } from '../game-rules';
import { applyAction, armReach, maxDelay, recordSequence } from './action-rules';
import type { BallEnd, BallEvent, BallInput, BallOptions, BallPlayer, BallState, Basket, Refusal } from './ball-state';
import { basketInHands, makeOpening } from './basket';
import { resolveFlights } from './resolve-flights';
import { round, rounded, type Step, unchanged, withBall, withPlayer } from './state-changes';
import { ballMatchTime, ballSecondsLeft, ballsLeft, tickSeconds } from './state-selectors';
import { holderStation, isInZone, stations } from './stations';

/** The paper's game: 20 balls, 90 s. */
export const defaultBallOptions: BallOptions = { balls: 20, seconds: 90, rotation: 0, everySeat: false };

/** The basket waits for the holder's next pose this long [s]; then it counts as unmoved. */
const basketPatience = 0.25;
/** A basket whose holder was silent for longer than this [s] catches nothing, because nobody holds it. */
const holderSilence = 1;
/** A basket faster than this [m/s] has jumped, and catches nothing on its way. */
const fastestBasket = 12;

function checkedOptions(options: Partial<BallOptions>): BallOptions {
  const { balls, seconds, rotation, everySeat } = { ...defaultBallOptions, ...options };
  if (!(Number.isInteger(balls) && balls >= 1 && balls <= 20)) {
    throw new Error(`ball game: balls must be 1 to 20, is ${balls}`);
  }
  if (!(seconds > 0 && seconds <= 3600)) {
    throw new Error(`ball game: seconds must be between 0 and 3600, is ${seconds}`);
  }
  if (!Number.isInteger(rotation)) throw new Error(`ball game: rotation must be a whole number, is ${rotation}`);
  return { balls, seconds, rotation, everySeat };
}

/** The basket before it is held. */
const restingBasket: Basket = {
  at: 0,
  position: rounded(vec3(stations[holderStation]!.position.x, 1.1, stations[holderStation]!.position.z + 0.4)),
  normal: vec3(0, 1, 0),
};

/** Returns the balls that a player holds to their rack; null: those of all players. */
function returnHeld(state: BallState, player: number | null): Step {
  let next = state;
  const events: BallEvent[] = [];
  for (let ball = 0; ball < state.balls.length; ball++) {
    const location = state.balls[ball]!;
    if (location.on !== 'hand' || (player !== null && location.player !== player)) continue;
    next = withBall(next, ball, { on: 'rack' });
    events.push({ type: 'returned', ball, player: location.player });
  }
  return { state: next, events };
}

const forgotten = { head: null, left: null, right: null } as const;

/** Action numbers start over with another page of the same player. */
const uncounted = { sequence: 0, seen: 0 } as const;

function join(state: BallState, index: number): Step {
  if (state.players[index]!.present) return unchanged(state);
  const change = { present: true, ready: false, at: -1, ...forgotten, ...uncounted };
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

/** Prepares a pause: held balls return to their racks, because hands do not pause; flights continue afterwards. */
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

/**
 * Returns whether a round can start: all present players are ready, with a thrower and the holder; with `everySeat` all
 * are present.
 */
function canStart({ players, phase, options }: BallState): boolean {
  if (phase !== 'ready') return false;
  let throwers = 0;
  let holders = 0;
  for (const { present, ready, role } of players) {
    if (!present && options.everySeat) return false;
    if (!present) continue;
    if (!ready) return false;
    if (role === 'thrower') throwers += 1;
    else holders += 1;
  }
  return throwers > 0 && holders > 0;
}

type PoseAction = Extract<BallInput, { type: 'pose' }>;

// Scratch of one call: poses arrive about 30 times a second.
const fists = { left: vec3(0, 0, 0), right: vec3(0, 0, 0) };
const opening = makeOpening();

/** Writes the centre of a fist into `fist`. Returns false if the hand is not tracked or not plausible. */
function isReachable(hand: PoseAction['left'], head: Vec3, fist: MutableVec3): hand is NonNullable<PoseAction['left']> {
  if (!hand) return false;
  fistOf(hand, fist);
  const { x, y, z, w } = hand.orientation;
  return isFiniteVec3(fist) && Number.isFinite(x + y + z + w) && distance(fist, head) <= armReach;
}

/** Applies a pose. The holder's hands move the basket, and flights are decided along its way. */
function pose(state: BallState, action: PoseAction): Step {
  const { player: index, head } = action;
  const player = state.players[index]!;
  const now = ballMatchTime(state) + tickSeconds;
  if (!player.present || !isFiniteVec3(head) || !Number.isFinite(action.at) || length(head) > 50) {
    return unchanged(state);
  }
  const at = round(Math.min(Math.max(action.at, now - maxDelay), now));
  if (at < player.at) return unchanged(state);
  const left = isReachable(action.left, head, fists.left) ? action.left : null;
  const right = isReachable(action.right, head, fists.right) ? action.right : null;
  const moved = withPlayer(state, index, {
    at,
    head: rounded(head),
    left: left && rounded(fists.left),
    right: right && rounded(fists.right),
  });
  const holds = player.role === 'holder' && isInZone(head, player.station) && basketInHands(left, right, opening);
  return holds ? carryBasket(moved, at) : unchanged(moved);
}

/** Moves the basket to its opening at a match time [s]. */
function carryBasket(state: BallState, at: number): Step {
  const held = { position: rounded(opening.position), normal: rounded(opening.normal) };
  const before = state.basket;
  // A late pose moves the basket, but does not change what is decided.
  if (at <= before.at) return unchanged({ ...state, basket: { ...held, at: before.at } });
  const jumped = distance(held.position, before.position) > fastestBasket * (at - before.at);
  const from = jumped ? { ...held, at: before.at } : before;
  return resolveFlights({ ...state, basket: from }, { ...held, at });
}

function act(state: BallState, action: BallInput): Step {
  if (action.type === 'pause') return pause(state);
  const player = state.players[action.player];
  if (!player) return unchanged(state);
  switch (action.type) {
    case 'join':
      return join(state, action.player);
    case 'leave':
      return leave(state, action.player);
    case 'reconnect':
      return unchanged(withPlayer(state, action.player, uncounted));
    case 'ready':
      return setReady(state, action.player, action.ready);
    case 'silent':
      return unchanged(withPlayer(state, action.player, forgotten));
    case 'pose':
      return pose(state, action);
    case 'grab':
    case 'drop':
    case 'throw':
    case 'rotate': {
      const refused = (after: BallState, reason: Refusal): Step => ({
        state: after,
        events: [{ type: 'refused', player: action.player, sequence: action.sequence, reason }],
      });
      if (!player.present) return refused(state, 'absent');
      const counted = recordSequence(player, action.sequence);
      if (!counted) return refused(state, 'seen-before');
      const remembered = withPlayer(state, action.player, counted);
      const done = applyAction(remembered, action.player, action);
      return typeof done === 'string' ? refused(remembered, done) : done;
    }
    default:
      return unchanged(state);
  }
}

/** Returns whether the holder was seen shortly before this second of the match. */
const isHeldAt = ({ players }: BallState, second: number): boolean =>
  players.some(({ role, at }) => role === 'holder' && second - at <= holderSilence);

/** Returns whether a throw from before the bell can no longer arrive. */
const isPastThrows = (state: BallState): boolean =>
  state.startedAt !== null && ballMatchTime(state) >= state.startedAt + state.options.seconds + maxDelay;

/** Returns why the round is over; null: it continues, as it does while a ball is held or flies. */
function roundEnd(state: BallState): BallEnd | null {
  for (const location of state.balls)
    if (location.on === 'hand' || (location.on === 'air' && !location.missed)) return null;
  if (ballsLeft(state) === 0) return 'balls';
  return ballSecondsLeft(state) <= 0 ? 'time' : null;
}

/**
 * The rules for two throwers and a basket holder 5 m away, with a point for every catch (section 5.3 of the paper).
 * Tick 1/60 s, arena frame. Actions and poses carry their own times, so that flights and the basket are compared as the
 * holder saw them, despite delays.
 */
export const ballRules: GameRules<BallState, BallInput, BallEvent, BallOptions> = {
  tickSeconds,

  start(players, _seed, options = {}) {
    const checked = checkedOptions(options);
    if (players.length !== stations.length) {
      throw new Error(`ball game: it takes ${stations.length} players, not ${players.length}`);
    }
    return {
      options: checked,
      tick: 0,
      phase: 'ready',
      startedAt: null,
      end: null,
      score: 0,
      rotate: false,
      players: players.map((_, index): BallPlayer => {
        const count = stations.length;
        const station = (((index + checked.rotation) % count) + count) % count;
        return {
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
    if (next.basket.at < decided) take(resolveFlights(next, { ...next.basket, at: decided }, isHeldAt(next, decided)));
    next = { ...next, tick: next.tick + 1 };
    if (next.phase === 'running') {
      if (isPastThrows(next)) take(returnHeld(next, null));
      const end = roundEnd(next);
      if (end) {
        next = { ...next, phase: 'over', end, players: next.players.map((player) => ({ ...player, ready: false })) };
        events.push({ type: 'ended', end, score: next.score });
      }
    }
    return { state: next, events };
  },
};

/** How the ball game is played, a sentence a line; `balls` and `seconds` of a match. */
export const ballRulesText = (balls: number, seconds: number): readonly string[] => [
  'Two players throw, the third holds the basket, 5 m away. Bots take free seats.',
  `${balls} balls, ${Math.round(seconds)} seconds, a point for every ball that lands in the basket.`,
  'Throw: take a ball from the rack (trigger, grip or pinch), swing and release. Dropped balls return to the rack.',
  'Catch: the basket hangs between both hands, or at one, and opens where the thumbs point.',
  'Stay within 1.2 m of your mark: only throws from there count.',
  'A match starts when every player has pressed Ready.',
];
