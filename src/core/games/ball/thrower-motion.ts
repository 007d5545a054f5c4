import { clamp } from '../../math/damper';
import { nextRandom } from '../../math/random';
import { add, addScaled, distance, length, lerp, normalise, scale, subtract, type Vec3, vec3 } from '../../math/vec3';
import { gravity } from '../ballistics';
import { otherSide, type Side } from '../fist';
import { minimumJerk } from '../posture';
import type { BallState } from './ball-state';
import {
  createPlayerPostures,
  type Grasp,
  mixPostures,
  type Performed,
  type PlayerBody,
  type PlayerPosture,
} from './player-postures';
import { ballMatchTime } from './rules';
import { rackPosition, stations } from './stations';

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
/** The arm is this fast at once [m], then evenly fast for as long as a throw's speed is measured and a slow frame more [s]. */
const runUp = 0.24;
const evenSeconds = 0.095;
const lateSeconds = 0.02;
const slowDown = 0.24;
/** Two balls in the air at once are one too many for a basket: throws are this far apart [s]. */
const betweenThrows = 0.75;
/** Nobody throws twice alike [m]. */
const scatter = 0.14;

/** Takes ball after ball from the rack, throws it at the basket underarm, and rests. `seed`: of the scatter of its throws. */
export function createThrower(body: PlayerBody, seed: number): BallBot {
  const postures = createPlayerPostures(body);
  const { arm, eyes, inFloor } = postures;
  let random = { seed };
  const chance = (): number => {
    const next = nextRandom(random);
    random = next.state;
    return 2 * next.value - 1;
  };

  const basketOf = ({ state, basket }: BotSight): Vec3 => inFloor(basket ?? state.basket.position);

  const resting = (at: Vec3): PlayerPosture => ({
    eyes,
    gaze: postures.looking(eyes, at),
    left: postures.hanging('left', eyes),
    right: postures.hanging('right', eyes),
  });

  const withHand = (posture: PlayerPosture, side: Side, grasp: Grasp): PlayerPosture => ({ ...posture, [side]: grasp });

  /** The fist round a ball of the rack, the body leaning towards it as far as the arm is too short. */
  function reaching(side: Side, ball: Vec3): PlayerPosture {
    const longest = 0.97 * arm + 0.05;
    const shoulder = postures.shoulder(side, eyes);
    const missing = Math.max(0, distance(shoulder, ball) - longest);
    const towards = normalise(subtract(ball, shoulder));
    const leaned = addScaled(eyes, towards, missing);
    const outward = side === 'left' ? -1 : 1;
    const shoulderThere = postures.shoulder(side, leaned);
    return {
      eyes: leaned,
      gaze: postures.looking(leaned, ball),
      left: postures.hanging('left', leaned),
      right: postures.hanging('right', leaned),
      [side]: {
        fist: ball,
        knuckles: normalise(add(scale(normalise(subtract(ball, shoulderThere)), 1), vec3(0, -0.15, -0.4))),
        thumb: vec3(-outward, 0.25, 0),
      },
    } as PlayerPosture;
  }

  /** Take, bring before the chest, wait for a turn, swing back, throw, follow through. */
  function throwOf(ball: number, side: Side, sight: BotSight): Movement[] {
    const outward = side === 'left' ? -1 : 1;
    const at = inFloor(rackPosition(ball, sight.state.options.balls));
    const basket = basketOf(sight);
    const target = add(basket, vec3(scatter * chance(), 0, scatter * chance()));
    const reach = reaching(side, at);
    const shoulder = postures.shoulder(side, eyes);
    const ready = withHand(resting(basket), side, {
      fist: add(shoulder, vec3(-0.05 * outward * arm, -0.42 * arm, -0.62 * arm)),
      knuckles: normalise(vec3(-0.1 * outward, 0.15, -1)),
      thumb: normalise(vec3(0.7 * outward, 0.7, 0)),
    });
    const release = add(shoulder, vec3(0, 0.06 * arm, -0.72 * arm));
    const velocity = add(
      scale(subtract(target, release), 1 / flightSeconds),
      vec3(0, 0.5 * gravity * flightSeconds, 0),
    );
    const speed = length(velocity);
    const way = normalise(velocity);
    const runSeconds = (2 * runUp) / speed;
    const even = evenSeconds + lateSeconds;
    const slowSeconds = (2 * slowDown) / speed;
    const back = addScaled(release, way, -(runUp + speed * evenSeconds));
    /** From rest to the throw's speed, on at that speed until the ball has left the hand, then to rest. */
    const swing = (seconds: number): Vec3 => {
      const running = clamp(seconds, 0, runSeconds);
      const evenly = clamp(seconds - runSeconds, 0, even);
      const slowing = clamp(seconds - runSeconds - even, 0, slowSeconds);
      const along =
        runUp * (running / runSeconds) ** 2 +
        speed * evenly +
        speed * (slowing - (slowing * slowing) / (2 * slowSeconds));
      return addScaled(back, way, along);
    };
    const throwSeconds = runSeconds + even + slowSeconds;
    const leanBack = add(eyes, vec3(0.03 * outward, -0.01, 0.06));
    const leanAhead = add(eyes, vec3(-0.02 * outward, -0.03, -0.13));
    const palmAhead = normalise(vec3(outward, 0.35, 0));
    const wound: PlayerPosture = {
      ...resting(basket),
      eyes: leanBack,
      gaze: postures.looking(leanBack, basket),
      [side]: {
        fist: back,
        knuckles: normalise(add(normalise(subtract(back, shoulder)), scale(way, 0.6))),
        thumb: palmAhead,
      },
      [otherSide(side)]: {
        fist: add(postures.shoulder(otherSide(side), leanBack), vec3(-0.1 * outward, -0.55 * arm, -0.55 * arm)),
        knuckles: normalise(vec3(0, 0.1, -1)),
        thumb: normalise(vec3(0.5 * outward, 0.8, 0)),
      },
    } as PlayerPosture;
    const thrown: PlayerPosture = {
      ...resting(basket),
      eyes: leanAhead,
      gaze: postures.looking(leanAhead, basket),
      [side]: { fist: swing(throwSeconds), knuckles: way, thumb: palmAhead },
    } as PlayerPosture;
    return [
      { to: reach, seconds: 0.75, pressure: 0, arc: 0.06 },
      { to: reach, seconds: 0.16, pressure: 1 },
      { to: ready, seconds: 0.6, pressure: 1, arc: 0.08 },
      { to: ready, seconds: 0.05, pressure: 1, until: mayThrow },
      { to: wound, seconds: 0.5, pressure: 1 },
      { to: thrown, seconds: throwSeconds, pressure: 0, swing, releaseAt: runSeconds + evenSeconds },
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

  /** The nearest ball of the racks to this thrower; null: none, or nothing to do. */
  function chosen({ state, player }: BotSight): number | null {
    if (state.phase !== 'running') return null;
    const station = stations[state.players[player]?.station ?? 0];
    if (!station) return null;
    let best: { readonly ball: number; readonly far: number } | null = null;
    state.balls.forEach((place, ball) => {
      if (place.on !== 'rack') return;
      const far = distance(rackPosition(ball, state.options.balls), { ...station.position, y: 1 });
      if (far < 1 && (!best || far < best.far)) best = { ball, far };
    });
    return (best as { readonly ball: number } | null)?.ball ?? null;
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
        const ball = chosen(sight);
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
