import { clamp } from '../../math/damper';
import { nextRandom } from '../../math/random';
import type { Side } from '../../math/side';
import { add, addScaled, distance, lerp, scale, subtract, type Vec3, vec3 } from '../../math/vec3';
import { gravity } from '../ballistics';
import { minimumJerk } from '../posture';
import type { BallState } from './ball-state';
import {
  createPlayerPostures,
  mixPostures,
  type Performed,
  type PlayerBody,
  type PlayerPosture,
} from './player-postures';
import { ballMatchTime } from './rules';
import { rackPosition, stations } from './stations';
import { createThrowPostures, withHand } from './throw-postures';

/** What a bot sees of the match: the state as far as it is known, and which player it is. */
export interface BotSight {
  readonly state: BallState;
  readonly player: number;
  /** The middle of the basket's opening where it is seen, arena frame; absent: where the state has it. */
  readonly basket?: Vec3;
}

/** A player who needs nobody: hands and buttons for a whole match. */
export interface BallBot {
  /** Head, hands (own floor frame) and buttons at `time` [s, never falling]. */
  follow(time: number, sight: BotSight): Performed;
}

interface Movement {
  readonly to: PlayerPosture;
  readonly seconds: number;
  /** Of the throwing hand's button at its end. */
  readonly pressure: number;
  /** Rises on its way by this much [m]. */
  readonly arc?: number;
  /** Lasts until this is true. */
  readonly until?: (sight: BotSight) => boolean;
  /** Where the throwing fist is after this many seconds, instead of on the way to its end. */
  readonly swing?: (seconds: number) => Vec3;
  /** The button is let go after this many seconds. */
  readonly releaseAt?: number;
}

/** A ball is this long in the air [s]; longer throws are higher. */
const flightSeconds = 0.86;
/** Two balls in the air at once are one too many for a basket: throws are this far apart [s]. */
const betweenThrows = 0.75;
/** Nobody throws twice alike [m]. */
const scatter = 0.14;

/** The ball of the racks that is nearest to this thrower; null: none is within reach, or there is nothing to do. */
export function nearestBall({ state, player }: BotSight): number | null {
  if (state.phase !== 'running') return null;
  const station = stations[state.players[player]?.station ?? 0];
  if (!station) return null;
  let nearest: number | null = null;
  let least = 1;
  state.balls.forEach((place, ball) => {
    if (place.on !== 'rack') return;
    const far = distance(rackPosition(ball, state.options.balls), { ...station.position, y: 1 });
    if (far >= least) return;
    nearest = ball;
    least = far;
  });
  return nearest;
}

/** Takes ball after ball from the rack, throws it at the basket underarm, and rests. `seed`: of the scatter of its throws. */
export function createThrower(body: PlayerBody, seed: number): BallBot {
  const postures = createPlayerPostures(body);
  const { inFloor } = postures;
  const moves = createThrowPostures(postures);
  const { resting } = moves;
  let random = { seed };
  const chance = (): number => {
    const next = nextRandom(random);
    random = next.state;
    return 2 * next.value - 1;
  };

  const basketOf = ({ state, basket }: BotSight): Vec3 => inFloor(basket ?? state.basket.position);

  /** Take, bring before the chest, wait for a turn, swing back, throw, follow through. */
  function throwOf(ball: number, side: Side, sight: BotSight): Movement[] {
    const at = inFloor(rackPosition(ball, sight.state.options.balls));
    const basket = basketOf(sight);
    const target = add(basket, vec3(scatter * chance(), 0, scatter * chance()));
    const reach = moves.reaching(side, at);
    const ready = moves.carrying(side, basket);
    const velocity = add(
      scale(subtract(target, moves.release(side)), 1 / flightSeconds),
      vec3(0, 0.5 * gravity * flightSeconds, 0),
    );
    const { wound, thrown, seconds, releaseAt, swing } = moves.throwing(side, velocity, basket);
    return [
      { to: reach, seconds: 0.75, pressure: 0, arc: 0.06 },
      { to: reach, seconds: 0.16, pressure: 1 },
      { to: ready, seconds: 0.6, pressure: 1, arc: 0.08 },
      { to: ready, seconds: 0.05, pressure: 1, until: mayThrow },
      { to: wound, seconds: 0.5, pressure: 1 },
      { to: thrown, seconds, pressure: 0, swing, releaseAt },
      { to: thrown, seconds: 0.2, pressure: 0 },
    ];
  }

  /** Nobody else has just thrown, and it is this thrower's turn. */
  function mayThrow({ state, player }: BotSight): boolean {
    if (state.phase !== 'running') return true;
    const now = ballMatchTime(state);
    const busy = state.balls.some(
      (place) => place.on === 'air' && !place.missed && now - place.launch.time < betweenThrows,
    );
    const station = state.players[player]?.station ?? 0;
    return !busy && Math.floor(now / betweenThrows) % 2 === station % 2;
  }

  let from: PlayerPosture | null = null;
  let fromPressure = 0;
  let began = 0;
  let plan: Movement[] = [];
  let idle = true;
  let throwing: Side = 'right';

  function proceed(time: number, sight: BotSight): void {
    const basket = basketOf(sight);
    from ??= resting(basket);
    for (;;) {
      const current = plan[0];
      if (!current) {
        const ball = nearestBall(sight);
        if (ball === null && idle) return;
        if (idle) began = time;
        idle = ball === null;
        if (ball === null) plan = [{ to: resting(basket), seconds: 0.9, pressure: 0, arc: 0 }];
        else {
          const at = inFloor(rackPosition(ball, sight.state.options.balls));
          throwing = at.x < 0 ? 'left' : 'right';
          plan = throwOf(ball, throwing, sight);
        }
        continue;
      }
      if (time - began < current.seconds) return;
      if (current.until && !current.until(sight)) return;
      from = current.to;
      fromPressure = current.pressure;
      began = current.until ? time : began + current.seconds;
      plan = plan.slice(1);
    }
  }

  return {
    follow(time, sight) {
      proceed(time, sight);
      const start = from as PlayerPosture;
      const current = plan[0];
      if (!current) return postures.seen(start, time, { left: 0, right: 0 });
      const elapsed = Math.min(time - began, current.seconds);
      const share = minimumJerk(clamp(elapsed / current.seconds, 0, 1));
      let now = mixPostures(start, current.to, share);
      const hand = now[throwing];
      const fist = current.swing
        ? current.swing(elapsed)
        : lerp(hand.fist, addScaled(hand.fist, vec3(0, 1, 0), current.arc ?? 0), Math.sin(Math.PI * share) ** 2);
      now = withHand(now, throwing, { ...hand, fist });
      const pressure =
        current.releaseAt === undefined
          ? fromPressure + (current.pressure - fromPressure) * share
          : elapsed < current.releaseAt
            ? 1
            : 0;
      return postures.seen(now, time, {
        left: throwing === 'left' ? pressure : 0,
        right: throwing === 'right' ? pressure : 0,
      });
    },
  };
}
