import { clamp, smoothingFactor } from '../../math/damper';
import { transformPoint } from '../../math/pose';
import { rotate } from '../../math/quat';
import type { Side } from '../../math/side';
import { add, addScaled, distance, normalise, scale, subtract, type Vec3, vec3 } from '../../math/vec3';
import type { Launch } from '../ballistics';
import { minimumJerk } from '../posture';
import { createHolder } from './holder-motion';
import { createPlayerPostures, mixPostures, type PlayerBody, type PlayerPosture } from './player-postures';
import { ballInHand } from './rules';
import { rackPosition } from './stations';
import { createThrowPostures, type SwungThrow, withHand } from './throw-postures';
import { type BallBot, type BotSight, nearestBall } from './thrower-motion';

/** What somebody at a desk wants of a player: a mouse in the place of two hands. Own floor frame. */
export interface BallSteering {
  /** Unit direction. */
  readonly ray: { readonly origin: Vec3; readonly direction: Vec3 };
  /** A thrower swings back for as long as this is true, the longer the further the ball goes, and then throws. */
  readonly pressed: boolean;
  /** true: the arm comes down again, the ball in hand. */
  readonly cancelled: boolean;
}

/** A player who does as told. */
export interface SteeredPlayer extends BallBot {
  /** How the ball would leave the hand now, arena frame; null: no throw is being aimed. */
  readonly aim: Launch | null;
}

/** A hold this long [s] is the hardest throw; from the first to the second speed [m/s]. */
const fullSeconds = 1.3;
const softest = 4;
const hardest = 8.8;
/** Nobody means a steeper or a flatter throw than these [rad above the horizon], and most mean this one. */
const flattest = 0.45;
const steepest = 1.2;
const usual = 0.85;
/** How much further up a throw goes than the pointer. */
const lift = 1.5;
/** Half-lives of the way to a posture [s]. */
const moveHalfLife = 0.07;
const windHalfLife = 0.045;
/** A fist this near to a ball [m] takes it, and waits this long [s] for it to be its own. */
const atBall = 0.07;
const takePatience = 0.6;
/** From where the arm is to where it swings from, and after the throw [s]. */
const leadSeconds = 0.1;
const followSeconds = 0.25;
/** A basket is carried this far to each side of where it waits [m]. */
const basketReach = 0.65;

/** Where a ray comes to the upright plane this far ahead [m]; beside or behind: as far aside as it can be meant. */
function ahead({ origin, direction }: BallSteering['ray'], z: number): Vec3 {
  const along = direction.z < -0.05 ? (z - origin.z) / direction.z : 20;
  const at = addScaled(origin, direction, clamp(along, 0, 20));
  return vec3(clamp(at.x, -4, 4), clamp(at.y, 0, 3.5), z);
}

