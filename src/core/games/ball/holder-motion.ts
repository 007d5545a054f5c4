import { clamp, dampVec3 } from '../../math/damper';
import { add, addScaled, distance, normalise, reject, scale, subtract, up, type Vec3, vec3 } from '../../math/vec3';
import { fallsTo, velocityAt } from '../ballistics';
import type { TimedLaunch } from './ball-state';
import { ballInAir, basketRadius } from './flight';
import { createPlayerPostures, type PlayerBody } from './player-postures';
import { ballMatchTime } from './rules';
import type { BallBot, BotSight } from './thrower-motion';

/** Half the way to where the basket should be in this time [s], twice over: it starts softly. */
const moveHalfLife = 0.055;
/** Half the way to what the eyes follow in this time [s]. */
const lookHalfLife = 0.06;
/** How far the basket leans towards a ball [share of the way from upright to the ball's own direction]. */
const lean = 0.5;
/** A ball further from the arms than this [m] is let go by. */
const widest = 0.85;

/**
 * Holds the basket before the belly and carries it to where the next ball comes down, stepping aside as far as needed. `told`: where
 * the opening is to be instead, own floor frame, when it waits at `home`.
 */
export function createHolder(body: PlayerBody, told?: (home: Vec3) => Vec3): BallBot {
  const postures = createPlayerPostures(body);
  const { arm, eyes, inFloor } = postures;
  /** Where the opening waits, and how far from there the arms alone carry it. */
  const home = add(eyes, vec3(0, -0.62 * arm - 0.06, -0.82 * arm));
  const comfort = 0.3 * arm;

  let opening = home;
  let soft = home;
  let normal: Vec3 = normalise(vec3(0, 1, -0.25));
  let softNormal = normal;
  let standing = eyes;
  let look = add(eyes, vec3(0, -0.3, -2));
  let lastTime: number | null = null;

  /** Where and how the next ball comes down to the basket's height, floor frame; null: none within reach. */
  function nextBall({ state }: BotSight, now: number): { readonly at: Vec3; readonly into: Vec3 } | null {
    let soonest: { readonly launch: TimedLaunch; readonly when: number } | null = null;
    for (const place of state.balls) {
      if (place.on !== 'air' || place.missed) continue;
      const { launch } = place;
      const when = launch.time + fallsTo(launch, home.y);
      if (when < now - 0.05 || (soonest && when >= soonest.when)) continue;
      const at = inFloor(ballInAir(launch, when));
      if (distance({ ...at, y: 0 }, { ...home, y: 0 }) > widest) continue;
      soonest = { launch, when };
    }
    if (!soonest) return null;
    const { launch, when } = soonest;
    const ahead = inFloor(add(ballInAir(launch, when), scale(velocityAt(launch, when - launch.time), 0.01)));
    const at = inFloor(ballInAir(launch, when));
    return { at, into: normalise(subtract(ahead, at)) };
  }

  return {
    follow(time, sight) {
      const elapsed = lastTime === null ? 0 : clamp(time - lastTime, 0, 0.1);
      lastTime = time;
      const ball = nextBall(sight, ballMatchTime(sight.state));
      const goal = told?.(home) ?? ball?.at ?? home;
      const wanted = ball ? normalise(add(scale(up, 1 - lean), scale(ball.into, -lean))) : normalise(vec3(0, 1, -0.25));
      soft = dampVec3(soft, goal, moveHalfLife, elapsed);
      opening = dampVec3(opening, soft, moveHalfLife, elapsed);
      softNormal = dampVec3(softNormal, wanted, moveHalfLife, elapsed);
      normal = normalise(dampVec3(normal, softNormal, moveHalfLife, elapsed));
      // Arms first; what they lack the feet give.
      const off = subtract(opening, home);
      const level = { ...off, y: 0 };
      const far = Math.hypot(level.x, level.z);
      const step = far > comfort ? scale(level, (far - comfort) / far) : vec3(0, 0, 0);
      standing = add(eyes, { ...step, y: clamp(off.y, -0.25, 0) * 0.6 });
      const across = normalise(reject(vec3(1, 0, 0), normal));
      look = dampVec3(
        look,
        ball ? lookPoint(sight, opening, inFloor) : add(standing, vec3(0, -0.3, -2)),
        lookHalfLife,
        elapsed,
      );
      const gripped = (sigma: number) => ({
        fist: addScaled(opening, across, sigma * basketRadius),
        // Hands come from the body: knuckles ahead and a little inward, thumbs out of the opening.
        knuckles: normalise(reject(vec3(-0.35 * sigma, -0.2, -1), normal)),
        thumb: normal,
      });
      return postures.seen(
        { eyes: standing, gaze: postures.looking(standing, look), left: gripped(-1), right: gripped(1) },
        time,
        { left: 1, right: 1 },
      );
    },
  };
}

/** The eyes follow the ball in the air. */
function lookPoint({ state }: BotSight, otherwise: Vec3, inFloor: (point: Vec3) => Vec3): Vec3 {
  const now = ballMatchTime(state);
  const flying = state.balls.find((place) => place.on === 'air' && !place.missed);
  return flying?.on === 'air' ? inFloor(ballInAir(flying.launch, now)) : otherwise;
}