/** Takes ball after ball by itself; swings back while told to, and throws where the ray points. */
export function createSteeredThrower(body: PlayerBody, steering: () => BallSteering): SteeredPlayer {
  const postures = createPlayerPostures(body);
  const moves = createThrowPostures(postures);
  const { arenaFromFloor } = body;
  type Phase = 'idle' | 'reaching' | 'taking' | 'ready' | 'drawing' | 'swinging' | 'following';
  let phase: Phase = 'idle';
  let began = 0;
  let last: number | null = null;
  let posture: PlayerPosture | null = null;
  let from: PlayerPosture | null = null;
  let side: Side = 'right';
  let ball = 0;
  let swung: SwungThrow | null = null;
  let aim: Launch | null = null;
  /** A press throws once. */
  let spent = false;

  function enter(next: Phase, time: number): void {
    phase = next;
    began = time;
    if (next !== 'drawing') aim = null;
  }

  /** The throw that is meant after so much of a hold: from 0 to 1. */
  function meant(share: number, target: Vec3, basketHeight: number): Vec3 {
    const from = moves.release(side);
    const level = normalise({ ...subtract(target, from), y: 0 }, vec3(0, 0, -1));
    const up = Math.atan2(target.y - basketHeight, Math.abs(target.z - from.z));
    const angle = clamp(usual + lift * up, flattest, steepest);
    const speed = softest + (hardest - softest) * share;
    return add(scale(level, speed * Math.cos(angle)), vec3(0, speed * Math.sin(angle), 0));
  }

  return {
    get aim() {
      return aim;
    },
    follow(time, sight: BotSight) {
      const { state, player } = sight;
      const wish = steering();
      const elapsed = last === null ? 0 : clamp(time - last, 0, 0.1);
      last = time;
      const basket = postures.inFloor(sight.basket ?? state.basket.position);
      const target = ahead(wish.ray, basket.z);
      if (!wish.pressed) spent = false;
      const towards = (goal: PlayerPosture, halfLife = moveHalfLife): PlayerPosture =>
        mixPostures(posture ?? goal, goal, smoothingFactor(halfLife, elapsed));
      const holds = ballInHand(state, player, side) >= 0;
      const elapsedHere = () => time - began;
      const place = () => postures.inFloor(rackPosition(ball, state.options.balls));

      if (phase === 'idle') {
        const next = nearestBall(sight);
        if (next !== null) {
          ball = next;
          side = place().x < 0 ? 'left' : 'right';
          enter('reaching', time);
        }
      } else if (phase === 'reaching') {
        if (state.phase !== 'running' || state.balls[ball]?.on !== 'rack') enter('idle', time);
        else if (posture && distance(posture[side].fist, place()) < atBall) enter('taking', time);
      } else if (phase === 'taking') {
        if (holds) enter('ready', time);
        else if (elapsedHere() > takePatience) enter('idle', time);
      } else if (phase === 'ready') {
        if (!holds) enter('idle', time);
        else if (wish.pressed && !wish.cancelled && !spent) enter('drawing', time);
      } else if (phase === 'drawing') {
        if (!holds) enter('idle', time);
        else if (wish.cancelled) {
          spent = true;
          enter('ready', time);
        } else if (!wish.pressed) {
          from = posture;
          enter('swinging', time);
        }
      } else if (phase === 'swinging' && swung && elapsedHere() >= leadSeconds + swung.seconds)
        enter('following', time);
      else if (phase === 'following' && elapsedHere() >= followSeconds) enter('idle', time);

      let pressure = phase === 'taking' || phase === 'ready' || phase === 'drawing' ? 1 : 0;
      switch (phase) {
        case 'reaching':
        case 'taking':
          posture = towards(moves.reaching(side, place()));
          break;
        case 'ready':
          posture = towards(moves.carrying(side, target));
          break;
        case 'drawing': {
          const velocity = meant(clamp(elapsedHere() / fullSeconds, 0, 1), target, basket.y);
          swung = moves.throwing(side, velocity, target);
          aim = {
            position: transformPoint(arenaFromFloor, moves.release(side)),
            velocity: rotate(arenaFromFloor.orientation, velocity),
          };
          posture = towards(swung.wound, windHalfLife);
          break;
        }
        case 'swinging': {
          const { wound, thrown, seconds, releaseAt, swing } = swung!;
          const since = elapsedHere() - leadSeconds;
          if (since < 0) posture = mixPostures(from ?? wound, wound, minimumJerk(elapsedHere() / leadSeconds));
          else {
            const between = mixPostures(wound, thrown, minimumJerk(clamp(since / seconds, 0, 1)));
            posture = withHand(between, side, { ...between[side], fist: swing(since) });
          }
          pressure = since < releaseAt ? 1 : 0;
          break;
        }
        case 'following':
          break;
        default:
          posture = towards(moves.resting(state.phase === 'running' ? target : basket));
      }
      const pressed = { left: 0, right: 0, [side]: pressure };
      return postures.seen(posture ?? moves.resting(basket), time, pressed);
    },
  };
}

/** Carries the basket, at its own height, to where the ray points; it leans towards balls by itself. */
export function createSteeredHolder(body: PlayerBody, steering: () => BallSteering): SteeredPlayer {
  const holder = createHolder(body, (home) => {
    const { origin, direction } = steering().ray;
    // Who points at the sky means as far as it goes.
    const along = direction.y < -0.02 ? (home.y - origin.y) / direction.y : 20;
    const off = { ...subtract(addScaled(origin, direction, clamp(along, 0, 20)), home), y: 0 };
    const far = Math.hypot(off.x, off.z);
    return addScaled(home, off, far > basketReach ? basketReach / far : 1);
  });
  return { aim: null, follow: holder.follow };
}
